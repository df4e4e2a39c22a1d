// SPDX-License-Identifier: MIT
// The settings of a Space. Included by space.cpp alone, which instantiates Space.
#pragma once

#include <samestep/space.h>

#include "base/require_ieee.h"
#include "dynamics/body_access.h"
#include "islands/rouse.h"
#include "world/space_parts.h"

namespace samestep {
namespace {

template <class T>
void requireIn(const char* is, T value, T low, T high, const char* unit = "") {
  require<Fault::ValueOutOfRange>(value >= low && value <= high, "settings of a Space: ", is, value, unit,
                                  ", allowed are ", low, " to ", high, unit);
}

}  // namespace

// Settings.

namespace {

/// Refuses settings that any setter would refuse.
template <Scalar S>
void check(const Settings<S>& s) {
  require<Fault::InvalidIter>(s.iterations >= 1 && s.iterations <= 1000,
                              "settings of a Space: iterations are ", s.iterations,
                              ", allowed are 1 to 1000");
  require<Fault::InvalidIter>(s.substeps >= 1 && s.substeps <= 100, "settings of a Space: substeps are ",
                              s.substeps, ", allowed are 1 to 100");
  requireIn<int>("solver is number ", static_cast<int>(s.solver), 0, static_cast<int>(SolverKind::softStep));
  requireIn<int>("continuous is ", s.continuous, 0, 1);
  requireIn<int>("precision is number ", static_cast<int>(s.precision), 0,
                 static_cast<int>(ContactPrecision::fast));
  require<Fault::ValueOutOfRange>(within(s.gravity, kMaxAcceleration<S>), "settings of a Space: gravity is ",
                                  s.gravity, " m/s^2, allowed are up to ", kMaxAcceleration<S>,
                                  " m/s^2 along each axis");
  requireIn("damping is ", s.damping, S(0), S(1));
  requireIn("collision slop is ", s.collisionSlop, S(0), S(256), " m");
  requireIn("collision bias is ", s.collisionBias, S(0), S(1));
  requireIn("contact hertz are ", s.contactHertz, S(0), S(1000));
  requireIn("contact damping is ", s.contactDamping, S(0), S(100));
  requireIn("contact push speed is ", s.contactPushSpeed, S(0), S(1 << 10), " m/s");
  requireIn("contact margin is ", s.contactMargin, S(0), S(1), " m");
  requireIn("bounce threshold is ", s.bounceThreshold, S(0), S(1 << 10), " m/s");
  requireIn("sleep time threshold is ", s.sleepTimeThreshold, S(0), kMaxRestTime<S>, " s");
  requireIn("idle speed threshold is ", s.idleSpeedThreshold, S(0), kMaxSpeed<S>, " m/s");
  require<Fault::ValueOutOfRange>(s.worldExtent > S(0) && s.worldExtent <= kMaxWorldExtent<S>,
                                  "settings of a Space: world extent is ", s.worldExtent,
                                  " m, allowed are above 0 to ", kMaxWorldExtent<S>, " m");
}

template <Scalar S, class T>
Settings<S> with(Settings<S> settings, T Settings<S>::*field, std::type_identity_t<T> value) {
  settings.*field = value;
  return settings;
}

}  // namespace

template <Scalar S>
void Space<S>::setSettings(const Settings<S>& settings) {
  requireUsable();
  check(settings);
  const bool otherSolver = settings.solver != state_.settings.solver;
  const bool otherExtent = settings.worldExtent != state_.settings.worldExtent;
  const bool otherContacts = otherSolver || settings.contactMargin != state_.settings.contactMargin;
  if (!(settings == state_.settings)) Rouse<S>::all(state_, parts_->derived);
  state_.settings = settings;
  if (otherExtent) {
    state_.bodies.each(
        [&](BodyId id, Body<S>& body) { BodyAccess<S>::attach(body, id, settings.worldExtent); });
  }
  // The rest that sequential impulses left to push in the next step means nothing to another solver, nor
  // later.
  if (otherSolver) state_.bodies.each([](BodyId, Body<S>& body) { BodyAccess<S>::forgetBias(body); });
  if (!otherContacts) return;
  for (Pair<S>& pair : state_.pairs) pair.manifold = Manifold::unknown;
  for (Pair<S>& pair : state_.restingPairs) pair.manifold = Manifold::unknown;
}

template <Scalar S>
void Space<S>::setIterations(int iterations) {
  setSettings(with(state_.settings, &Settings<S>::iterations, iterations));
}

template <Scalar S>
void Space<S>::setPrecision(ContactPrecision precision) {
  setSettings(with(state_.settings, &Settings<S>::precision, precision));
}

template <Scalar S>
void Space<S>::setContinuous(bool continuous) {
  setSettings(with(state_.settings, &Settings<S>::continuous, continuous ? 1 : 0));
}

template <Scalar S>
void Space<S>::setSolver(SolverKind kind) {
  setSettings(with(state_.settings, &Settings<S>::solver, kind));
}

template <Scalar S>
void Space<S>::setSubsteps(int substeps) {
  setSettings(with(state_.settings, &Settings<S>::substeps, substeps));
}

template <Scalar S>
void Space<S>::setGravity(const Vector<S>& gravity) {
  setSettings(with(state_.settings, &Settings<S>::gravity, gravity));
}

template <Scalar S>
void Space<S>::setDamping(S damping) {
  setSettings(with(state_.settings, &Settings<S>::damping, damping));
}

template <Scalar S>
void Space<S>::setCollisionSlop(S slop) {
  setSettings(with(state_.settings, &Settings<S>::collisionSlop, slop));
}

template <Scalar S>
void Space<S>::setCollisionBias(S bias) {
  setSettings(with(state_.settings, &Settings<S>::collisionBias, bias));
}

template <Scalar S>
void Space<S>::setCollisionPersistence(std::uint32_t steps) {
  setSettings(with(state_.settings, &Settings<S>::collisionPersistence, steps));
}

template <Scalar S>
void Space<S>::setWorldExtent(S extent) {
  setSettings(with(state_.settings, &Settings<S>::worldExtent, extent));
}

template <Scalar S>
void Space<S>::setContactSoftness(S hertz, S damping) {
  Settings<S> next = state_.settings;
  next.contactHertz = hertz;
  next.contactDamping = damping;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setContactPushSpeed(S speed) {
  setSettings(with(state_.settings, &Settings<S>::contactPushSpeed, speed));
}

template <Scalar S>
void Space<S>::setContactMargin(S margin) {
  setSettings(with(state_.settings, &Settings<S>::contactMargin, margin));
}

template <Scalar S>
void Space<S>::setBounceThreshold(S speed) {
  setSettings(with(state_.settings, &Settings<S>::bounceThreshold, speed));
}

template <Scalar S>
void Space<S>::setSleepTimeThreshold(S seconds) {
  setSettings(with(state_.settings, &Settings<S>::sleepTimeThreshold, seconds));
}

template <Scalar S>
void Space<S>::setIdleSpeedThreshold(S speed) {
  setSettings(with(state_.settings, &Settings<S>::idleSpeedThreshold, speed));
}

}  // namespace samestep
