// SPDX-License-Identifier: MIT
#include "world/step.h"

#include <samestep/environment.h>

#include "base/change.h"
#include "base/require_ieee.h"
#include "contacts/stages/contact_callbacks.h"
#include "contacts/stages/list_contacts.h"
#include "dynamics/stages/integrate.h"
#include "joints/stages/tell_joints.h"
#include "world/stage_expectations.h"

namespace samestep {

const char* stageName(Stage stage) {
  switch (stage) {
    case Stage::integratePositions:
      return "integrate positions";
    case Stage::updateShapes:
      return "update shapes";
    case Stage::findPairs:
      return "find pairs";
    case Stage::collide:
      return "collide";
    case Stage::preStep:
      return "pre-step";
    case Stage::integrateVelocities:
      return "integrate velocities";
    case Stage::solve:
      return "solve";
    case Stage::callbacks:
      return "callbacks";
  }
  return "unknown";
}

template <Scalar S>
std::span<const typename Step<S>::Line> Step<S>::lines(SolverKind solver) {
  using C = StepContext<S>;
  static constexpr Line kSequentialImpulses[] = {
      {Stage::integratePositions, [](Step&, C& step) { Integrate<S>::positions(step); }},
      {Stage::updateShapes, placeAndStop},
      {Stage::findPairs, [](Step& stages, C& step) { stages.meet(step); }},
      {Stage::collide, [](Step& of, C& step) { of.updateContacts.run(step, of.findPairs.overlapping()); }},
      {Stage::preStep, [](Step& stages, C& step) { stages.impulses.prepare(step); }},
      {Stage::integrateVelocities, [](Step&, C& step) { Integrate<S>::velocities(step); }},
      {Stage::solve, [](Step& stages, C& step) { stages.impulses.solve(step); }},
      {Stage::callbacks,
       [](Step& stages, C& step) { tellResults(stages, step), stages.islands.fallAsleep(step); }},
  };
  static constexpr Line kSoftStep[] = {
      // It ends with all shapes placed: only those of bodies moved by hand since then were not, and are by
      // now.
      {Stage::updateShapes, [](Step&, C& step) { step.derived.forgetTouched(step.state); }},
      {Stage::findPairs, [](Step& stages, C& step) { stages.meet(step); }},
      {Stage::collide, [](Step& of, C& step) { of.updateContacts.run(step, of.findPairs.overlapping()); }},
      {Stage::preStep, [](Step& stages, C& step) { stages.soft.prepare(step); }},
      {Stage::solve, [](Step& stages, C& step) { stages.soft.solve(step), UpdateContacts<S>::settle(step); }},
      {Stage::integratePositions, [](Step& stages, C& step) { stages.soft.finish(step); }},
      {Stage::updateShapes, placeAndStop},
      {Stage::callbacks,
       [](Step& stages, C& step) { tellResults(stages, step), stages.islands.fallAsleep(step); }},
  };
  if (solver == SolverKind::softStep) return kSoftStep;
  return kSequentialImpulses;
}

template <Scalar S>
void Step<S>::placeAndStop(Step& stages, StepContext<S>& step) {
  stages.placeShapes.run(step);
  stages.stopAtImpacts.run(step);
}

template <Scalar S>
void Step<S>::tellResults(Step& stages, StepContext<S>& step) {
  stages.stopAtImpacts.tellSeen(step);
  ContactCallbacks<S>::postSolve(step);
  TellJoints<S>::run(step);
  step.events.listRange(step.state, step.derived.active);
  ListContacts<S>::finish(step);
}

/// Finds who is near whom, and wakes who sleeps and is touched.
template <Scalar S>
void Step<S>::meet(StepContext<S>& step) {
  findPairs.run(step);
  if (!step.refused) islands.wakeTouched(step, findPairs);
}

template <Scalar S>
void Step<S>::check(const StepContext<S>& step) {
  requireSoundArithmetic<S>();
  require<Fault::ValueOutOfRange>(step.dt > S(0) && step.dt <= kMaxTimeStep<S>, "Space::step: dt is ",
                                  step.dt, " s, allowed are 0, which does nothing, to ", kMaxTimeStep<S>,
                                  " s");
  Integrate<S>::check(step);
}

template <Scalar S>
bool Step<S>::run(StepContext<S>& step) {
  Change change(step.leftMidway);
  step.dtBefore = step.state.timeStep;
  step.state.timeStep = step.dt;
  ++step.state.stamp;
  step.events.begin(step.state);
  step.derived.completePairs(step.state);
  keepBefore(step);
  islands.wakeRoused(step);
  ListContacts<S>::begin(step);
  // Position functions ask about the world before any of them moved a body; the soft step begins with it:
  // nothing but what was moved by hand has to be placed.
  if (step.isSoft() || !step.wiring.positionFuncs.empty()) step.derived.refresh(step.state);
  if (step.events.fast.watched) step.derived.ensure(step.state);
  const KeepPlaced keep(step.derived);
  const bool made = runLines(step);
  change.done();
  return made;
}

template <Scalar S>
bool Step<S>::runLines(StepContext<S>& step) {
  for (const Line& line : lines(step.state.settings.solver)) {
    step.pay(Budget::kPerObject * (std::uint64_t{step.state.bodies.slots()} + step.state.shapes.slots()));
    line.run(*this, step);
    if (step.refused) {
      takeBack(step);
      return false;
    }
    if constexpr (kExpects) StageExpectations<S>::after(line.name, step);
    if (step.wiring.observer != nullptr)
      step.wiring.observer(step.space, line.name, step.wiring.observerData);
  }
  return true;
}

/// Keeps what takeBack needs.
template <Scalar S>
void Step<S>::keepBefore(const StepContext<S>& step) {
  const bool mayEnd = FindPairs<S>::mayFindTooMany(step);
  keptPairs_ = mayEnd && Islands<S>::anyRoused(step);
  keptBodies_ = keptPairs_ || (mayEnd && !step.isSoft());
  if (keptBodies_) bodiesBefore_ = step.state.bodies;
  if (!keptPairs_) return;
  pairsBefore_ = step.state.pairs;
  restingBefore_ = step.state.restingPairs;
}

/// Leaves the world as if a step that found too many pairs had not begun, with all bodies where they were.
template <Scalar S>
void Step<S>::takeBack(StepContext<S>& step) {
  step.state.timeStep = step.dtBefore;
  --step.state.stamp;
  stopAtImpacts.takeBack(step);
  if (keptBodies_) step.state.bodies = bodiesBefore_;
  if (keptPairs_) {
    step.state.pairs = pairsBefore_;
    step.state.restingPairs = restingBefore_;
    step.derived.forget();
  }
  step.derived.touchAll(step.state);
}

#define SAMESTEP_EACH_SCALAR template struct Step<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
