// SPDX-License-Identifier: MIT
#include "solver/joints/joint_solver.h"

#include <samestep/high_water.h>

#include "base/require_ieee.h"
#include "joints/joint_limits.h"
#include "solver/joints/joint_rows.h"
#include "solver/kernels/softness.h"

namespace samestep {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

/// The mass of the lighter body that moves, kg.
template <Scalar S>
Scaled<S> lighterMass(const Body<S>& a, const Body<S>& b) {
  return toScaled((a.inverseMass() > b.inverseMass() ? a : b).mass());
}

/// The larger of the inverse moments, 1/(kg m^2).
template <Scalar S>
Scaled<S> largerInverse(const Body<S>& a, const Body<S>& b) {
  return a.inverseMoment() > b.inverseMoment() ? a.inverseMoment() : b.inverseMoment();
}

/// A force or torque over a substep, as an impulse that joints keep; 0 stays 0, and only that.
template <Scalar S>
S keptOf(S pull, const Scaled<S>& perImpulse, S substep) {
  if (pull == S(0)) return S(0);
  const S kept = toScalarWithin(toScaled(pull) * toScaled(substep) * perImpulse, kMostKept<S>);
  return max(kept, ratio<S>(1, 1 << 30));
}

template <Scalar S>
Softness<S> springOf(S hertz, S damping, const JointTiming<S>& timing) {
  return hertz == S(0) ? Softness<S>{S(0), S(1), S(0)} : makeSoftness(hertz, damping, timing.substep);
}

/// True of a joint that holds something with any force.
template <Scalar S>
bool isHard(const Joint<S>& joint) {
  if (joint.maxForce != S(0) || joint.maxTorque != S(0)) return false;
  const bool isBare = joint.spring == 0 && joint.limited == 0 && joint.motor == 0;
  switch (joint.kind) {
    case JointKind::revolute:
    case JointKind::prismatic:
    case JointKind::wheel:
      return true;
    case JointKind::weld:
      return joint.hertz == S(0) || joint.angularHertz == S(0);
    case JointKind::distance:
    case JointKind::gear:
      return isBare;
    default:
      return false;
  }
}

/// The kept impulse of a row that is no point.
template <Scalar S>
S& keptIn(JointImpulses<S>& kept, std::uint8_t slot) {
  switch (slot) {
    case kKeptAlong:
      return kept.linear.x;
    case kKeptAcross:
      return kept.linear.y;
    case kKeptSpring:
      return kept.spring;
    case kKeptMotor:
      return kept.motor;
    case kKeptLower:
      return kept.lower;
    case kKeptUpper:
      return kept.upper;
    default:
      return kept.angular;
  }
}

template <Scalar S>
void scale(JointImpulses<S>& kept, S factor) {
  kept.linear = heldWithin(kept.linear * factor, kMostKept<S>);
  for (S* one : {&kept.angular, &kept.spring, &kept.motor, &kept.lower, &kept.upper}) {
    *one = clamp(*one * factor, -kMostKept<S>, kMostKept<S>);
  }
}

/// Holds a point with no more than a force in any direction.
template <Scalar S>
void holdWithin(JointRow<S>& x, JointRow<S>& y, S most, JointBody<S>& a, JointBody<S>& b) {
  const S size = length(x.sum * x.scale, y.sum * y.scale);
  if (size <= most) return;
  for (JointRow<S>* row : {&x, &y}) {
    const S before = row->sum;
    row->sum = mulDiv(before, most, size);
    answer(*row, row->sum - before, a.velocity, a.spin, b.velocity, b.spin);
  }
}

}  // namespace

template <Scalar S>
std::uint32_t JointSolver<S>::indexOf(std::uint32_t slot) {
  std::uint32_t& index = index_[slot];
  if (index != kNone) return index;
  index = static_cast<std::uint32_t>(bodies.size());
  const Body<S>& from = world_.bodies->valueAt(slot);
  JointBody<S>& body = bodies.emplace_back();
  body.center = from.worldCenter();
  body.centerOfMass = from.centerOfMass();
  body.rotation = body.turn = from.rotation();
  body.angle = from.angle();
  body.slot = slot;
  return index;
}

