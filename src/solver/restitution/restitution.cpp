// SPDX-License-Identifier: MIT
#include "solver/restitution/restitution.h"

#include "base/require_ieee.h"

namespace samestep {
namespace {

/// Limit of a velocity's change, m/s and rad/s.
template <Scalar S>
inline constexpr S kMostChange = S(1 << 22);

/// Points are solved until none changes by more than this, m/s.
template <Scalar S>
inline constexpr S kStill = S(0x1p-28);

/// The relative speed of the points along an axis, m/s.
template <Scalar S>
S relativeSpeed(const Vector<S>& axis, S armA, S armB, const S (&a)[3], const S (&b)[3]) {
  return dot(axis.x, b[0] - a[0], axis.y, b[1] - a[1]) + cross(armB, b[2], armA, a[2]);
}

/// x * y, held in size.
template <Scalar S>
S heldProduct(S x, S y) {
  return toScalarWithin(toScaled(x) * toScaled(y), kMostChange<S>);
}

/// Two points are one where solving them together would divide by less than this.
template <Scalar S>
inline constexpr S kApart = S(0x1p-12);

}  // namespace

/// Solves one point, with no more than it has given taken back.
/// @return by how much it changed
template <Scalar S>
S Restitution<S>::pressPoint(BouncePoint<S>& point) {
  const BounceBody<S>&a = bodies[point.bodyA], &b = bodies[point.bodyB];
  const S speed = relativeSpeed(point.normal, point.armA, point.armB, a.velocity, b.velocity);
  const S k = S(1) + dot(point.spinA, point.armA, point.spinB, point.armB);
  return take(point, max(-heldProduct(speed, reciprocal(k)), -point.taken));
}

/// Gives a point more, and its bodies.
/// @return its size
template <Scalar S>
S Restitution<S>::take(BouncePoint<S>& point, S u) {
  point.taken += u;
  point.pressed += u;
  push(point, point.normal, point.spinA, point.spinB, u);
  return abs(u);
}

/// Solves the two points of a pair together, for one after the other comes to rest only slowly where they are
/// near each other and friction turns the body; one after the other where one of them would pull.
template <Scalar S>
S Restitution<S>::pressPair(BouncePoint<S>& first, BouncePoint<S>& second) {
  const BounceBody<S>&a = bodies[first.bodyA], &b = bodies[first.bodyB];
  const auto speedOf = [&](const BouncePoint<S>& point) {
    return toScaled(relativeSpeed(point.normal, point.armA, point.armB, a.velocity, b.velocity));
  };
  const auto answerOf = [&](const BouncePoint<S>& to, const BouncePoint<S>& at) {
    return toScaled(S(1) + dot(to.spinA, at.armA, to.spinB, at.armB));
  };
  const Scaled<S> k1 = answerOf(first, first), k2 = answerOf(second, second), k12 = answerOf(first, second);
  const Scaled<S> determinant = k1 * k2 - k12 * k12;
  if (sign(determinant - k1 * k2 * toScaled(kApart<S>)) > 0) {
    const Scaled<S> v1 = speedOf(first), v2 = speedOf(second);
    const S u = toScalarWithin<S>((k12 * v2 - k2 * v1) / determinant, kMostChange<S>);
    const S w = toScalarWithin<S>((k12 * v1 - k1 * v2) / determinant, kMostChange<S>);
    if (u >= -first.taken && w >= -second.taken) {
      const S changed = take(first, u);
      return max(changed, take(second, w));
    }
  }
  // Compilers evaluate arguments in orders of their own.
  const S changed = pressPoint(first);
  return max(changed, pressPoint(second));
}

/// Solves one point along the tangent, within what friction of all that it has given allows.
/// @return by how much it changed
template <Scalar S>
S Restitution<S>::rubPoint(BouncePoint<S>& point) {
  const BounceBody<S>&a = bodies[point.bodyA], &b = bodies[point.bodyB];
  const Vector<S> t = perp(point.normal);
  const S speed =
      relativeSpeed(t, point.tangentArmA, point.tangentArmB, a.velocity, b.velocity) + point.surface;
  const S k = S(1) + dot(point.tangentSpinA, point.tangentArmA, point.tangentSpinB, point.tangentArmB);
  const S limit = max(heldProduct(point.friction, point.pressed + point.rebound), abs(point.rubbed));
  const S u = clamp(point.rubbed - heldProduct(speed, reciprocal(k)), -limit, limit) - point.rubbed;
  point.rubbed += u;
  push(point, t, point.tangentSpinA, point.tangentSpinB, u);
  return abs(u);
}

/// Gives both bodies of a point an impulse along an axis.
template <Scalar S>
void Restitution<S>::push(const BouncePoint<S>& point, const Vector<S>& axis, S spinA, S spinB, S u) {
  const auto change = [&](BounceBody<S>& body, S share, S spin, S by) {
    if (body.mass == S(0)) return;
    const S changes[3] = {share * (axis.x * by), share * (axis.y * by), heldProduct(spin, by)};
    for (int i = 0; i < 3; ++i) {
      body.velocity[i] = clamp(body.velocity[i] + changes[i], -kMostChange<S>, kMostChange<S>);
    }
  };
  change(bodies[point.bodyA], point.shareA, spinA, -u);
  change(bodies[point.bodyB], S(1) - point.shareA, spinB, u);
}

template <Scalar S>
void Restitution<S>::press() {
  const std::size_t most = passes(points.size());
  for (std::size_t pass = 0; pass < most; ++pass) {
    S change = S(0);
    for (std::size_t i = 0; i < points.size();) {
      const bool two = i + 1 < points.size() && points[i].pair == points[i + 1].pair;
      for (std::size_t k = i; k < i + (two ? 2 : 1); ++k) {
        if (points[k].friction != S(0)) change = max(change, rubPoint(points[k]));
      }
      change = max(change, two ? pressPair(points[i], points[i + 1]) : pressPoint(points[i]));
      i += two ? 2 : 1;
    }
    if (change <= kStill<S>) return;
  }
}

/// Lets points rub by all that they have given, which takes energy only.
template <Scalar S>
void Restitution<S>::rub() {
  constexpr int kPasses = 10;
  for (int pass = 0; pass < kPasses; ++pass) {
    S most = S(0);
    for (BouncePoint<S>& point : points) {
      if (point.friction != S(0)) most = max(most, rubPoint(point));
    }
    if (most <= kStill<S>) return;
  }
}

template <Scalar S>
std::uint32_t Restitution<S>::groupOf(std::uint32_t body) {
  while (group_[body] != body) body = group_[body] = group_[group_[body]];
  return body;
}

/// Puts bodies together that bounce and that points connect; a group is named by its first body.
template <Scalar S>
void Restitution<S>::findGroups() {
  group_.resize(bodies.size());
  for (std::uint32_t i = 0; i < group_.size(); ++i) group_[i] = i;
  const auto connect = [&](const BouncePoint<S>& point) {
    if (!bounces(point.bodyA) || !bounces(point.bodyB)) return;
    const std::uint32_t a = groupOf(point.bodyA), b = groupOf(point.bodyB);
    group_[max(a, b)] = min(a, b);
  };
  for (const BouncePoint<S>& point : points) connect(point);
  for (const BouncePoint<S>& point : others) connect(point);
}

/// Adds up what bodies have lost of their energies.
template <Scalar S>
void Restitution<S>::takeBodies() {
  const Scaled<S> half = toScaled(ratio<S>(1, 2));
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    const BounceBody<S>& body = bodies[i];
    if (body.mass == S(0)) continue;
    Scaled<S> lost{};
    for (int k = 0; k < 3; ++k) {
      if (k == 2 && body.momentPerMass == S(0)) continue;
      const Scaled<S> kinetic =
          toScaled(body.before[k] - body.velocity[k]) * toScaled(body.before[k] + body.velocity[k]) * half;
      const Scaled<S> work = toScaled(body.pushed[k]) * toScaled(body.moved[k]) * toScaled(body.perSecond);
      const Scaled<S> sum = kinetic + work;
      lost += k == 2 ? sum / toScaled(body.momentPerMass) : sum;
    }
    balances_[groupOf(i)].taken += lost * toScaled(body.mass);
  }
}

