// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <tuple>

#include <samestep/body.h>

namespace samestep {

/// Access of a Space to its bodies beyond their public functions: it owns them and moves them, clamped to
/// their ranges where a setter would throw.
template <Scalar S>
struct BodyAccess {
  using Motion = typename Body<S>::Motion;
  using WithinStep = typename Body<S>::WithinStep;

  static void attach(Body<S>& body, BodyId id, S worldExtent) {
    body.id_ = id;
    body.extent_ = worldExtent;
  }
  /// Begins the stay of what enters a Space.
  static void begin(Body<S>& body) {
    body.activity_ = Activity::awake;
    body.island_ = 0;
  }
  /// A body in place of another one that may have slept.
  static void takePlaceOf(Body<S>& body, const Body<S>& before) {
    if (before.activity_ == Activity::awake) return;
    body.activity_ = Activity::roused;
    body.island_ = before.island_;
    body.restTime_ = S(0);
  }
  static void rouse(Body<S>& body) { body.rouse(); }
  static void wake(Body<S>& body) {
    body.activity_ = Activity::awake;
    body.island_ = 0;
  }
  /// @param island  0 of one that is not dynamic
  static void fallAsleep(Body<S>& body, std::uint32_t island) {
    body.activity_ = Activity::asleep;
    body.island_ = island;
    body.restTime_ = S(0);
    body.velocity_ = {};
    body.angularVelocity_ = S(0);
    body.forgetBias();
    clearForces(body);
  }
  static void setRestTime(Body<S>& body, S seconds) { body.restTime_ = seconds; }
  /// Reason why the body cannot be stepped, or nullptr.
  static const char* cannotStep(const Body<S>& body) { return body.cannotStep(); }
  static Motion accelerated(const Body<S>& body, const Vector<S>& gravity, S damping, S dt) {
    return body.accelerated(gravity, damping, dt);
  }
  /// Takes what the body's own damping leaves of its velocities.
  static void damp(Body<S>& body, S dt) {
    const Motion left = body.damped(dt);
    body.velocity_ = left.velocity;
    body.angularVelocity_ = left.angularVelocity;
  }
  static Motion acceleration(const Body<S>& body, const Vector<S>& gravity) {
    return body.acceleration(gravity);
  }
  static std::uint8_t holdVelocity(Body<S>& body, const Motion& motion) { return body.holdVelocity(motion); }
  static std::uint8_t holdPosition(Body<S>& body, S dt, S extent) { return body.holdPosition(dt, extent); }
  static std::uint8_t holdMoved(Body<S>& body, const Vector<S>& by, S angle, S extent) {
    return body.holdMoved(by, angle, extent);
  }
  /// Puts a body where a motion took it.
  static void setPose(Body<S>& body, const Vector<S>& center, S angle) {
    body.center_ = center;
    body.angle_ = angle;
    const SinCos<S> turn = sincos(angle);
    body.rotation_ = {turn.cos, turn.sin};
  }
  static void clearForces(Body<S>& body) {
    body.force_ = {};
    body.torque_ = S(0);
  }
  /// Takes fields and rotation of a saved body from a reader. What follows from the mass stays where that is
  /// the mass the body had, as nearly always when a world goes back a few steps.
  template <class Reader>
  static void unpack(Body<S>& body, Reader& read) {
    const auto before = std::tuple(body.type_, body.rotates_, body.mass_, body.moment_);
    read.get(body);
    read.get(body.rotation_);
    if (before != std::tuple(body.type_, body.rotates_, body.mass_, body.moment_)) body.deriveMass();
    body.stepping_ = body.held_ = 0;
  }
  /// Makes the mass of a body that is not dynamic be summed over its shapes when it becomes so.
  static void forgetMass(Body<S>& body) { body.forgetMass(); }
  static void forgetBias(Body<S>& body) { body.forgetBias(); }
  static void setBias(Body<S>& body, const Vector<S>& velocity, S angularVelocity) {
    body.velocityBias_ = velocity;
    body.angularVelocityBias_ = angularVelocity;
  }
};

}  // namespace samestep
