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

  /// Notes whether a body that was moved went far: by more than a quarter of the least width of its thinnest
  /// shape. Writes to nothing but what is kept of this body.
  [[gnu::always_inline]] static void noteFast(StepContext<S>& step, std::uint32_t index,
                                              const Body<S>& body) {
    FastBodies<S>& fast = step.events.fast;
    const auto& start = fast.starts[index];
    const BodyBulk<S>& bulk = step.derived.bulkOf(step.state, index);
    const Vector<S> by = body.worldCenter() - start.center;
    // Halves of angles: a body's own function may have set any.
    const S half = ratio<S>(1, 2);
    const S turn = body.angle() * half - start.angle * half;
    if (abs(by.x) + abs(by.y) > bulk.way || abs(turn) > bulk.turn) [[unlikely]]
      noteGoesFar(step, index, body);
  }
  /// Notes that it did, or that its own function has put it where no velocity could: then nothing lies on its
  /// way.
  static void noteGoesFar(StepContext<S>& step, std::uint32_t index, const Body<S>& body);

  /// Lets a body's own function move it; whatever that did, the body is held within the world.
  static void callPositionFunc(StepContext<S>& step, std::uint32_t index);
  /// Lets a body's own function change its velocity.
  /// @param kept  what is left of a velocity after the step without forces
  static void callVelocityFunc(StepContext<S>& step, std::uint32_t index, S kept);
};

#define SAMESTEP_EACH_SCALAR extern template struct Integrate<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
