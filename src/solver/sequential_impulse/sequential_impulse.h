// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "contacts/contact_row.h"

namespace samestep {

/// Sequential impulses with bias velocities, as the MIS and Chipmunk: every pass solves one contact after the
/// other, for the speeds and, apart from them, for the overlap.

/// The velocities of one body while the solver works on them.
template <Scalar S>
struct ImpulseBody {
  Vector<S> velocity{};
  S angularVelocity{};
  Vector<S> biasVelocity{};
  S biasAngularVelocity{};
};

template <Scalar S>
struct ImpulseRow : ContactAxes<S> {
  /// The speed at which the overlap shall shrink, and what the bounce adds, m/s.
  S bias{}, bounce{};
  /// Accumulated u for the bias velocities.
  S biasSum{};
  /// Impulses that bodies were given at first less than the sums said, u.
  S normalLacks{}, tangentLacks{};
  /// Impulse of a blow that was solved before the forces of the step, as a speed of the lighter body, m/s.
  S struckNormal{}, struckTangent{};
};

template <Scalar S>
struct ImpulseSolver {
  std::vector<ImpulseBody<S>> bodies;
  std::vector<ImpulseRow<S>> rows;

  /// Builds the rows of one pair from the bodies' state and present velocities. MIS: arbiterPreStep
  /// @param slop      m
  /// @param biasRate  the part of an overlap that shall go, per second
  void preStep(const Pair<S>& pair, std::uint32_t indexA, std::uint32_t indexB, const Body<S>& a,
               const Body<S>& b, S slop, S biasRate);
  /// Applies the impulses kept from the last step, times dtCoefficient. MIS: arbiterApplyCachedImpulse
  void warmStart(ImpulseRow<S>& row, S dtCoefficient);
  /// One pass over all rows. MIS: arbiterApplyImpulse
  void iterate();
};

#define SAMESTEP_EACH_SCALAR extern template struct ImpulseSolver<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
