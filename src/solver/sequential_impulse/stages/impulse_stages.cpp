// SPDX-License-Identifier: MIT
#include "solver/sequential_impulse/stages/impulse_stages.h"

#include "base/require_ieee.h"
#include "contacts/stages/resist_rolling.h"
#include "dynamics/body_access.h"

namespace samestep {

namespace {

/// The largest part of an overlap that goes per second.
template <Scalar S>
inline constexpr S kMaxBiasRate = S(1 << 14);
/// The largest factor by which a longer step enlarges the impulses kept from the last one.
template <Scalar S>
inline constexpr S kMaxStepRatio = S(1 << 10);

template <Scalar S>
S stepRatio(S dt, S before) {
  return dt >= before * kMaxStepRatio<S> ? kMaxStepRatio<S> : dt / before;
}

}  // namespace

template <Scalar S>
std::uint32_t ImpulseStages<S>::solverIndexOf(std::uint32_t body) {
  std::uint32_t& index = solverIndex_[body];
  if (index == kNone) {
    index = static_cast<std::uint32_t>(bodies_.size());
    bodies_.push_back(body);
  }
  return index;
}

template <Scalar S>
void ImpulseStages<S>::prepare(StepContext<S>& step) {
  const auto& bodies = step.state.bodies;
  const auto& shapes = step.state.shapes;
  const S bias = step.state.settings.collisionBias, slop = step.state.settings.collisionSlop;
  const S remaining = S(1) - pow(bias, step.dt);
  const S biasRate = remaining > step.dt * kMaxBiasRate<S> ? kMaxBiasRate<S> : remaining / step.dt;
  solver_.rows.clear();
  solver_.bodies.clear();
  bodies_.clear();
  solverIndex_.assign(bodies.slots(), kNone);
  std::uint32_t prepared = 0;
  for (const Pair<S>& pair : step.state.pairs) {
    if (pair.solved == 0) continue;
    if (++prepared % Budget::kPairsAtOnce == 0) step.pay(Budget::kPerPair * Budget::kPairsAtOnce);
    if (step.derived.traits[pair.a.index].resists || step.derived.traits[pair.b.index].resists) [[unlikely]]
      ResistRolling<S>::act(step, pair);
    const std::uint32_t a = shapes.valueAt(pair.a.index).body().index;
    const std::uint32_t b = shapes.valueAt(pair.b.index).body().index;
    const std::uint32_t solverA = solverIndexOf(a);
    const std::uint32_t solverB = solverIndexOf(b);
    solver_.preStep(pair, solverA, solverB, bodies.valueAt(a), bodies.valueAt(b), slop, biasRate);
  }
  prepareJoints(step);
  blows_.watch(step, bodies_, solver_);
}

template <Scalar S>
void ImpulseStages<S>::prepareJoints(const StepContext<S>& step) {
  const S perStep = reciprocal(max(step.dt, ratio<S>(1, 1 << 14)));
  joints_.begin({&step.state.bodies, &step.state.joints}, {step.dt, perStep, 1});
  if (joints_.empty()) return;
  buildJoints(step);
  for (JointBody<S>& body : joints_.bodies) body.solver = solverIndexOf(body.slot);
}

/// Makes the rows, with the impulses of the last step, scaled as the steps are long.
template <Scalar S>
void ImpulseStages<S>::buildJoints(const StepContext<S>& step) {
  if (joints_.empty()) return;
  joints_.restart(step.dtBefore == S(0) ? S(0) : stepRatio(step.dt, step.dtBefore));
  joints_.build();
}

/// Shows the joints how fast their bodies are.
template <Scalar S>
void ImpulseStages<S>::showBodies() {
  for (JointBody<S>& body : joints_.bodies) {
    const ImpulseBody<S>& from = solver_.bodies[body.solver];
    body.velocity = from.velocity;
    body.spin = from.angularVelocity;
  }
}

/// Takes over what they changed.
template <Scalar S>
void ImpulseStages<S>::returnBodies() {
  for (const JointBody<S>& body : joints_.bodies) {
    solver_.bodies[body.solver].velocity = body.velocity;
    solver_.bodies[body.solver].angularVelocity = body.spin;
  }
}

template <Scalar S>
void ImpulseStages<S>::startJoints() {
  if (joints_.empty()) return;
  showBodies();
  joints_.warmStart();
  returnBodies();
}

template <Scalar S>
void ImpulseStages<S>::iterateJoints() {
  showBodies();
  joints_.solve(true, false);
  returnBodies();
}

template <Scalar S>
void ImpulseStages<S>::solve(StepContext<S>& step) {
  takeBodies(step);
  if (blows_.isWatched()) blows_.begin(step, solver_);
  warmStart(step);
  startJoints();
  pass(step);
  if (blows_.isWatched() && blows_.strike(step, solver_)) {
    warmStart(step);
    buildJoints(step);
    startJoints();
    blows_.keep(solver_);
    pass(step);
    if (blows_.takeBack(step, solver_)) {
      buildJoints(step);
      pass(step);
    }
  }
  storeImpulses(step);
  storeVelocities(step);
  if (joints_.empty()) return;
  joints_.keep();
  joints_.addTotals();
  joints_.store(step.state.joints);
}

template <Scalar S>
void ImpulseStages<S>::pass(StepContext<S>& step) {
  for (int i = 0; i < step.state.settings.iterations; ++i) {
    if (!joints_.empty()) iterateJoints();
    solver_.iterate();
    step.pay(Budget::kPerPairAndPass * (solver_.rows.size() + joints_.size()));
  }
}

template <Scalar S>
void ImpulseStages<S>::takeBodies(const StepContext<S>& step) {
  for (const std::uint32_t index : bodies_) {
    const Body<S>& body = step.state.bodies.valueAt(index);
    solver_.bodies.push_back(
        {body.velocity(), body.angularVelocity(), body.velocityBias(), body.angularVelocityBias()});
  }
}

/// Applies the impulses of the last step, scaled as the steps are long.
template <Scalar S>
void ImpulseStages<S>::warmStart(const StepContext<S>& step) {
  const S coefficient = step.dtBefore == S(0) ? S(0) : stepRatio(step.dt, step.dtBefore);
  std::size_t next = 0;
  for (const Pair<S>& pair : step.state.pairs) {
    if (pair.solved == 0) continue;
    for (int i = 0; i < pair.count; ++i, ++next) {
      if (pair.state != ArbiterState::firstCollision) solver_.warmStart(solver_.rows[next], coefficient);
    }
  }
}

template <Scalar S>
void ImpulseStages<S>::storeImpulses(StepContext<S>& step) {
  std::size_t next = 0;
  for (Pair<S>& pair : step.state.pairs) {
    if (pair.solved == 0) continue;
    for (int i = 0; i < pair.count; ++i, ++next) {
      const ImpulseRow<S>& row = solver_.rows[next];
      Contact<S>& contact = pair.contacts[i];
      contact.normalSpeed = row.normalSum * row.normalScale;
      contact.tangentSpeed = row.tangentSum * row.tangentScale;
      contact.normalTotal = (row.normalSum - row.normalLacks) * row.normalScale + row.struckNormal;
      contact.tangentTotal = (row.tangentSum - row.tangentLacks) * row.tangentScale + row.struckTangent;
      pair.solvedNormal = row.normal;
      pair.solvedImpulse += rotate(row.normal, Vector<S>(contact.normalTotal, contact.tangentTotal));
    }
    pair.solvedTurn =
        step.state.bodies.valueAt(step.state.shapes.valueAt(pair.b.index).body().index).rotation();
  }
}

template <Scalar S>
void ImpulseStages<S>::storeVelocities(StepContext<S>& step) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const std::uint32_t index = bodies_[i];
    Body<S>& body = step.state.bodies.valueAt(index);
    if (!body.isDynamic()) continue;
    const ImpulseBody<S>& solved = solver_.bodies[i];
    step.events.held[index] |= BodyAccess<S>::holdVelocity(body, {solved.velocity, solved.angularVelocity});
    BodyAccess<S>::setBias(body, heldWithin(solved.biasVelocity, kMaxSpeed<S>),
                           clamp(solved.biasAngularVelocity, -kMaxAngularSpeed<S>, kMaxAngularSpeed<S>));
  }
}

#define SAMESTEP_EACH_SCALAR template class ImpulseStages<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
