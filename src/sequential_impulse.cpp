// SPDX-License-Identifier: MIT
#include "sequential_impulse.h"

#include <samestep/error.h>

#include "require_ieee.h"

namespace samestep {
namespace {

/// The largest accumulated u, m/s: a contact can hold a weight of some millions of times the lighter body's.
template <Scalar S>
inline constexpr S kMaxSum = S(1 << 20);
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
void ContactSolver<S>::preStep(const Pair<S>& pair, std::uint32_t indexA, std::uint32_t indexB,
                               const Body<S>& a, const Body<S>& b, S slop, S biasRate) {
  const PairResponse<S> whole = respond(a, b);
  const Vector<S> n = pair.normal;
  const Vector<S> t = perp(n);
  const S surface = dot(pair.surfaceVelocity, t);
  for (int i = 0; i < pair.count; ++i) {
    const Contact<S>& contact = pair.contacts[i];
    const Vector<S> armA = contact.pointA - a.worldCenter();
    const Vector<S> armB = contact.pointB - b.worldCenter();
    PairResponse<S> response = whole;
    response.momentA = heldMoment(whole.momentA, armA);
    response.momentB = heldMoment(whole.momentB, armB);

    ContactRow<S>& row = rows.emplace_back();
    row.bodyA = indexA;
    row.bodyB = indexB;
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
    row.surface = surface;

    const S gap = dot(contact.pointB - contact.pointA, n);
    const S overlap = clamp(-(gap + slop), S(0), S(1 << 10));
    row.bias = min(overlap * biasRate, kMaxSpeed<S>);
    const Vector<S> dv = b.velocity() - a.velocity();
    const S approach =
        dot4(n.x, dv.x, n.y, dv.y, row.normalArmB, b.angularVelocity(), -row.normalArmA, a.angularVelocity());
    row.bounce = approach * pair.elasticity;
    row.normalSum = productHeld(contact.normalSpeed, normalK);
    row.tangentSum = productHeld(contact.tangentSpeed, tangentK);
  }
}

namespace {

/// Answers an impulse of u along the normal and w along the tangent.
template <Scalar S>
[[gnu::always_inline]] inline void answer(Vector<S>& velocityA, S& spinA, Vector<S>& velocityB, S& spinB,
                                          const ContactRow<S>& row, S u, S w) {
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

}  // namespace

template <Scalar S>
void ContactSolver<S>::warmStart(ContactRow<S>& row, S dtCoefficient) {
  SolverBody<S>& a = bodies[row.bodyA];
  SolverBody<S>& b = bodies[row.bodyB];
  answer(a.velocity, a.angularVelocity, b.velocity, b.angularVelocity, row, row.normalSum * dtCoefficient,
         row.tangentSum * dtCoefficient);
}

template <Scalar S>
void ContactSolver<S>::iterate() {
  for (ContactRow<S>& row : rows) {
    SolverBody<S>& a = bodies[row.bodyA];
    SolverBody<S>& b = bodies[row.bodyB];
    const Vector<S> n = row.normal;

    const Vector<S> biasDv = b.biasVelocity - a.biasVelocity;
    const S biasSpeed = dot4(n.x, biasDv.x, n.y, biasDv.y, row.normalArmB, b.biasAngularVelocity,
                             -row.normalArmA, a.biasAngularVelocity);
    const S biasBefore = row.biasSum;
    row.biasSum = max(biasBefore + (row.bias - biasSpeed), S(0));
    const S biasChange = row.biasSum - biasBefore;

    const Vector<S> dv = b.velocity - a.velocity;
    const S normalSpeed =
        dot4(n.x, dv.x, n.y, dv.y, row.normalArmB, b.angularVelocity, -row.normalArmA, a.angularVelocity);
    const S tangentSpeed =
        dot4(-n.y, dv.x, n.x, dv.y, row.tangentArmB, b.angularVelocity, -row.tangentArmA, a.angularVelocity) +
        row.surface;
    const S normalBefore = row.normalSum;
    row.normalSum = clamp(normalBefore - (row.bounce + normalSpeed), S(0), kMaxSum<S>);
    const S limit = row.friction * row.normalSum;
    const S tangentBefore = row.tangentSum;
    row.tangentSum = clamp(tangentBefore - tangentSpeed, -limit, limit);

    if (biasChange != S(0)) {
      const S speedA = row.speedA * biasChange;
      const S speedB = row.speedB * biasChange;
      a.biasVelocity -= n * speedA;
      a.biasAngularVelocity -= row.spinA * biasChange;
      b.biasVelocity += n * speedB;
      b.biasAngularVelocity += row.spinB * biasChange;
    }
    answer(a.velocity, a.angularVelocity, b.velocity, b.angularVelocity, row, row.normalSum - normalBefore,
           row.tangentSum - tangentBefore);
  }
}

#ifndef SAMESTEP_FIXED_ONLY
template PairResponse<double> respond(const Body<double>&, const Body<double>&);
template double effectiveInverseMass(const PairResponse<double>&, double, double);
template struct ContactSolver<double>;
#endif
template PairResponse<Fixed> respond(const Body<Fixed>&, const Body<Fixed>&);
template Fixed effectiveInverseMass(const PairResponse<Fixed>&, Fixed, Fixed);
template struct ContactSolver<Fixed>;
template PairResponse<CheckedFixed> respond(const Body<CheckedFixed>&, const Body<CheckedFixed>&);
template CheckedFixed effectiveInverseMass(const PairResponse<CheckedFixed>&, CheckedFixed, CheckedFixed);
template struct ContactSolver<CheckedFixed>;

}  // namespace samestep