template <Scalar S>
void JointSolver<S>::begin(const JointedWorld<S>& world, const JointTiming<S>& timing) {
  joints_.clear();
  bodies.clear();
  rows_.clear();
  trees_.clear();
  world_ = world;
  timing_ = timing;
  if (world.joints->empty()) return;
  index_.assign(world.bodies->slots(), kNone);
  for (std::uint32_t slot = 0; slot < world.joints->slots(); ++slot) {
    if (world.joints->aliveAt(slot)) takeJoint(slot);
  }
  trees_.begin(*world.bodies, joints_, bodies);
}

template <Scalar S>
void JointSolver<S>::takeJoint(std::uint32_t slot) {
  const Joint<S>& joint = world_.joints->valueAt(slot);
  const Body<S>& a = world_.bodies->valueAt(joint.bodyA.index);
  const Body<S>& b = world_.bodies->valueAt(joint.bodyB.index);
  if (a.inverseMass() == Scaled<S>{} && b.inverseMass() == Scaled<S>{}) return;
  if (a.isSleeping() || b.isSleeping()) return;
  JointWork<S> work;
  work.joint = slot;
  work.a = indexOf(joint.bodyA.index);
  work.b = indexOf(joint.bodyB.index);
  work.response = respond(a, b);
  work.fixedA = a.inverseMass() == Scaled<S>{};
  work.fixedB = b.inverseMass() == Scaled<S>{};
  const Scaled<S> most = largerInverse(a, b);
  if (most > Scaled<S>{}) {
    const Scaled<S> by = toScaled(joint.kind == JointKind::gear ? joint.ratio : S(1));
    const Scaled<S> k = a.inverseMoment() + by * by * b.inverseMoment();
    work.turnA = toScalar<S>(a.inverseMoment() / k);
    work.turnB = toScalar<S>(by * b.inverseMoment() / k);
    work.turnScale = toScalar<S>(most / k);
    work.turnPerKept = max(toScalar<S>(k / most), ratio<S>(1, 1 << 30));
  }
  const Scaled<S> perForce = reciprocal(lighterMass(a, b));
  work.motorMost = keptOf(joint.motorMax, motorTurns(joint) ? most : perForce, timing_.substep);
  work.forceMost = keptOf(joint.maxForce, perForce, timing_.substep);
  work.torqueMost = keptOf(joint.maxTorque, most, timing_.substep);
  work.spring = springOf(joint.hertz, joint.damping, timing_);
  work.angularSpring = springOf(joint.angularHertz, joint.angularDamping, timing_);
  const bool isPoint =
      joint.kind == JointKind::revolute || joint.kind == JointKind::weld || joint.kind == JointKind::target;
  work.holdsPoint = isPoint && work.forceMost > S(0);
  work.perForce = perForce;
  work.perTorque = most;
  work.isHard = isHard(joint);
  joints_.push_back(work);
}

template <Scalar S>
void JointSolver<S>::restart(S factor) {
  for (JointWork<S>& joint : joints_) {
    joint.kept = world_.joints->valueAt(joint.joint).kept;
    if (factor != S(1)) scale(joint.kept, factor);
    joint.total = {};
    joint.totalTurn = S(0);
  }
  for (JointBody<S>& body : bodies) {
    body.given = body.moved = {};
    body.spinGiven = body.turned = S(0);
    body.turn = body.rotation;
  }
}

template <Scalar S>
void JointSolver<S>::build() {
  rows_.clear();
  for (JointWork<S>& joint : joints_) {
    joint.begin = static_cast<std::uint32_t>(rows_.size());
    appendRows(world_.joints->valueAt(joint.joint), joint, bodies[joint.a], bodies[joint.b], timing_, rows_);
    joint.end = static_cast<std::uint32_t>(rows_.size());
  }
  if (!trees_.empty()) trees_.build(joints_, rows_);
}

template <Scalar S>
void JointSolver<S>::warmStart() {
  for (const JointWork<S>& joint : joints_) {
    JointBody<S>&a = bodies[joint.a], &b = bodies[joint.b];
    for (std::uint32_t i = joint.begin; i < joint.end; ++i) {
      answer(rows_[i], rows_[i].sum, a.velocity, a.spin, b.velocity, b.spin);
    }
  }
}

