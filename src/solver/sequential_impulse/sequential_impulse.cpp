// SPDX-License-Identifier: MIT
#include "solver/sequential_impulse/sequential_impulse.h"

#include <samestep/high_water.h>

#include "base/require_ieee.h"

namespace samestep {
namespace {

/// Limits of a body's velocity while contacts answer each other, m/s and rad/s: far more than it may keep,
/// and little enough for what is computed from it, at arms of up to 2^10.5 m. One contact changes a speed by
/// no more than 2^21, a spin by no more than 2^30.
template <Scalar S>
inline constexpr S kMostSpeed = S(1 << 22);
template <Scalar S>
inline constexpr S kMostSpin = S(1 << 19);
/// Limit while kept impulses are given, which may turn a body to and fro and leave it at rest: so that one
/// more fits.
template <Scalar S>
inline constexpr S kMostGiven = S(1 << 29);

/// Tells without branches, for it is asked of each contact in each pass.
template <Scalar S>
bool allWithin(S x, S y, S z, S limit) {
  return (static_cast<int>(within(x, limit)) & static_cast<int>(within(y, limit)) &
          static_cast<int>(within(z, limit))) != 0;
}

template <Scalar S>
void holdAt(ImpulseBody<S>& body, S speed, S spin) {
  body.velocity = heldWithin(body.velocity, speed);
  body.angularVelocity = clamp(body.angularVelocity, -spin, spin);
  body.biasVelocity = heldWithin(body.biasVelocity, speed);
  body.biasAngularVelocity = clamp(body.biasAngularVelocity, -spin, spin);
}

/// Holds what impulses have made of a body's velocities; in double there is room for any.
template <Scalar S>
void hold(ImpulseBody<S>& body) {
  if constexpr (!kIsFixed<S>) return;
  if (allWithin(body.velocity.x, body.velocity.y, body.angularVelocity, kMostSpin<S>) &&
      allWithin(body.biasVelocity.x, body.biasVelocity.y, body.biasAngularVelocity, kMostSpin<S>))
      [[likely]] {
    return;
  }
  holdAt(body, kMostSpeed<S>, kMostSpin<S>);
}

}  // namespace

template <Scalar S>
void ImpulseSolver<S>::preStep(const Pair<S>& pair, std::uint32_t indexA, std::uint32_t indexB,
                               const Body<S>& a, const Body<S>& b, S slop, S biasRate) {
  const PairResponse<S> response = respond(a, b);
  for (int i = 0; i < pair.count; ++i) {
    const Contact<S>& contact = pair.contacts[i];
    ImpulseRow<S>& row = rows.emplace_back();
    row.bodyA = indexA;
    row.bodyB = indexB;
    prepareAxes(pair, contact, response, a, b, row);
    row.normalLacks = row.normalSum;
    row.tangentLacks = row.tangentSum;
    const S overlap = clamp(-(row.separation + slop), S(0), S(1 << 10));
    row.bias = min(overlap * biasRate, kMaxSpeed<S>);
    row.bounce = pair.elasticity *
                 normalSpeed(row, b.velocity() - a.velocity(), a.angularVelocity(), b.angularVelocity());
  }
}

template <Scalar S>
void ImpulseSolver<S>::warmStart(ImpulseRow<S>& row, S dtCoefficient) {
  ImpulseBody<S>& a = bodies[row.bodyA];
  ImpulseBody<S>& b = bodies[row.bodyB];
  const S normal = min(row.normalSum * dtCoefficient, kMaxSum<S>);
  const S tangent = clamp(row.tangentSum * dtCoefficient, -kMaxSum<S>, kMaxSum<S>);
  row.normalLacks = row.normalSum - normal;
  row.tangentLacks = row.tangentSum - tangent;
  answer(row, normal, tangent, a.velocity, a.angularVelocity, b.velocity, b.angularVelocity);
  if constexpr (kIsFixed<S>) {
    for (ImpulseBody<S>* body : {&a, &b}) holdAt(*body, kMostGiven<S>, kMostGiven<S>);
  }
}

template <Scalar S>
void ImpulseSolver<S>::iterate() {
  // The velocities are clamped before anything is computed from them.
  for (ImpulseBody<S>& body : bodies) hold(body);
  for (ImpulseRow<S>& row : rows) {
    ImpulseBody<S>& a = bodies[row.bodyA];
    ImpulseBody<S>& b = bodies[row.bodyB];

    const S apart =
        normalSpeed(row, b.biasVelocity - a.biasVelocity, a.biasAngularVelocity, b.biasAngularVelocity);
    const S biasBefore = row.biasSum;
    row.biasSum = clamp(biasBefore + (row.bias - apart), S(0), kMaxSum<S>);
    const S biasChange = row.biasSum - biasBefore;

    const Vector<S> dv = b.velocity - a.velocity;
    const S normal = normalSpeed(row, dv, a.angularVelocity, b.angularVelocity);
    const S tangent = tangentSpeed(row, dv, a.angularVelocity, b.angularVelocity) + row.surface;
    const S normalBefore = row.normalSum;
    row.normalSum = clamp(normalBefore - (row.bounce + normal), S(0), kMaxSum<S>);
    const S limit = min(row.friction * row.normalSum, kMaxSum<S>);
    highWater<S>("impulses: relative speed", max(abs(normal), abs(tangent)));
    highWater<S>("impulses: friction limit", limit);
    const S tangentBefore = row.tangentSum;
    row.tangentSum = clamp(tangentBefore - tangent, -limit, limit);

    if (biasChange != S(0)) {
      const Vector<S> n = row.normal;
      a.biasVelocity -= n * (row.speedA * biasChange);
      a.biasAngularVelocity -= row.spinA * biasChange;
      b.biasVelocity += n * (row.speedB * biasChange);
      b.biasAngularVelocity += row.spinB * biasChange;
    }
    answer(row, row.normalSum - normalBefore, row.tangentSum - tangentBefore, a.velocity, a.angularVelocity,
           b.velocity, b.angularVelocity);
    hold(a);
    hold(b);
  }
}

#define SAMESTEP_EACH_SCALAR template struct ImpulseSolver<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
