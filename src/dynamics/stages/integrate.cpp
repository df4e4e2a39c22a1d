// SPDX-License-Identifier: MIT
#include "dynamics/stages/integrate.h"

#include "base/require_ieee.h"
#include "dynamics/body_access.h"

namespace samestep {

template <Scalar S>
void Integrate<S>::check(const StepContext<S>& step) {
  const auto& bodies = step.state.bodies;
  const auto checkOne = [&](const Body<S>& body) {
    const char* reason = BodyAccess<S>::cannotStep(body);
    require<Fault::IllegalBody>(reason == nullptr, "Space::step: body ", body.id(), ": its ", reason);
    if (body.positionFunc() != 0 || body.velocityFunc() != 0) [[unlikely]]
      step.wiring.requireCallbacks(body);
  };
  // All was well with those that nobody has changed since they fell asleep.
  if (step.derived.cached && step.derived.activeKnown) {
    for (const std::uint32_t i : step.derived.active) checkOne(bodies.valueAt(i));
    for (const std::uint32_t i : step.derived.touched) {
      if (bodies.aliveAt(i)) checkOne(bodies.valueAt(i));
    }
  } else {
    bodies.each([&](BodyId, const Body<S>& body) { checkOne(body); });
  }
}

template <Scalar S>
void Integrate<S>::callPositionFunc(StepContext<S>& step, std::uint32_t index) {
  Body<S>& body = step.state.bodies.valueAt(index);
  const auto* entry = SpaceWiring<S>::find(step.wiring.positionFuncs, body.positionFunc());
  {
    const typename BodyAccess<S>::WithinStep within(body, step.events.held[index]);
    entry->function(body, step.dt, entry->data);
  }
  step.events.held[index] |= BodyAccess<S>::holdPosition(body, S(0), step.state.settings.worldExtent);
}

template <Scalar S>
void Integrate<S>::callVelocityFunc(StepContext<S>& step, std::uint32_t index, S kept) {
  Body<S>& body = step.state.bodies.valueAt(index);
  const auto* entry = SpaceWiring<S>::find(step.wiring.velocityFuncs, body.velocityFunc());
  {
    const typename BodyAccess<S>::WithinStep within(body, step.events.held[index]);
    entry->function(body, step.state.settings.gravity, kept, step.dt, entry->data);
  }
  step.derived.touch(index);
}

template <Scalar S>
void Integrate<S>::noteGoesFar(StepContext<S>& step, std::uint32_t index, const Body<S>& body) {
  FastBodies<S>& fast = step.events.fast;
  const auto& start = fast.starts[index];
  const S half = ratio<S>(1, 2);
  const bool jumped = body.positionFunc() != 0 &&
                      (!within(body.worldCenter() - start.center, kMaxSpeed<S>) ||
                       !within(body.angle() * half - start.angle * half, kMaxAngularSpeed<S> * half));
  if (jumped) {
    fast.noteStart(index, body);
  } else {
    fast.motions[index] = FastBodies<S>::kGoesFar;
  }
}

template <Scalar S>
void Integrate<S>::positions(StepContext<S>& step) {
  auto& bodies = step.state.bodies;
  for (const std::uint32_t i : step.derived.active) {
    Body<S>& body = bodies.valueAt(i);
    if (step.events.fast.watched) step.events.fast.noteStart(i, body);
    if (body.positionFunc() != 0) [[unlikely]] {
      callPositionFunc(step, i);
    } else {
      step.events.held[i] |= BodyAccess<S>::holdPosition(body, step.dt, step.state.settings.worldExtent);
    }
    if (step.events.fast.watched) noteFast(step, i, body);
  }
}

template <Scalar S>
void Integrate<S>::velocities(StepContext<S>& step) {
  const S damping = step.state.settings.damping;
  const S kept = damping == S(1) ? S(1) : pow(damping, step.dt);
  const Vector<S> pull = step.state.settings.gravity;
  auto& bodies = step.state.bodies;
  for (const std::uint32_t i : step.derived.active) {
    Body<S>& body = bodies.valueAt(i);
    if (body.velocityFunc() != 0) [[unlikely]] {
      callVelocityFunc(step, i, kept);
    } else if (body.isDynamic()) {
      step.events.held[i] |=
          BodyAccess<S>::holdVelocity(body, BodyAccess<S>::accelerated(body, pull, kept, step.dt));
    }
    BodyAccess<S>::clearForces(body);
  }
}

#define SAMESTEP_EACH_SCALAR template struct Integrate<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
