// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/joint.h>

#include <vector>

#include "solver/joints/joint_row.h"
#include "solver/joints/joint_work.h"

namespace samestep {

/// Angle of B of a joint, times its ratio, against A, less the angle of the joint; rad. Angles beyond 2^20
/// count as that far.
template <Scalar S>
S jointAngle(const Joint<S>& joint, S angleA, S angleB);

/// The tooth that holds a ratchet at an angle of the joint: in the direction in which it turns.
template <Scalar S>
S ratchetTooth(const Joint<S>& joint, S angle);

/// Appends the rows of a joint whose bodies are where they are now.
template <Scalar S>
void appendRows(const Joint<S>& joint, const JointWork<S>& work, const JointBody<S>& a, const JointBody<S>& b,
                const JointTiming<S>& timing, std::vector<JointRow<S>>& rows);

}  // namespace samestep
