// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/body.h>
#include <samestep/joint.h>
#include <samestep/settings.h>
#include <samestep/shape.h>

#include "call.h"

namespace samestep::c {

/// The settings of a Space.
/// @throws Refusal; ValueOutOfRange for numbers that are not finite, other ranges are the Space's to check
template <Scalar S>
Settings<S> toSettings(const samestep_settings& from);
template <Scalar S>
samestep_settings toC(const Settings<S>& from);

/// A free body.
/// @throws Refusal, and what Body's setters throw
template <Scalar S>
Body<S> toBody(const samestep_body_def& from);
/// @throws Refusal
BodyType toBodyType(std::int32_t type);

/// A free shape of a body.
/// @throws Refusal, and what Shape's setters throw
template <Scalar S>
Shape<S> toShape(BodyId body, const samestep_shape_def& from);

/// A free joint.
/// @throws Refusal; ValueOutOfRange for numbers that are not finite, other ranges are the Space's to check
template <Scalar S>
Joint<S> toJoint(const samestep_joint_def& from);
template <Scalar S>
samestep_joint_def toC(JointId id, const Joint<S>& from);

template <Scalar S>
samestep_contact_state toC(const Arbiter<S>& arbiter);
template <Scalar S>
samestep_touch toC(const ContactPointSet<S>& set);

}  // namespace samestep::c