template <Scalar S>
void JointSolver<S>::solveJoint(JointWork<S>& joint, bool corrects) {
  JointBody<S>&a = bodies[joint.a], &b = bodies[joint.b];
  for (std::uint32_t i = joint.begin; i < joint.end; ++i) {
    if (joint.inTree && rows_[i].corrects != 0 && rows_[i].low != S(0)) continue;
    solveRow(rows_[i], corrects, a.velocity, a.spin, b.velocity, b.spin);
    highWater<S>("joint: impulse u", rows_[i].sum);
  }
  if (joint.holdsPoint && joint.end - joint.begin >= 2) {
    holdWithin(rows_[joint.end - 2], rows_[joint.end - 1], joint.forceMost, a, b);
  }
}

template <Scalar S>
void JointSolver<S>::solve(bool corrects, bool backward) {
  if (backward) {
    for (std::size_t i = joints_.size(); i-- > 0;) solveJoint(joints_[i], corrects);
  } else {
    for (JointWork<S>& joint : joints_) solveJoint(joint, corrects);
  }
  if (!trees_.empty()) trees_.solve(joints_, rows_, bodies, corrects);
}

template <Scalar S>
void JointSolver<S>::keep() {
  for (JointWork<S>& joint : joints_) {
    joint.kept = {};
    for (std::uint32_t i = joint.begin; i < joint.end; ++i) {
      const JointRow<S>& row = rows_[i];
      const S kept = clamp(row.sum * row.scale, -kMostKept<S>, kMostKept<S>);
      if (row.slot == kKeptPoint) {
        joint.kept.linear = heldWithin(joint.kept.linear + row.n * kept, kMostKept<S>);
      } else {
        keptIn(joint.kept, row.slot) = kept;
      }
    }
  }
}

template <Scalar S>
void JointSolver<S>::addTotals() {
  for (JointWork<S>& joint : joints_) {
    for (std::uint32_t i = joint.begin; i < joint.end; ++i) {
      const JointRow<S>& row = rows_[i];
      const S kept = row.sum * row.scale;
      if (row.n == Vector<S>()) {
        joint.totalTurn =
            clamp(joint.totalTurn + (row.armA < S(0) ? -kept : kept), S(-(1 << 27)), S(1 << 27));
      } else {
        joint.total = heldWithin(joint.total + row.n * kept, S(1 << 27));
      }
    }
  }
}

template <Scalar S>
void JointSolver<S>::store(SlotMap<Joint<S>, JointId>& joints) const {
  const Scaled<S> perSecond = reciprocal(toScaled(timing_.substep * S(timing_.substeps)));
  for (const JointWork<S>& work : joints_) {
    Joint<S>& joint = joints.valueAt(work.joint);
    const Body<S>& a = world_.bodies->valueAt(joint.bodyA.index);
    const Body<S>& b = world_.bodies->valueAt(joint.bodyB.index);
    const bool lower = joint.kept.lower == S(0) && work.kept.lower != S(0);
    const bool upper = joint.kept.upper == S(0) && work.kept.upper != S(0);
    joint.reached = static_cast<std::uint8_t>((lower ? Joint<S>::kReachedLower : 0) |
                                              (upper ? Joint<S>::kReachedUpper : 0));
    joint.kept = work.kept;
    const Scaled<S> perKept = lighterMass(a, b) * perSecond, most = largerInverse(a, b);
    joint.force = {toScalarWithin(toScaled(work.total.x) * perKept, kMaxForce<S>),
                   toScalarWithin(toScaled(work.total.y) * perKept, kMaxForce<S>)};
    joint.torque = most == Scaled<S>{}
                       ? S(0)
                       : toScalarWithin(toScaled(work.totalTurn) * perSecond / most, kMaxForce<S>);
    if (joint.kind == JointKind::ratchet) {
      const S angle = jointAngle(joint, a.angle(), b.angle());
      joint.latch = max(joint.latch, ratchetTooth(joint, angle));
    }
  }
}

#define SAMESTEP_EACH_SCALAR template class JointSolver<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
