// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "context/step_context.h"

namespace samestep {

/// Joints as they come, change and go: checks first, then the state. The caller has made sure that the Space
/// is not locked.
template <Scalar S>
struct Joints {
  using Context = StepContext<S>;

  /// Takes in a joint under an id that can be given to a new one.
  /// @throws BodyNotFound, IllegalJoint
  static void insert(Context& world, const Joint<S>& joint, JointId id);
  static void erase(Context& world, JointId id);
  /// @throws JointNotFound, BodyNotFound, IllegalJoint
  static void replace(Context& world, JointId id, const Joint<S>& joint);
  /// All of a body.
  static void eraseOf(Context& world, BodyId id);
  static bool hasAny(const WorldState<S>& state, BodyId id);
  /// The bodies that joints connect with one, by rising id.
  static std::vector<BodyId> connectedTo(const WorldState<S>& state, BodyId id);

 private:
  static void changed(Context& world, const Joint<S>& joint);
  static Joint<S> checked(const WorldState<S>& state, const Joint<S>& joint, const char* asked);
};

#define SAMESTEP_EACH_SCALAR extern template struct Joints<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
