// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "context/step_context.h"

namespace samestep {

/// The stages that move bodies without contacts, and the calls of functions that do it in their place.
template <Scalar S>
struct Integrate {
  /// Refuses a step of a body without mass or moment, or of one whose function is not registered.
  /// @throws IllegalBody, MissingCallback
  static void check(const StepContext<S>& step);
  /// Moves bodies by their velocities.
  static void positions(StepContext<S>& step);
  /// Changes velocities by gravity, force, torque and damping.
  static void velocities(StepContext<S>& step);

  /// Lets a body's own function move it; whatever that did, the body is held within the world.
  static void callPositionFunc(StepContext<S>& step, std::uint32_t index);
  /// Lets a body's own function change its velocity.
  /// @param kept  what is left of a velocity after the step without forces
  static void callVelocityFunc(StepContext<S>& step, std::uint32_t index, S kept);
};

#define SAMESTEP_EACH_SCALAR extern template struct Integrate<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
