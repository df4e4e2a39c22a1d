// SPDX-License-Identifier: MIT
// How a Body answers impulses and forces, and how it moves in a step. Included by body.cpp alone, which
// instantiates Body.
#pragma once

#include <samestep/body.h>
#include <samestep/high_water.h>

#include "dynamics/body_checks.h"

namespace samestep {
namespace {

/// Velocity that a damping leaves.
template <Scalar S>
S leftOf(S velocity, S damping, S dt) {
  return damping == S(0) || dt <= S(0) ? velocity : velocity / (S(1) + damping * dt);
}

/// Acceleration by a force of a thing of that inverse mass, kept where sums with gravity cannot overflow.
template <Scalar S>
S answer(S force, const Scaled<S>& inverse) {
  if (force == S(0)) return S(0);
  return toScalarWithin(toScaled(force) * inverse, S(1 << 30));
}

}  // namespace

template <Scalar S>
Vector<S> Body<S>::velocityAt(const Vector<S>& worldPoint) const {
  return mulAdd(perp(worldPoint - center_), angularVelocity_, velocity_);
}

template <Scalar S>
typename Body<S>::Motion Body<S>::pushed(const Vector<S>& impulse, const Vector<S>& worldPoint) const {
  requireWithin(impulse, kMaxForce<S>, "an impulse on a body: it is ", " N s");
  requireWithin(worldPoint, kMaxWorldExtent<S>, "an impulse on a body: its point is ", " m");
  if (!isDynamic()) return {};
  const Vector<S> arm = worldPoint - center_;
  const Scaled<S> turning = toScaled(arm.x) * toScaled(impulse.y) - toScaled(arm.y) * toScaled(impulse.x);
  const S spin = toScalarWithin(turning * inverseMoment_, kMaxAngle<S>);
  const Vector<S> change(answer(impulse.x, inverseMass_), answer(impulse.y, inverseMass_));
  return {change, spin};
}

template <Scalar S>
void Body<S>::applyImpulse(const Vector<S>& impulse, const Vector<S>& worldPoint) {
  const Motion change = pushed(impulse, worldPoint);
  if (!isDynamic()) return;
  if (change.velocity != Vector<S>() || change.angularVelocity != S(0)) rouse();
  holdVelocity({velocity_ + change.velocity, angularVelocity_ + change.angularVelocity});
}

template <Scalar S>
void Body<S>::applyBiasImpulse(const Vector<S>& impulse, const Vector<S>& worldPoint) {
  const Motion change = pushed(impulse, worldPoint);
  if (change.velocity != Vector<S>() || change.angularVelocity != S(0)) rouse();
  velocityBias_ = heldWithin(velocityBias_ + change.velocity, kMaxSpeed<S>);
  angularVelocityBias_ =
      clamp(angularVelocityBias_ + change.angularVelocity, -kMaxAngularSpeed<S>, kMaxAngularSpeed<S>);
}

template <Scalar S>
void Body<S>::applyForce(const Vector<S>& force, const Vector<S>& worldPoint) {
  requireWithin(force, kMaxForce<S>, "Body::applyForce: force is ", " N");
  requireWithin(worldPoint, kMaxWorldExtent<S>, "Body::applyForce: point is ", " m");
  // Far below 2^31 before they are added, so that Fixed cannot wrap.
  const Scaled<S> fx = toScaled(force_.x) + toScaled(force.x);
  const Scaled<S> fy = toScaled(force_.y) + toScaled(force.y);
  const Vector<S> arm = worldPoint - center_;
  const Scaled<S> turning = toScaled(arm.x) * toScaled(force.y) - toScaled(arm.y) * toScaled(force.x);
  const Vector<S> sum(toScalar<S>(fx), toScalar<S>(fy));
  const S torque = saturated<S>(toScaled(torque_) + turning);
  requireWithin(sum, kMaxForce<S>, "Body::applyForce: the sum of forces is ", " N");
  requireWithin(torque, kMaxForce<S>, "Body::applyForce: the sum of torques is ", " N m");

  put(force_, sum, isDynamic());
  put(torque_, torque, isDynamic());
}

template <Scalar S>
const char* Body<S>::cannotStep() const {
  if (!isDynamic()) return nullptr;
  if (mass_ == S(0)) return "mass is 0: set it, or give the body a shape with a mass";
  if (rotates() && !(moment_ > Scaled<S>{})) {
    return "moment is 0: set it, give the body a shape with a mass, or use Body::nonRotating";
  }
  return nullptr;
}

template <Scalar S>
typename Body<S>::Motion Body<S>::acceleration(const Vector<S>& gravity) const {
  return {gravity * gravityScale_ + Vector<S>(answer(force_.x, inverseMass_), answer(force_.y, inverseMass_)),
          rotates() ? answer(torque_, inverseMoment_) : S(0)};
}

template <Scalar S>
typename Body<S>::Motion Body<S>::accelerated(const Vector<S>& gravity, S damping, S dt) const {
  const Motion pull = acceleration(gravity), had = damped(dt);
  return {
      {dot(had.velocity.x, damping, pull.velocity.x, dt), dot(had.velocity.y, damping, pull.velocity.y, dt)},
      dot(had.angularVelocity, damping, pull.angularVelocity, dt)};
}

template <Scalar S>
typename Body<S>::Motion Body<S>::damped(S dt) const {
  return {{leftOf(velocity_.x, linearDamping_, dt), leftOf(velocity_.y, linearDamping_, dt)},
          leftOf(angularVelocity_, angularDamping_, dt)};
}

template <Scalar S>
typename Body<S>::Motion Body<S>::limited(const Motion& motion) const {
  Motion within = motion;
  if (speedLimit_ < kMaxSpeed<S>) {
    const S speed = length(motion.velocity);
    if (speed > speedLimit_) {
      within.velocity = {mulDiv(motion.velocity.x, speedLimit_, speed),
                         mulDiv(motion.velocity.y, speedLimit_, speed)};
    }
  }
  within.angularVelocity = clamp(motion.angularVelocity, -spinLimit_, spinLimit_);
  return within;
}

template <Scalar S>
std::uint8_t Body<S>::holdVelocity(const Motion& motion) {
  highWater<S>("body: speed before it is held", max(abs(motion.velocity.x), abs(motion.velocity.y)));
  highWater<S>("body: spin before it is held", motion.angularVelocity);
  velocity_ = heldWithin(motion.velocity, kMaxSpeed<S>);
  angularVelocity_ = clamp(motion.angularVelocity, -kMaxAngularSpeed<S>, kMaxAngularSpeed<S>);
  const auto held =
      static_cast<std::uint8_t>((velocity_ == motion.velocity ? kHeldNothing : kHeldSpeed) |
                                (angularVelocity_ == motion.angularVelocity ? kHeldNothing : kHeldSpin));
  if (speedLimit_ < kMaxSpeed<S> || spinLimit_ < kMaxAngularSpeed<S>) [[unlikely]] {
    const Motion own = limited({velocity_, angularVelocity_});
    velocity_ = own.velocity;
    angularVelocity_ = own.angularVelocity;
  }
  return held;
}

template <Scalar S>
std::uint8_t Body<S>::holdPosition(S dt, S extent) {
  const Vector<S> by = (velocity_ + velocityBias_) * dt;
  const S angle = (angularVelocity_ + angularVelocityBias_) * dt;
  // The bias only pushes overlapping shapes apart. Kept past this step, it would become momentum that no
  // impulse ever put in.
  forgetBias();
  return holdMoved(by, angle, extent);
}

template <Scalar S>
std::uint8_t Body<S>::holdMoved(const Vector<S>& by, S angle, S extent) {
  const Vector<S> moved = center_ + by;
  const S turned = angle_ + angle;
  highWater<S>("body: position before it is held", max(abs(moved.x), abs(moved.y)));
  highWater<S>("body: angle before it is held", turned);
  std::uint8_t what = kHeldNothing;
  center_ = heldWithin(moved, extent);
  if (!(center_ == moved)) {
    what |= kHeldAtBorder;
    if (center_.x != moved.x) velocity_.x = S(0);
    if (center_.y != moved.y) velocity_.y = S(0);
  }
  const S heldAngle = clamp(turned, -kMaxAngle<S>, kMaxAngle<S>);
  if (heldAngle != turned) {
    what |= kHeldSpin;
    angularVelocity_ = S(0);
  }
  if (heldAngle != angle_) {
    angle_ = heldAngle;
    const SinCos<S> turn = sincos(angle_);
    rotation_ = {turn.cos, turn.sin};
  }
  return what;
}

template <Scalar S>
void Body<S>::updatePosition(S dt) {
  requireWithin(dt, kMaxTimeStep<S>, "Body::updatePosition: dt is ", " s");
  const Vector<S> moved = mulAdd(velocity_ + velocityBias_, dt, center_);
  const S turned = mulAdd(angularVelocity_ + angularVelocityBias_, dt, angle_);
  if (stepping_ == 0) {
    requireWithin(moved, kMaxWorldExtent<S>, "Body::updatePosition: it leads to ", " m");
    requireWithin(turned, kMaxAngle<S>, "Body::updatePosition: it leads to an angle of ", " rad");
  }

  if (moved != center_ || turned != angle_) rouse();
  held_ |= holdPosition(dt, kMaxWorldExtent<S>);
}

template <Scalar S>
void Body<S>::updateVelocity(const Vector<S>& gravity, S damping, S dt) {
  if (!isDynamic()) return;
  const char* reason = cannotStep();
  require<Fault::IllegalBody>(reason == nullptr, "Body::updateVelocity: the body's ", reason);
  requireWithin(dt, kMaxTimeStep<S>, "Body::updateVelocity: dt is ", " s");
  requireWithin(gravity, kMaxAcceleration<S>, "Body::updateVelocity: gravity is ", " m/s^2");
  require<Fault::IllegalBody>(damping >= S(0) && damping <= S(1), "Body::updateVelocity: damping is ",
                              damping, ", allowed are 0 to 1");
  const Motion motion = accelerated(gravity, damping, dt);
  if (stepping_ == 0) {
    requireWithin(motion.velocity, kMaxSpeed<S>, "Body::updateVelocity: it leads to ", " m/s");
    requireWithin(motion.angularVelocity, kMaxAngularSpeed<S>, "Body::updateVelocity: it leads to ",
                  " rad/s");
  }

  if (motion.velocity != velocity_ || motion.angularVelocity != angularVelocity_) rouse();
  held_ |= holdVelocity(motion);
  force_ = {};
  torque_ = S(0);
}

template <Scalar S>
S Body<S>::kineticEnergy() const {
  if (!isDynamic()) return S(0);
  const auto square = [](S x) { return toScaled(x) * toScaled(x); };
  const Scaled<S> twice =
      toScaled(mass_) * (square(velocity_.x) + square(velocity_.y)) + moment_ * square(angularVelocity_);
  return saturated<S>(twice * toScaled(ratio<S>(1, 2)));
}

}  // namespace samestep