/// The mass by which an impulse of a point is in N s.
template <Scalar S>
Scaled<S> Restitution<S>::massOf(const BouncePoint<S>& point) const {
  const S mass = bodies[point.bodyA].mass;
  return mass == S(0) ? toScaled(bodies[point.bodyB].mass) * toScaled(S(1) - point.shareA)
                      : toScaled(mass) * toScaled(point.shareA);
}

/// The energy that a point has given others in the step, which moved as fast as the mean of before and after,
/// J.
template <Scalar S>
Scaled<S> Restitution<S>::workThrough(const BouncePoint<S>& point, bool movesA, bool movesB) const {
  const BounceBody<S>&a = bodies[point.bodyA], &b = bodies[point.bodyB];
  const Vector<S> n = point.normal, t = perp(n);
  S moverA[3]{}, moverB[3]{};
  for (int k = 0; k < 3; ++k) {
    const auto mean = [&](const BounceBody<S>& of) {
      return of.mass == S(0) ? of.velocity[k] : (of.before[k] + of.velocity[k]) * ratio<S>(1, 2);
    };
    if (movesA) moverA[k] = mean(a);
    if (movesB) moverB[k] = mean(b);
  }
  const S along = relativeSpeed(n, point.armA, point.armB, moverA, moverB);
  const S aside = relativeSpeed(t, point.tangentArmA, point.tangentArmB, moverA, moverB) + point.surface;
  return toScaled(point.pressed) * toScaled(along) + toScaled(point.rubbed) * toScaled(aside);
}

