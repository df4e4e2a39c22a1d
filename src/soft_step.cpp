// SPDX-License-Identifier: MIT
#include "soft_step.h"

#include <samestep/high_water.h>

#include "require_ieee.h"

namespace samestep {

template <Scalar S>
Softness<S> makeSoftness(S hertz, S dampingRatio, S substep) {
  if (hertz == S(0)) return {S(0), S(1), S(0)};
  const S omega = S(2) * kPi<S> * hertz;
  const S a1 = S(2) * dampingRatio + substep * omega;
  const S a2 = substep * omega * a1;
  const S a3 = reciprocal(S(1) + a2);
  return {omega / a1, a2 * a3, a3};
}

template <Scalar S>
void SoftSolver<S>::preStep(const Pair<S>& pair, std::uint32_t pairIndex, std::uint32_t indexA,
                            std::uint32_t indexB, const Body<S>& a, const Body<S>& b, bool roundA,
                            bool roundB, S bounceThreshold) {
  const PairResponse<S> response = respond(a, b);
  const std::uint16_t soft = a.isDynamic() && b.isDynamic() ? 0 : 1;
  for (int i = 0; i < pair.count; ++i) {
    const Contact<S>& contact = pair.contacts[i];
    SoftRow<S>& row = rows.emplace_back();
    row.bodyA = indexA;
    row.bodyB = indexB;
    prepareAxes(pair, contact, response, a, b, row);
    // r . n is r x t.
    row.bendA = roundA ? S(0) : row.tangentArmA;
    row.bendB = roundB ? S(0) : row.tangentArmB;
    row.separation = clamp(row.separation, S(-(1 << 10)), S(1 << 10));
    row.softness = soft;
    row.pair = pairIndex;
    row.contact = static_cast<std::uint16_t>(i);
    const S approach =
        normalSpeed(row, b.velocity() - a.velocity(), a.angularVelocity(), b.angularVelocity());
    row.bounce = approach < -bounceThreshold ? -(pair.elasticity * approach) : S(0);
  }
}

template <Scalar S>
void SoftSolver<S>::integrateVelocities() {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    SoftBody<S>& body = bodies[i];
    const SoftDrive<S>& drive = drives[i];
    body.velocity = {clamp(mulAdd(body.velocity.x, kept, drive.velocity.x), -kMaxSpeed<S>, kMaxSpeed<S>),
                     clamp(mulAdd(body.velocity.y, kept, drive.velocity.y), -kMaxSpeed<S>, kMaxSpeed<S>)};
    body.angularVelocity = clamp(mulAdd(body.angularVelocity, kept, drive.angularVelocity),
                                 -kMaxAngularSpeed<S>, kMaxAngularSpeed<S>);
  }
}

template <Scalar S>
void SoftSolver<S>::warmStart() {
  for (const SoftRow<S>& row : rows) {
    SoftBody<S>& a = bodies[row.bodyA];
    SoftBody<S>& b = bodies[row.bodyB];
    answer(row, row.normalSum, row.tangentSum, a.velocity, a.angularVelocity, b.velocity, b.angularVelocity);
  }
}

namespace {

/// One contact: friction against the normal impulse so far, then the normal, which has the last word.
template <bool kSprings, Scalar S>
[[gnu::always_inline]] inline void solveRow(SoftRow<S>& row, SoftBody<S>& a, SoftBody<S>& b,
                                            const Softness<S>& soft, S perSubstep, S pushSpeed) {
  S target = S(0), massScale = S(1), impulseScale = S(0);
  const Vector<S> moved = b.moved - a.moved;
  const S separation = row.separation + normalSpeed(row, moved, a.turned, b.turned) +
                       cross(row.bendA, a.bend, row.bendB, b.bend);
  if (separation > S(0)) {
    // Not touching yet: may come as near as it is within this substep.
    target = separation * perSubstep;
  } else if (kSprings) {
    target = max(separation * soft.biasRate, -pushSpeed);
    massScale = soft.massScale;
    impulseScale = soft.impulseScale;
  }
  const S limit = row.friction * row.normalSum;
  const S tangent =
      tangentSpeed(row, b.velocity - a.velocity, a.angularVelocity, b.angularVelocity) + row.surface;
  const S tangentBefore = row.tangentSum;
  row.tangentSum = clamp(tangentBefore - tangent, -limit, limit);
  answerTangent(row, row.tangentSum - tangentBefore, a.velocity, a.angularVelocity, b.velocity,
                b.angularVelocity);

  const S normal = normalSpeed(row, b.velocity - a.velocity, a.angularVelocity, b.angularVelocity);
  const S normalBefore = row.normalSum;
  row.normalSum =
      clamp(normalBefore - dot(massScale, normal + target, impulseScale, normalBefore), S(0), kMaxSum<S>);
  row.normalMost = max(row.normalMost, row.normalSum);
  highWater<S>("soft step: relative speed", max(abs(normal), abs(tangent)));
  highWater<S>("soft step: target speed", target);
  highWater<S>("soft step: friction limit", limit);
  answerNormal(row, row.normalSum - normalBefore, a.velocity, a.angularVelocity, b.velocity,
               b.angularVelocity);
}

}  // namespace

template <Scalar S>
void SoftSolver<S>::solve() {
  for (SoftRow<S>& row : rows) {
    solveRow<true>(row, bodies[row.bodyA], bodies[row.bodyB], softness[row.softness], perSubstep, pushSpeed);
  }
}

template <Scalar S>
void SoftSolver<S>::relax() {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SoftRow<S>& row = rows[i];
    solveRow<false>(row, bodies[row.bodyA], bodies[row.bodyB], softness[row.softness], perSubstep, pushSpeed);
  }
}

template <Scalar S>
void SoftSolver<S>::integratePositions() {
  const S half = ratio<S>(1, 2);
  const S most = ratio<S>(1, 8);
  for (SoftBody<S>& body : bodies) {
    body.moved = mulAdd(body.velocity, substep, body.moved);
    body.turned = mulAdd(body.angularVelocity, substep, body.turned);
    // Beyond half a radian the bend is no longer a parabola; the contact is found anew next step.
    body.bend = min(body.turned * body.turned * half, most);
  }
}

template <Scalar S>
void SoftSolver<S>::bounce() {
  for (SoftRow<S>& row : rows) {
    if (row.bounce == S(0) || row.normalMost == S(0)) continue;
    SoftBody<S>& a = bodies[row.bodyA];
    SoftBody<S>& b = bodies[row.bodyB];
    const S speed = normalSpeed(row, b.velocity - a.velocity, a.angularVelocity, b.angularVelocity);
    const S before = row.normalSum;
    row.normalSum = clamp(before + (row.bounce - speed), S(0), kMaxSum<S>);
    row.normalTotal += row.normalSum - before;
    answer(row, row.normalSum - before, S(0), a.velocity, a.angularVelocity, b.velocity, b.angularVelocity);
  }
}

template <Scalar S>
void SoftSolver<S>::sum() {
  for (SoftRow<S>& row : rows) {
    row.normalTotal += row.normalSum;
    row.tangentTotal += row.tangentSum;
    highWater<S>("soft step: impulse total", row.normalTotal);
  }
}

#ifndef SAMESTEP_FIXED_ONLY
template Softness<double> makeSoftness(double, double, double);
template struct SoftSolver<double>;
#endif
template Softness<Fixed> makeSoftness(Fixed, Fixed, Fixed);
template struct SoftSolver<Fixed>;
template Softness<CheckedFixed> makeSoftness(CheckedFixed, CheckedFixed, CheckedFixed);
template struct SoftSolver<CheckedFixed>;

}  // namespace samestep
