// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/arbiter.h>
#include <samestep/body.h>

namespace samestep {

/// The velocities of one body while the solver works on them; dense, by body slot.
template <Scalar S>
struct SolverBody {
  Vector<S> velocity{};
  S angularVelocity{};
  Vector<S> biasVelocity{};
  S biasAngularVelocity{};
};

/// One contact point, ready to be solved in velocity units: an impulse is the change u of the relative speed
/// it makes, so no mass appears in the loop. With k = 1/nMass, a body of inverse mass m and inverse moment i
/// answers u with the speed (m/k) u and the spin (i (r x n)/k) u.
template <Scalar S>
struct ContactRow {
  std::uint32_t bodyA = 0;
  std::uint32_t bodyB = 0;
  Vector<S> normal{};
  /// r x n and r x t of both bodies, m.
  S normalArmA{}, normalArmB{}, tangentArmA{}, tangentArmB{};
  /// m/k, i (r x n)/k along the normal and along the tangent.
  S speedA{}, speedB{}, spinA{}, spinB{};
  S tangentSpeedA{}, tangentSpeedB{}, tangentSpinA{}, tangentSpinB{};
  /// The speed at which the overlap shall shrink, what the bounce adds, and the surface's own speed, m/s.
  S bias{}, bounce{}, surface{};
  /// Friction coefficient, as a ratio of accumulated tangent to normal u.
  S friction{};
  /// Accumulated u along the normal, the tangent, and for the bias velocities.
  S normalSum{}, tangentSum{}, biasSum{};
  /// From u back to the speed of the lighter body.
  S normalScale{}, tangentScale{};
};

/// How a pair of bodies answers impulses, relative to the lighter one: the lighter has 1 as its inverse mass.
template <Scalar S>
struct PairResponse {
  S massA{}, massB{};      ///< Inverse masses, in [0, 1].
  S momentA{}, momentB{};  ///< Inverse moments, 1/m^2.

  /// To an impulse at the given places: moments far too small for them are held.
  PairResponse at(const Vector<S>& armA, const Vector<S>& armB) const;
};

/// All 0 if nothing moves either body.
template <Scalar S>
PairResponse<S> respond(const Body<S>& a, const Body<S>& b);

/// Inverse effective mass along an axis with the given arms (r x axis), relative to the lighter body; at
/// least 1.
/// @throws UnsolvableCollision if nothing moves either body
/// MIS: k_scalar (its core)
template <Scalar S>
S effectiveInverseMass(const PairResponse<S>& response, S armA, S armB);

/// What the solver needs of a step.
template <Scalar S>
struct ContactSolver {
  std::vector<SolverBody<S>> bodies;
  std::vector<ContactRow<S>> rows;

  /// Builds the rows of one pair from the bodies' state and present velocities. MIS: arbiterPreStep
  /// @param slop      m
  /// @param biasRate  the part of an overlap that shall go, per second
  void preStep(const Pair<S>& pair, std::uint32_t indexA, std::uint32_t indexB, const Body<S>& a,
               const Body<S>& b, S slop, S biasRate);
  /// Applies the impulses kept from the last step, times dtCoefficient. MIS: arbiterApplyCachedImpulse
  void warmStart(ContactRow<S>& row, S dtCoefficient);
  /// One pass over all rows. MIS: arbiterApplyImpulse
  void iterate();
};

#ifndef SAMESTEP_FIXED_ONLY
extern template struct ContactSolver<double>;
#endif
extern template struct ContactSolver<Fixed>;
extern template struct ContactSolver<CheckedFixed>;

}  // namespace samestep
