// SPDX-License-Identifier: MIT
// What a Space is connected to: functions, handlers, workers, kernels. Included by space.cpp alone, which
// instantiates Space.
#pragma once

#include <samestep/make_room.h>
#include <samestep/space.h>

#include <algorithm>

#include "base/change.h"
#include "contacts/stages/contact_callbacks.h"
#include "islands/rouse.h"
#include "world/space_parts.h"

namespace samestep {

namespace {

void requireFunction(CallbackNumber number, bool given, const char* asked) {
  require<Fault::ValueOutOfRange>(number != 0 && given, asked, number,
                                  given ? ", allowed are 1 and above" : " comes with a null function");
}

}  // namespace

// Locking and callbacks.

template <Scalar S>
void Space<S>::unlock(bool runPostStep) {
  require<Fault::SpaceLockUnderflow>(locked_ > 0);
  --locked_;
  if (!runPostStep || locked_ > 0 || parts_->postStep.running()) return;
  parts_->postStep.run(*this);
}

template <Scalar S>
bool Space<S>::addPostStepCallback(PostStepFunc function, std::uint64_t key, void* data) {
  require<Fault::ValueOutOfRange>(function != nullptr, "Space::addPostStepCallback: key ", key,
                                  " comes with a null function");
  if (!parts_->postStep.add(function, key, data)) return false;
  if (locked_ == 0 && !parts_->postStep.running()) {
    lock();
    unlock(true);
  }
  return true;
}

template <Scalar S>
void Space<S>::registerHandler(CallbackNumber number, const CollisionHandler<S>& handler) {
  require<Fault::SpaceLocked>(locked_ == 0);
  require<Fault::ValueOutOfRange>(number != 0,
                                  "Space::registerHandler: number is 0, allowed are 1 and above");
  SpaceWiring<S>& wiring = parts_->wiring;
  SpaceWiring<S>::set(wiring.handlers, typename SpaceWiring<S>::RegisteredHandler{number, handler});
  wiring.bound.take(state_.handlers, wiring.handlers);
}

template <Scalar S>
void Space<S>::registerPositionFunc(CallbackNumber number, PositionFunc function, void* data) {
  require<Fault::SpaceLocked>(locked_ == 0);
  requireFunction(number, function != nullptr, "Space::registerPositionFunc: number ");
  SpaceWiring<S>::set(parts_->wiring.positionFuncs, {number, function, data});
}

template <Scalar S>
void Space<S>::registerVelocityFunc(CallbackNumber number, VelocityFunc function, void* data) {
  require<Fault::SpaceLocked>(locked_ == 0);
  requireFunction(number, function != nullptr, "Space::registerVelocityFunc: number ");
  SpaceWiring<S>::set(parts_->wiring.velocityFuncs, {number, function, data});
}

namespace {

/// Puts a binding in its place, or in that of one for the same collisions.
template <Scalar S>
void bind(StepContext<S> world, const HandlerBinding& binding, const char* asked) {
  require<Fault::MissingCallback>(world.wiring.has(binding.number), asked,
                                  ": no handler is registered under ", binding.number,
                                  "; see Space::registerHandler");
  auto& all = world.state.handlers;
  makeRoom(all, all.size() + 1);
  world.wiring.bound.reserve(all.size() + 1);
  const auto place = std::lower_bound(all.begin(), all.end(), binding, HandlerBinding::before);
  if (place != all.end() && !HandlerBinding::before(binding, *place)) {
    *place = binding;
  } else {
    all.insert(place, binding);
  }
  world.wiring.bound.take(all, world.wiring.handlers);
  if (world.state.settings.sleepTimeThreshold == S(0)) return;
  // It may refuse what sleepers rest on.
  Change change(world.leftMidway);
  Rouse<S>::all(world.state, world.derived);
  change.done();
}

}  // namespace

template <Scalar S>
void Space<S>::addCollisionHandler(CollisionType typeA, CollisionType typeB, CallbackNumber number) {
  requireUnlocked();
  bind(contextOf(), {typeA, typeB, number, HandlerBinding::Kind::pair}, "Space::addCollisionHandler");
}

template <Scalar S>
void Space<S>::addWildcardHandler(CollisionType type, CallbackNumber number) {
  requireUnlocked();
  bind(contextOf(), {type, kWildcardCollisionType, number, HandlerBinding::Kind::wildcard},
       "Space::addWildcardHandler");
}

template <Scalar S>
void Space<S>::addDefaultCollisionHandler(CallbackNumber number) {
  requireUnlocked();
  bind(contextOf(), {kWildcardCollisionType, kWildcardCollisionType, number, HandlerBinding::Kind::fallback},
       "Space::addDefaultCollisionHandler");
}

template <Scalar S>
void Space<S>::setStageObserver(StageObserver observer, void* data) {
  parts_->wiring.observer = observer;
  parts_->wiring.observerData = data;
}

template <Scalar S>
void Space<S>::setMaxPairs(std::uint32_t pairs) {
  require<Fault::SpaceLocked>(locked_ == 0);
  require<Fault::ValueOutOfRange>(pairs <= kMostPairs, "Space::setMaxPairs: pairs are ", pairs,
                                  ", allowed are 0 to ", kMostPairs);
  parts_->wiring.maxPairs = pairs;
}

template <Scalar S>
std::uint32_t Space<S>::maxPairs() const {
  return parts_->wiring.maxPairs;
}

template <Scalar S>
void Space<S>::setInterrupt(const Interrupt& interrupt) {
  parts_->wiring.budget.interrupt = interrupt;
}

template <Scalar S>
void Space<S>::setMaxWork(std::uint64_t work) {
  parts_->wiring.budget.most = work;
}

template <Scalar S>
std::uint64_t Space<S>::work() const {
  return parts_->wiring.budget.spent();
}

// The following choose who computes.

template <Scalar S>
void Space<S>::setWorkers(TaskRunner* runner, Sharing sharing) {
  require<Fault::SpaceLocked>(locked_ == 0);
  // Checked numbers note their high-water marks in one table, and report by exception.
  constexpr bool kAlone = requires { requires S::kChecks; };
  parts_->team.set(kAlone ? nullptr : runner, sharing);
  parts_->wiring.runner = runner;
}

template <Scalar S>
TaskRunner* Space<S>::workers() const {
  return parts_->wiring.runner;
}

template <Scalar S>
void Space<S>::setKernel(KernelTarget target) {
  require<Fault::SpaceLocked>(locked_ == 0);
  require<Fault::ValueOutOfRange>(target <= KernelTarget::simd128, "Space::setKernel: target is number ",
                                  static_cast<int>(target), ", allowed are 0 to ",
                                  static_cast<int>(KernelTarget::simd128));
  if (!isAvailable(target)) {
    parts_->wiring.remarks.raise(
        Remark::OtherKernel,
        "This build or this processor does not have that kernel: the next best one is taken. No "
        "result differs.");
  }
  forceKernel(nextBestKernel(target));
}

template <Scalar S>
void Space<S>::forceKernel(KernelTarget target) {
  require<Fault::SpaceLocked>(locked_ == 0);
  require<Fault::KernelUnavailable>(isAvailable(target), "Space::forceKernel: ", kernelName(target),
                                    " is not in this build, or not for this processor");
  parts_->wiring.kernel = nextBestKernel(target);
  parts_->step.soft.setKernel(parts_->wiring.kernel);
}

template <Scalar S>
KernelTarget Space<S>::kernel() const {
  return parts_->wiring.kernel;
}

}  // namespace samestep
