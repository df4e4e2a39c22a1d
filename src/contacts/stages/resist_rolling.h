// SPDX-License-Identifier: MIT
#pragma once

#include "context/step_context.h"

namespace samestep {

/// Rolling resistance: a torque by which two shapes that touch oppose that their bodies turn against each
/// other.
template <Scalar S>
struct ResistRolling {
  /// Slows the turning of both bodies of a pair, before a solver takes them, by no more than the impulses
  /// that the contact kept from the step before allow: what rests rolls on from the next step on.
  static void act(StepContext<S>& step, const Pair<S>& pair);
};

#define SAMESTEP_EACH_SCALAR extern template struct ResistRolling<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
