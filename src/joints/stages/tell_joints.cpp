// SPDX-License-Identifier: MIT
#include "joints/stages/tell_joints.h"

#include "base/require_ieee.h"

namespace samestep {

template <Scalar S>
bool TellJoints<S>::breaks(const Joint<S>& joint) {
  if (joint.breakForce > S(0) && length(joint.force) > joint.breakForce) return true;
  return joint.breakTorque > S(0) && abs(joint.torque) > joint.breakTorque;
}

template <Scalar S>
void TellJoints<S>::run(StepContext<S>& step) {
  std::vector<JointEvent<S>>& events = step.events.joints;
  events.clear();
  if (step.state.joints.empty()) return;
  const bool listed = step.wiring.listing.joints;
  step.state.joints.each([&](JointId id, Joint<S>& joint) {
    const bool broke = breaks(joint);
    const auto list = [&](JointChange change) {
      events.push_back({id, joint.bodyA, joint.bodyB, change, joint.userData, joint.force, joint.torque});
    };
    if (listed && broke) list(JointChange::broke);
    if (listed && (joint.reached & Joint<S>::kReachedLower) != 0) list(JointChange::reachedLower);
    if (listed && (joint.reached & Joint<S>::kReachedUpper) != 0) list(JointChange::reachedUpper);
    joint.reached = 0;
    if (!broke) return;
    step.state.joints.erase(id);
    step.derived.jointedKnown = false;
  });
}

#define SAMESTEP_EACH_SCALAR template struct TellJoints<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
