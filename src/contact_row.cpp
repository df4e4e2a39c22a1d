// SPDX-License-Identifier: MIT
#include "contact_row.h"

#include <samestep/error.h>

#include "require_ieee.h"

namespace samestep {
namespace {

/// The largest ratio of tangent to normal u.
template <Scalar S>
inline constexpr S kMaxFrictionRatio = S(1 << 10);

/// The inverse moment, held where the response to an impulse at `arm` stays in range. Only a moment far
/// too small for the mass and size of a body is ever held.
template <Scalar S>
S heldMoment(S moment, const Vector<S>& arm) {
  if (moment <= S(256)) [[likely]]
    return moment;
  const S reach = max(abs(arm.x), abs(arm.y));
  const S least = ratio<S>(1, 1024);
  const S held = max(reach, least);
  return min(moment, S(1 << 24) / held / held);
}

/// a * b, held within +-kMaxSum.
template <Scalar S>
S productHeld(S a, S k) {
  const S product = k <= S(1 << 10) ? a * k : mulDiv(a, k, S(1));
  return clamp(product, -kMaxSum<S>, kMaxSum<S>);
}

template <Scalar S>
S relativeMoment(const Body<S>& body, const Scaled<S>& lighterMass) {
  if (body.inverseMoment() == Scaled<S>{}) return S(0);
  return toScalar<S>(body.inverseMoment() * lighterMass);
}

}  // namespace

template <Scalar S>
PairResponse<S> respond(const Body<S>& a, const Body<S>& b) {
  const bool aIsLighter = a.inverseMass() > b.inverseMass();
  const Body<S>& light = aIsLighter ? a : b;
  const Body<S>& heavy = aIsLighter ? b : a;
  const Scaled<S> lightMass = toScaled(light.mass());
  const bool equal = light.inverseMass() == heavy.inverseMass();
  const S heavyInverse = equal ? S(1) : toScalar<S>(heavy.inverseMass() * lightMass);
  return {aIsLighter ? S(1) : heavyInverse, aIsLighter ? heavyInverse : S(1), relativeMoment(a, lightMass),
          relativeMoment(b, lightMass)};
}

template <Scalar S>
S effectiveInverseMass(const PairResponse<S>& response, S armA, S armB) {
  const S k =
      dot(response.momentA * armA, armA, response.momentB * armB, armB) + (response.massA + response.massB);
  require<Fault::UnsolvableCollision>(k > S(0));
  return k;
}

template <Scalar S>
void prepareAxes(const Pair<S>& pair, const Contact<S>& contact, const PairResponse<S>& whole,
                 const Body<S>& a, const Body<S>& b, ContactAxes<S>& row) {
  const Vector<S> n = pair.normal;
  const Vector<S> t = perp(n);
  const Vector<S> armA = contact.pointA - a.worldCenter();
  const Vector<S> armB = contact.pointB - b.worldCenter();
  PairResponse<S> response = whole;
  response.momentA = heldMoment(whole.momentA, armA);
  response.momentB = heldMoment(whole.momentB, armB);

  row.normal = n;
  row.normalArmA = cross(armA, n);
  row.normalArmB = cross(armB, n);
  row.tangentArmA = cross(armA, t);
  row.tangentArmB = cross(armB, t);
  const S normalK = effectiveInverseMass(response, row.normalArmA, row.normalArmB);
  const S tangentK = effectiveInverseMass(response, row.tangentArmA, row.tangentArmB);
  const S normalMass = reciprocal(normalK);
  const S tangentMass = reciprocal(tangentK);
  row.speedA = response.massA * normalMass;
  row.speedB = response.massB * normalMass;
  row.spinA = response.momentA * row.normalArmA * normalMass;
  row.spinB = response.momentB * row.normalArmB * normalMass;
  row.tangentSpeedA = response.massA * tangentMass;
  row.tangentSpeedB = response.massB * tangentMass;
  row.tangentSpinA = response.momentA * row.tangentArmA * tangentMass;
  row.tangentSpinB = response.momentB * row.tangentArmB * tangentMass;
  row.normalScale = normalMass;
  row.tangentScale = tangentMass;
  row.friction = min(mulDiv(pair.friction, tangentK, normalK), kMaxFrictionRatio<S>);
  row.surface = dot(pair.surfaceVelocity, t);
  row.normalSum = productHeld(contact.normalSpeed, normalK);
  row.tangentSum = productHeld(contact.tangentSpeed, tangentK);
}

#ifndef SAMESTEP_FIXED_ONLY
template PairResponse<double> respond(const Body<double>&, const Body<double>&);
template double effectiveInverseMass(const PairResponse<double>&, double, double);
template void prepareAxes(const Pair<double>&, const Contact<double>&, const PairResponse<double>&,
                          const Body<double>&, const Body<double>&, ContactAxes<double>&);
#endif
template PairResponse<Fixed> respond(const Body<Fixed>&, const Body<Fixed>&);
template Fixed effectiveInverseMass(const PairResponse<Fixed>&, Fixed, Fixed);
template void prepareAxes(const Pair<Fixed>&, const Contact<Fixed>&, const PairResponse<Fixed>&,
                          const Body<Fixed>&, const Body<Fixed>&, ContactAxes<Fixed>&);
template PairResponse<CheckedFixed> respond(const Body<CheckedFixed>&, const Body<CheckedFixed>&);
template CheckedFixed effectiveInverseMass(const PairResponse<CheckedFixed>&, CheckedFixed, CheckedFixed);
template void prepareAxes(const Pair<CheckedFixed>&, const Contact<CheckedFixed>&,
                          const PairResponse<CheckedFixed>&, const Body<CheckedFixed>&,
                          const Body<CheckedFixed>&, ContactAxes<CheckedFixed>&);

}  // namespace samestep
