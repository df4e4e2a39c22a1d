// SPDX-License-Identifier: MIT
#include "contacts/contact_row.h"

#include <samestep/error.h>
#include <samestep/high_water.h>

#include "base/require_ieee.h"
#include "contacts/contact_geometry.h"

namespace samestep {
namespace {

/// The largest ratio of tangent to normal u.
template <Scalar S>
inline constexpr S kMaxFrictionRatio = S(1 << 10);

template <Scalar S>
S relativeMoment(const Body<S>& body, const Scaled<S>& lighterMass) {
  if (body.inverseMoment() == Scaled<S>{}) return S(0);
  return toScalarWithin(body.inverseMoment() * lighterMass, kMaxRelativeMoment<S>);
}

/// Coulomb's limit in units of u, held at its largest without leaving the range on the way.
template <Scalar S>
S frictionRatio(S friction, S tangentK, S normalK) {
  const bool steep = tangentK * ratio<S>(1, 1024) > normalK;
  return min(mulDiv(steep ? min(friction, S(1)) : friction, tangentK, normalK), kMaxFrictionRatio<S>);
}

/// An impulse kept as a speed of the lighter body, in units of u.
template <Scalar S>
S sumOf(S speed, S k, S inverseK) {
  const S limit = kMaxSum<S> * inverseK;
  return speed >= limit ? kMaxSum<S> : speed <= -limit ? -kMaxSum<S> : speed * k;
}

}  // namespace

template <Scalar S>
PairResponse<S> respond(const Body<S>& a, const Body<S>& b) {
  const bool aIsLighter = a.inverseMass() > b.inverseMass();
  const Body<S>& light = aIsLighter ? a : b;
  const Body<S>& heavy = aIsLighter ? b : a;
  const Scaled<S> lightMass = toScaled(light.mass());
  if (light.inverseMass() == Scaled<S>{}) return {};
  const bool equal = light.inverseMass() == heavy.inverseMass();
  const S heavyInverse = equal ? S(1) : toScalar<S>(heavy.inverseMass() * lightMass);
  return {aIsLighter ? S(1) : heavyInverse, aIsLighter ? heavyInverse : S(1), relativeMoment(a, lightMass),
          relativeMoment(b, lightMass)};
}

template <Scalar S>
PairResponse<S> PairResponse<S>::at(const Vector<S>& armA, const Vector<S>& armB) const {
  return {massA, massB, heldMoment(momentA, armA), heldMoment(momentB, armB)};
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
  const Vector<S> n = worldNormal(pair, a);
  const Vector<S> t = perp(n);
  const auto [armA, armB, separation] = contactArms(contact, n, a, b);
  row.separation = separation;
  const PairResponse<S> response = whole.at(armA, armB);

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
  row.friction = frictionRatio(pair.friction, tangentK, normalK);
  row.surface = dot(pair.surfaceVelocity, t);
  row.normalSum = max(sumOf(contact.normalSpeed, normalK, normalMass), S(0));
  row.tangentSum = sumOf(contact.tangentSpeed, tangentK, tangentMass);
  // The arm of a body that nothing turns counts for nothing.
  highWater<S>("contact: r x n of a body that turns", response.momentA > S(0) ? row.normalArmA : S(0));
  highWater<S>("contact: r x n of a body that turns", response.momentB > S(0) ? row.normalArmB : S(0));
  highWater<S>("contact: inverse effective mass k", max(normalK, tangentK));
  highWater<S>("contact: spin per unit of u", max(abs(row.spinA), abs(row.spinB)));
  highWater<S>("contact: friction ratio", row.friction);
  highWater<S>("contact: kept impulse u", row.normalSum);
}

#define SAMESTEP_EACH_SCALAR                                                                           \
  template struct PairResponse<S>;                                                                     \
  template PairResponse<S> respond(const Body<S>&, const Body<S>&);                                    \
  template S effectiveInverseMass(const PairResponse<S>&, S, S);                                       \
  template void prepareAxes(const Pair<S>&, const Contact<S>&, const PairResponse<S>&, const Body<S>&, \
                            const Body<S>&, ContactAxes<S>&);
#include <samestep/each_scalar.h>

}  // namespace samestep
