// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "contact_row.h"

namespace samestep {

/// Small substeps with soft contacts and relaxation: each substep solves all contacts once as damped springs,
/// moves the bodies, then solves them once more without the springs, so that what pushed overlaps apart
/// leaves no speed behind.
/// Sources: M. Macklin et al., "Small Steps in Physics Simulation" (2019); E. Catto, "Soft Constraints" (GDC
/// 2011) and "Solver2D" (box2d.org, 2024).

/// One body in the substeps: its velocities, and how far it has moved and turned since the step began.
template <Scalar S>
struct SoftBody {
  Vector<S> velocity{};
  S angularVelocity{};
  Vector<S> moved{};
  S turned{};
  /// Half the square of `turned`: how far turning moves a point towards the centre, per metre.
  S bend{};
};

/// What one substep adds to a body's velocities by itself.
template <Scalar S>
struct SoftDrive {
  Vector<S> velocity{};
  S angularVelocity{};
};

template <Scalar S>
struct SoftRow : ContactAxes<S> {
  /// How turning bends the contact points towards the centres, m: r . n, or 0 where the surface is a circle's
  /// and turning does not move it.
  S bendA{}, bendB{};
  /// What the bounce shall leave, m/s; 0 for none.
  S bounce{};
  /// The largest normalSum of the step, and both sums added up over the substeps.
  S normalMost{}, normalTotal{}, tangentTotal{};
  /// Which contact of the Space it is.
  std::uint32_t pair = 0;
  std::uint16_t contact = 0;
  /// Which softness: 0 between bodies that move, 1 against one that does not.
  std::uint16_t softness = 0;
};

/// A damped spring, made to be stable for its substep.
template <Scalar S>
struct Softness {
  S biasRate{};      ///< Part of an overlap that goes, 1/s.
  S massScale{1};    ///< How hard the speed is corrected, in [0, 1].
  S impulseScale{};  ///< How much of the accumulated impulse is given back, in [0, 1].
};

template <Scalar S>
Softness<S> makeSoftness(S hertz, S dampingRatio, S substep);

template <Scalar S>
struct SoftSolver {
  std::vector<SoftBody<S>> bodies;
  std::vector<SoftDrive<S>> drives;
  std::vector<SoftRow<S>> rows;
  Softness<S> softness[2]{};
  /// Of a substep: seconds, its inverse, what damping leaves, and the greatest speed of pushing apart, m/s.
  S substep{}, perSubstep{}, kept{1}, pushSpeed{};

  /// Builds the rows of one pair.
  void preStep(const Pair<S>& pair, std::uint32_t pairIndex, std::uint32_t indexA, std::uint32_t indexB,
               const Body<S>& a, const Body<S>& b, bool roundA, bool roundB, S bounceThreshold);
  void integrateVelocities();
  void warmStart();
  /// With springs.
  void solve();
  void integratePositions();
  /// Without.
  void relax();
  void bounce();
  /// Adds the substep's impulses to the totals.
  void sum();
};

#ifndef SAMESTEP_FIXED_ONLY
extern template struct SoftSolver<double>;
#endif
extern template struct SoftSolver<Fixed>;
extern template struct SoftSolver<CheckedFixed>;

}  // namespace samestep
