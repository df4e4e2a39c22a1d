// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/arbiter.h>
#include <samestep/body.h>

namespace samestep {

/// The largest accumulated u, m/s: a contact can hold a weight of some millions of times the lighter body's.
template <Scalar S>
inline constexpr S kMaxSum = S(1 << 20);

/// Response of a pair of bodies to impulses, relative to the lighter one: the lighter has 1 as its inverse
/// mass.
template <Scalar S>
struct PairResponse {
  S massA{}, massB{};      ///< Inverse masses, in [0, 1].
  S momentA{}, momentB{};  ///< Inverse moments, 1/m^2.

  /// Response to an impulse at the given places: moments far too small for them are clamped.
  PairResponse at(const Vector<S>& armA, const Vector<S>& armB) const;
};

/// All 0 if nothing moves either body.
template <Scalar S>
PairResponse<S> respond(const Body<S>& a, const Body<S>& b);

/// A relative inverse moment, held where the response to an impulse at `arm` stays in range. Only a moment
/// far too small for the mass and size of a body is ever held.
template <Scalar S>
[[gnu::always_inline]] inline S heldMoment(S moment, const Vector<S>& arm) {
  const S reach = max(abs(arm.x), abs(arm.y));
  if (moment <= S(64) && reach <= S(512)) [[likely]]
    return moment;
  return reach <= S(8) ? moment : min(moment, S(1 << 24) / reach / reach);
}

/// Inverse effective mass along an axis with the given arms (r x axis), relative to the lighter body; >= 1.
/// @throws UnsolvableCollision (an internal error) if neither body can be moved
/// MIS: k_scalar
template <Scalar S>
S effectiveInverseMass(const PairResponse<S>& response, S armA, S armB);

/// One contact point, ready to be solved in velocity units: an impulse is the change u of the relative speed
/// it makes, so no mass appears in the loop. With k = 1/nMass, a body of inverse mass m and inverse moment i
/// answers u with the speed (m/k) u and the spin (i (r x n)/k) u.
template <Scalar S>
struct ContactAxes {
  std::uint32_t bodyA = 0;
  std::uint32_t bodyB = 0;
  Vector<S> normal{};
  /// r x n and r x t of both bodies, m; t is the left perpendicular of n.
  S normalArmA{}, normalArmB{}, tangentArmA{}, tangentArmB{};
  /// m/k, i (r x n)/k along the normal and along the tangent.
  S speedA{}, speedB{}, spinA{}, spinB{};
  S tangentSpeedA{}, tangentSpeedB{}, tangentSpinA{}, tangentSpinB{};
  /// Separation of the surfaces along the normal, m; negative where they overlap.
  S separation{};
  /// The surface's own speed along the tangent, m/s.
  S surface{};
  /// Friction coefficient, as a ratio of accumulated tangent to normal u.
  S friction{};
  /// Accumulated u along the normal and the tangent.
  S normalSum{}, tangentSum{};
  /// Scales from u back to the speed of the lighter body.
  S normalScale{}, tangentScale{};
};

/// Fills the axes of one contact of a pair; the sums with what the contact kept.
template <Scalar S>
void prepareAxes(const Pair<S>& pair, const Contact<S>& contact, const PairResponse<S>& whole,
                 const Body<S>& a, const Body<S>& b, ContactAxes<S>& row);

/// The relative speed of the contact points along the normal, m/s; negative where they approach.
template <Scalar S>
[[gnu::always_inline]] inline S normalSpeed(const ContactAxes<S>& row, const Vector<S>& dv, S spinA,
                                            S spinB) {
  return dot4(row.normal.x, dv.x, row.normal.y, dv.y, row.normalArmB, spinB, -row.normalArmA, spinA);
}

/// Speed along the tangent, m/s, without the surface's own speed.
template <Scalar S>
[[gnu::always_inline]] inline S tangentSpeed(const ContactAxes<S>& row, const Vector<S>& dv, S spinA,
                                             S spinB) {
  return dot4(-row.normal.y, dv.x, row.normal.x, dv.y, row.tangentArmB, spinB, -row.tangentArmA, spinA);
}

/// Answers an impulse of u along the normal and w along the tangent.
template <Scalar S>
[[gnu::always_inline]] inline void answer(const ContactAxes<S>& row, S u, S w, Vector<S>& velocityA, S& spinA,
                                          Vector<S>& velocityB, S& spinB) {
  const Vector<S> n = row.normal;
  const S nA = row.speedA * u;
  const S tA = row.tangentSpeedA * w;
  const S nB = row.speedB * u;
  const S tB = row.tangentSpeedB * w;
  velocityA.x -= cross(n.x, nA, n.y, tA);
  velocityA.y -= dot(n.y, nA, n.x, tA);
  spinA -= dot(row.spinA, u, row.tangentSpinA, w);
  velocityB.x += cross(n.x, nB, n.y, tB);
  velocityB.y += dot(n.y, nB, n.x, tB);
  spinB += dot(row.spinB, u, row.tangentSpinB, w);
}

/// Answers an impulse of u along the normal alone.
template <Scalar S>
[[gnu::always_inline]] inline void answerNormal(const ContactAxes<S>& row, S u, Vector<S>& velocityA,
                                                S& spinA, Vector<S>& velocityB, S& spinB) {
  velocityA -= row.normal * (row.speedA * u);
  spinA -= row.spinA * u;
  velocityB += row.normal * (row.speedB * u);
  spinB += row.spinB * u;
}

/// Answers an impulse of w along the tangent alone.
template <Scalar S>
[[gnu::always_inline]] inline void answerTangent(const ContactAxes<S>& row, S w, Vector<S>& velocityA,
                                                 S& spinA, Vector<S>& velocityB, S& spinB) {
  const Vector<S> t = perp(row.normal);
  velocityA -= t * (row.tangentSpeedA * w);
  spinA -= row.tangentSpinA * w;
  velocityB += t * (row.tangentSpeedB * w);
  spinB += row.tangentSpinB * w;
}

}  // namespace samestep
