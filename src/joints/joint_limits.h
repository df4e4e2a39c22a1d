// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/joint.h>

namespace samestep {

/// The largest impulse that a joint keeps, m/s or rad/s.
template <Scalar S>
inline constexpr S kMostKept = S(1 << 20);

/// True if the motor of a joint turns B, rather than moving it along an axis.
template <Scalar S>
bool motorTurns(const Joint<S>& joint) {
  return joint.kind != JointKind::prismatic && joint.kind != JointKind::distance;
}

template <Scalar S>
S mostMotorSpeed(const Joint<S>& joint) {
  return motorTurns(joint) ? kMaxAngularSpeed<S> : kMaxSpeed<S>;
}

}  // namespace samestep