/// Adds what a point gives back, and what moves bodies through it that contacts leave as they are.
template <Scalar S>
void Restitution<S>::takePoint(const BouncePoint<S>& point) {
  const BounceBody<S>&a = bodies[point.bodyA], &b = bodies[point.bodyB];
  Balance& balance = balances_[groupOf(a.mass == S(0) ? point.bodyB : point.bodyA)];
  const Scaled<S> mass = massOf(point);
  balance.taken -= workThrough(point, a.mass == S(0), b.mass == S(0)) * mass;
  const Vector<S> n = point.normal;
  const S now = relativeSpeed(n, point.armA, point.armB, a.velocity, b.velocity);
  const S change = relativeSpeed(n, point.armA, point.armB, changes_[point.bodyA].velocity,
                                 changes_[point.bodyB].velocity);
  const Scaled<S> rebound = toScaled(point.rebound) * mass;
  balance.linear += rebound * toScaled(now);
  balance.square += rebound * toScaled(change) * toScaled(ratio<S>(1, 2));
  balance.elasticity = max(balance.elasticity, point.elasticity);
}

/// Takes what a point that does not bounce gave others from what was taken of those that do.
template <Scalar S>
void Restitution<S>::takeOther(const BouncePoint<S>& point) {
  const bool a = bounces(point.bodyA), b = bounces(point.bodyB);
  balances_[groupOf(a ? point.bodyA : point.bodyB)].taken -= workThrough(point, !a, !b) * massOf(point);
}

/// The largest part of 1 that gives back no more than it may.
template <Scalar S>
S Restitution<S>::partOf(const Balance& balance) {
  const Scaled<S> e = toScaled(balance.elasticity);
  const Scaled<S> may = sign(balance.taken) > 0 ? balance.taken * e * e : Scaled<S>{};
  if (sign(balance.linear + balance.square - may) <= 0) return S(1);
  if (sign(balance.square) <= 0) return S(0);
  // part^2 + p part = q
  constexpr S kMost = S(1 << 12);
  const Scaled<S> ratioP = balance.linear / balance.square;
  const S p = sign(ratioP) < 0 ? -toScalarWithin(-ratioP, kMost) : toScalarWithin(ratioP, kMost);
  const S q = toScalarWithin(may / balance.square, kMost);
  const S root = sqrt(p * p + S(4) * q);
  const S part = p + root == S(0) ? S(0) : p < S(0) ? (root - p) * ratio<S>(1, 2) : (q + q) / (p + root);
  return clamp(part, S(0), S(1));
}

template <Scalar S>
void Restitution<S>::solve() {
  press();
  for (BouncePoint<S>& point : points) {
    point.rebound = min(heldProduct(point.taken, point.elasticity), kMostChange<S>);
  }
  findGroups();
  changes_.assign(bodies.size(), {});
  balances_.assign(bodies.size(), {});
  for (const BouncePoint<S>& point : points) {
    const auto change = [&](std::uint32_t body, S share, S spin, S u) {
      if (bodies[body].mass == S(0)) return;
      S(&velocity)[3] = changes_[body].velocity;
      const S by[3] = {share * (point.normal.x * u), share * (point.normal.y * u), heldProduct(spin, u)};
      for (int k = 0; k < 3; ++k) velocity[k] = clamp(velocity[k] + by[k], -kMostChange<S>, kMostChange<S>);
    };
    change(point.bodyA, point.shareA, point.spinA, -point.rebound);
    change(point.bodyB, S(1) - point.shareA, point.spinB, point.rebound);
  }
  takeBodies();
  for (const BouncePoint<S>& point : points) takePoint(point);
  for (const BouncePoint<S>& point : others) takeOther(point);
  for (Balance& balance : balances_) balance.part = partOf(balance);
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].mass == S(0)) continue;
    const S part = balances_[groupOf(i)].part;
    for (int k = 0; k < 3; ++k) bodies[i].velocity[k] += changes_[i].velocity[k] * part;
  }
  for (BouncePoint<S>& point : points) {
    const bool fixedA = bodies[point.bodyA].mass == S(0);
    point.rebound = point.rebound * balances_[groupOf(fixedA ? point.bodyB : point.bodyA)].part;
  }
  rub();
}

#define SAMESTEP_EACH_SCALAR template class Restitution<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
