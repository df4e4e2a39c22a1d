// SPDX-License-Identifier: MIT
#include "solver/sequential_impulse/stages/impulse_blows.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "base/require_ieee.h"
#include "dynamics/body_access.h"

namespace samestep {

namespace {

/// Approaches faster than this are blows, m/s: what rests on others comes nearer by less.
template <Scalar S>
inline constexpr S kBlow = ratio<S>(1, 64);

/// Energy may grow by this factor, for passes end near what they seek.
template <Scalar S>
inline constexpr S kMore = S(1) + S(0x1p-14);

template <Scalar S>
bool strikes(const ImpulseRow<S>& row) {
  return row.bounce < -kBlow<S>;
}

/// A row as a point of a blow.
template <Scalar S>
BouncePoint<S> pointOf(const ImpulseRow<S>& row) {
  BouncePoint<S> point;
  const S whole = row.speedA + row.speedB, tangentWhole = row.tangentSpeedA + row.tangentSpeedB;
  point.bodyA = row.bodyA;
  point.bodyB = row.bodyB;
  point.normal = row.normal;
  point.shareA = row.speedA / whole;
  point.armA = row.normalArmA;
  point.armB = row.normalArmB;
  point.tangentArmA = row.tangentArmA;
  point.tangentArmB = row.tangentArmB;
  point.spinA = row.spinA / whole;
  point.spinB = row.spinB / whole;
  point.tangentSpinA = row.tangentSpinA / tangentWhole;
  point.tangentSpinB = row.tangentSpinB / tangentWhole;
  point.surface = row.surface;
  return point;
}

}  // namespace

template <Scalar S>
void ImpulseBlows<S>::watch(const StepContext<S>& step, const std::vector<std::uint32_t>& slots,
                            const ImpulseSolver<S>& solver) {
  slots_ = &slots;
  watched_ = std::any_of(solver.rows.begin(), solver.rows.end(), strikes<S>);
  if (!watched_) return;
  before_.clear();
  for (const std::uint32_t slot : slots) {
    const Body<S>& body = step.state.bodies.valueAt(slot);
    before_.push_back({{body.velocity().x, body.velocity().y, body.angularVelocity()}});
  }
}

template <Scalar S>
void ImpulseBlows<S>::begin(const StepContext<S>& step, const ImpulseSolver<S>& solver) {
  begin_ = solver;
  find(step, solver);
  sumEnergies(step, solver);
  allowed_.assign(slots_->size(), {});
  for (std::uint32_t i = 0; i < slots_->size(); ++i) addEnergy(step, i, before_[i].velocity, allowed_);
  for (std::size_t i = 0; i < energies_.size(); ++i) allowed_[i] = max(allowed_[i], energies_[i]);
}

template <Scalar S>
bool ImpulseBlows<S>::grew(std::uint32_t group) const {
  return struck_[group] != 0 && sign(energies_[group] - allowed_[group] * toScaled(kMore<S>)) > 0;
}

template <Scalar S>
bool ImpulseBlows<S>::strike(StepContext<S>& step, ImpulseSolver<S>& solver) {
  sumEnergies(step, solver);
  bool any = false;
  for (std::uint32_t i = 0; i < slots_->size(); ++i) {
    struck_[i] = grew(i) ? 1 : 0;
    any = any || struck_[i] != 0;
  }
  if (!any) return false;
  solver = begin_;
  take(step, solver);
  restitution_.markBouncing();
  restitution_.solve();
  give(solver);
  const std::size_t points = restitution_.points.size();
  step.pay(Budget::kPerPairAndPass * Restitution<S>::passes(points) * points);
  return true;
}

/// True if a contact gives energy without any blow: by a belt, or by a body that moves whatever touches it.
template <Scalar S>
bool ImpulseBlows<S>::isDriven(const StepContext<S>& step, const ImpulseRow<S>& row) const {
  const auto moves = [&](std::uint32_t body) {
    const Body<S>& of = step.state.bodies.valueAt((*slots_)[body]);
    return !of.isDynamic() && (of.velocity() != Vector<S>() || of.angularVelocity() != S(0));
  };
  return row.surface != S(0) || moves(row.bodyA) || moves(row.bodyB);
}

/// Puts bodies together that contacts connect, and marks the groups in which an elastic contact is struck.
template <Scalar S>
void ImpulseBlows<S>::find(const StepContext<S>& step, const ImpulseSolver<S>& solver) {
  group_.resize(slots_->size());
  std::iota(group_.begin(), group_.end(), 0u);
  const auto moves = [&](std::uint32_t body) {
    return step.state.bodies.valueAt((*slots_)[body]).isDynamic();
  };
  for (const ImpulseRow<S>& row : solver.rows) {
    if (!moves(row.bodyA) || !moves(row.bodyB)) continue;
    const std::uint32_t a = groupOf(row.bodyA), b = groupOf(row.bodyB);
    group_[max(a, b)] = min(a, b);
  }
  struck_.assign(slots_->size(), 0);
  for (const ImpulseRow<S>& row : solver.rows) {
    if (strikes(row)) struck_[groupOf(row)] = 1;
  }
  for (const ImpulseRow<S>& row : solver.rows) {
    if (isDriven(step, row)) struck_[groupOf(row)] = 0;
  }
}

template <Scalar S>
std::uint32_t ImpulseBlows<S>::groupOf(std::uint32_t body) {
  while (group_[body] != body) body = group_[body] = group_[group_[body]];
  return body;
}

template <Scalar S>
std::uint32_t ImpulseBlows<S>::groupOf(const ImpulseRow<S>& row) {
  return groupOf(row.speedA != S(0) ? row.bodyA : row.bodyB);
}

/// Takes the bodies, and the contacts of the groups that are struck.
template <Scalar S>
void ImpulseBlows<S>::take(const StepContext<S>& step, const ImpulseSolver<S>& solver) {
  restitution_.clear(slots_->size());
  for (std::size_t i = 0; i < slots_->size(); ++i) {
    const Body<S>& from = step.state.bodies.valueAt((*slots_)[i]);
    BounceBody<S>& body = restitution_.bodies[i];
    std::copy(std::begin(before_[i].velocity), std::end(before_[i].velocity), std::begin(body.velocity));
    std::copy(std::begin(body.velocity), std::end(body.velocity), std::begin(body.before));
    if (!from.isDynamic()) continue;
    body.mass = from.mass();
    body.momentPerMass = from.momentPerMass();
  }
  std::uint32_t next = 0;
  for (const Pair<S>& pair : step.state.pairs) {
    if (pair.solved == 0) continue;
    const std::uint32_t first = next;
    for (int i = 0; i < pair.count; ++i, ++next) {
      if (struck_[groupOf(solver.rows[next])] == 0) continue;
      BouncePoint<S>& point = restitution_.points.emplace_back(pointOf(solver.rows[next]));
      point.friction = pair.friction;
      point.elasticity = pair.elasticity;
      point.pair = first;
      point.block = next;
    }
  }
}

/// Gives contacts and bodies what the blow made of them.
template <Scalar S>
void ImpulseBlows<S>::give(ImpulseSolver<S>& solver) {
  for (const BouncePoint<S>& point : restitution_.points) {
    ImpulseRow<S>& row = solver.rows[point.block];
    const S(&a)[3] = restitution_.bodies[point.bodyA].velocity;
    const S(&b)[3] = restitution_.bodies[point.bodyB].velocity;
    const S apart = normalSpeed(row, Vector<S>(b[0] - a[0], b[1] - a[1]), a[2], b[2]);
    row.bounce = point.rebound == S(0) ? S(0) : -max(apart, S(0));
    const S pressed = mulDiv(point.pressed + point.rebound, row.normalScale, row.speedA + row.speedB);
    row.struckNormal = min(pressed, kMaxSum<S>);
    const S rubbed = mulDiv(point.rubbed, row.tangentScale, row.tangentSpeedA + row.tangentSpeedB);
    row.struckTangent = clamp(rubbed, -kMaxSum<S>, kMaxSum<S>);
  }
  for (std::uint32_t i = 0; i < slots_->size(); ++i) {
    if (!restitution_.bounces(i)) continue;
    const S(&from)[3] = before_[i].velocity;
    const S(&to)[3] = restitution_.bodies[i].velocity;
    ImpulseBody<S>& body = solver.bodies[i];
    body.velocity = heldWithin(body.velocity + Vector<S>(to[0] - from[0], to[1] - from[1]), kMaxSpeed<S>);
    body.angularVelocity =
        clamp(body.angularVelocity + (to[2] - from[2]), -kMaxAngularSpeed<S>, kMaxAngularSpeed<S>);
  }
}

template <Scalar S>
void ImpulseBlows<S>::addEnergy(const StepContext<S>& step, std::uint32_t body, const S (&velocity)[3],
                                std::vector<Scaled<S>>& energies) {
  const Body<S>& from = step.state.bodies.valueAt((*slots_)[body]);
  if (!from.isDynamic()) return;
  const auto square = [](S x) { return toScaled(x) * toScaled(x); };
  Scaled<S> sum = square(velocity[0]) + square(velocity[1]);
  if (from.momentPerMass() != S(0)) sum += square(velocity[2]) / toScaled(from.momentPerMass());
  energies[groupOf(body)] += sum * toScaled(from.mass());
}

template <Scalar S>
void ImpulseBlows<S>::sumEnergies(const StepContext<S>& step, const ImpulseSolver<S>& solver) {
  energies_.assign(slots_->size(), {});
  for (std::uint32_t i = 0; i < slots_->size(); ++i) {
    const ImpulseBody<S>& body = solver.bodies[i];
    addEnergy(step, i, {body.velocity.x, body.velocity.y, body.angularVelocity}, energies_);
  }
}

template <Scalar S>
bool ImpulseBlows<S>::takeBack(const StepContext<S>& step, ImpulseSolver<S>& solver) {
  sumEnergies(step, solver);
  bool any = false;
  for (std::uint32_t i = 0; i < slots_->size(); ++i) any = any || grew(i);
  if (!any) return false;
  solver = begin_;
  for (const BouncePoint<S>& point : restitution_.points) {
    ImpulseRow<S>& row = solver.rows[point.block];
    if (grew(groupOf(row))) row.bounce = S(0);
  }
  return true;
}

#define SAMESTEP_EACH_SCALAR template class ImpulseBlows<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
