// SPDX-License-Identifier: MIT
#include <samestep/body.h>

#include <samestep/error.h>
#include <samestep/high_water.h>

#include "base/require_ieee.h"
#include "dynamics/body_checks.h"
#include "dynamics/body_motion.h"
#include "geometry/shape_geometry.h"

namespace samestep {

template <Scalar S>
Body<S>::Body(S mass, S moment) {
  requireMass(mass, "Body");
  requireMoment(moment, "Body");

  mass_ = mass;
  moment_ = toScaled(moment);
  derive();
}

template <Scalar S>
Body<S> Body<S>::fixedInPlace() {
  Body body;
  body.setType(BodyType::staticBody);
  return body;
}

template <Scalar S>
Body<S> Body<S>::kinematic() {
  Body body;
  body.setType(BodyType::kinematicBody);
  return body;
}

template <Scalar S>
Body<S> Body<S>::nonRotating(S mass) {
  Body body(mass, S(0));
  body.rotates_ = 0;
  return body;
}

template <Scalar S>
Body<S> Body<S>::detached() const {
  Body copy = *this;
  copy.id_ = {};
  copy.activity_ = Activity::awake;
  copy.island_ = 0;
  copy.extent_ = kMaxWorldExtent<S>;
  return copy;
}

template <Scalar S>
void Body<S>::derive() {
  const SinCos<S> turn = sincos(angle_);
  rotation_ = {turn.cos, turn.sin};
  deriveMass();
}

template <Scalar S>
void Body<S>::deriveMass() {
  const Scaled<S> zero{};
  const bool moves = isDynamic() && mass_ > S(0);
  inverseMass_ = moves ? reciprocal(toScaled(mass_)) : zero;
  inverseMoment_ = moves && rotates() && moment_ > zero ? reciprocal(moment_) : zero;
  momentPerMass_ = toScalarWithin(inverseMoment_ * toScaled(mass_), kMaxRelativeMoment<S>);
}

template <Scalar S>
bool Body<S>::wellFormed() const {
  if (type_ > BodyType::staticBody || rotates_ > 1 || bullet_ > 1) return false;
  if (!restsWell() || !movesWell()) return false;
  if (!(mass_ == S(0) || (mass_ >= kMinMass<S> && mass_ <= kMaxMass<S>))) return false;
  // Shapes of any supported size and mass add up to no more, with room to spare.
  const Scaled<S> zero{};
  const Scaled<S> large = toScaled(kMaxMoment<S>) * toScaled(kMaxMoment<S>);
  if (!(moment_ >= zero && moment_ <= large)) return false;
  // A centre of mass at the end of its range, on a body at the end of the world.
  const S far = kMaxWorldExtent<S> * S(3);
  if (!within(centerOfMass_, kMaxCenterOfMass<S>) || !within(center_, far)) return false;
  if (!within(velocity_, kMaxSpeed<S>) || !within(angularVelocity_, kMaxAngularSpeed<S>)) return false;
  const bool still = velocity_ == Vector<S>() && angularVelocity_ == S(0);
  if (type_ == BodyType::staticBody && !still) return false;
  return within(angle_, kMaxAngle<S>) && within(force_, kMaxForce<S>) && within(torque_, kMaxForce<S>) &&
         within(velocityBias_, kMaxSpeed<S>) && within(angularVelocityBias_, kMaxAngularSpeed<S>);
}

template <Scalar S>
bool Body<S>::restsWell() const {
  if (activity_ > Activity::roused || maySleep_ > 1) return false;
  if (!(restTime_ >= S(0) && restTime_ <= kMaxRestTime<S>)) return false;
  if (activity_ == Activity::roused) return true;
  const bool asleep = activity_ == Activity::asleep;
  if ((island_ != 0) != (asleep && isDynamic())) return false;
  const Vector<S> none{};
  return !asleep || (velocity_ == none && angularVelocity_ == S(0));
}

template <Scalar S>
bool Body<S>::movesWell() const {
  const auto upTo = [](S value, S limit) { return value >= S(0) && value <= limit; };
  return within(gravityScale_, kMostScale<S>) && upTo(linearDamping_, kMostScale<S>) &&
         upTo(angularDamping_, kMostScale<S>) && upTo(speedLimit_, kMaxSpeed<S>) &&
         upTo(spinLimit_, kMaxAngularSpeed<S>);
}

template <Scalar S>
void Body<S>::setMaySleep(bool may) {
  maySleep_ = may ? 1 : 0;
  if (!may) rouse();
}

template <Scalar S>
void Body<S>::setType(BodyType type) {
  require<Fault::AttachedBody>(!id_.valid(), "Body::setType: the body is in a Space, as ", id_,
                               "; its type is changed by Space::setType");
  if (type != type_) rouse();
  type_ = type;
  forgetBias();
  if (type == BodyType::staticBody) {
    velocity_ = {};
    angularVelocity_ = S(0);
  }
  derive();
}

template <Scalar S>
S Body<S>::moment() const {
  return saturated<S>(exactMoment());
}

template <Scalar S>
void Body<S>::setMass(S mass) {
  require<Fault::StaticBodyMass>(isDynamic(), "Body::setMass to ", mass, " kg", kindOf(type_),
                                 ", only a dynamic one has a mass");
  requireMass(mass, "Body::setMass");

  put(mass_, mass);
  derive();
}

template <Scalar S>
void Body<S>::setMoment(S moment) {
  require<Fault::StaticBodyMass>(isDynamic(), "Body::setMoment to ", moment, " kg m^2", kindOf(type_),
                                 ", only a dynamic one has a moment");
  requireMoment(moment, "Body::setMoment");

  put(moment_, toScaled(moment));
  put(rotates_, std::uint8_t{1});
  derive();
}

template <Scalar S>
void Body<S>::setRotates(bool rotates) {
  put(rotates_, static_cast<std::uint8_t>(rotates ? 1 : 0), isDynamic());
  derive();
}

template <Scalar S>
void Body<S>::setGravityScale(S scale) {
  requireWithin(scale, kMostScale<S>, "Body::setGravityScale: scale is ", "");

  put(gravityScale_, scale, isDynamic());
}

template <Scalar S>
void Body<S>::setLinearDamping(S perSecond) {
  requireUpTo(perSecond, kMostScale<S>, "Body::setLinearDamping: damping is ", " 1/s");

  put(linearDamping_, perSecond, isDynamic());
}

template <Scalar S>
void Body<S>::setAngularDamping(S perSecond) {
  requireUpTo(perSecond, kMostScale<S>, "Body::setAngularDamping: damping is ", " 1/s");

  put(angularDamping_, perSecond, isDynamic());
}

template <Scalar S>
void Body<S>::setSpeedLimit(S limit) {
  requireUpTo(limit, kMaxSpeed<S>, "Body::setSpeedLimit: limit is ", " m/s");

  put(speedLimit_, limit, isDynamic());
}

template <Scalar S>
void Body<S>::setSpinLimit(S limit) {
  requireUpTo(limit, kMaxAngularSpeed<S>, "Body::setSpinLimit: limit is ", " rad/s");

  put(spinLimit_, limit, isDynamic());
}

template <Scalar S>
void Body<S>::setMassProperties(const MassProperties<S>& properties) {
  const S mass = properties.mass;
  require<Fault::IllegalBody>(mass == S(0) || (mass >= kMinMass<S> && mass <= kMaxMass<S>),
                              "a body: mass, summed over its shapes, is ", mass, " kg, allowed are ",
                              kMinMass<S>, " to ", kMaxMass<S>, " kg");
  requireWithin(properties.centerOfMass, kMaxCenterOfMass<S>, "a body: centre of mass is ", " m");

  put(mass_, mass, isDynamic());
  put(moment_, properties.moment, isDynamic());
  moveCenter(properties.centerOfMass);
  derive();
}

template <Scalar S>
void Body<S>::forgetMass() {
  mass_ = S(0);
  moment_ = Scaled<S>{};
  derive();
}

template <Scalar S>
void Body<S>::forgetBias() {
  velocityBias_ = {};
  angularVelocityBias_ = S(0);
}

template <Scalar S>
void Body<S>::moveCenter(const Vector<S>& center) {
  const Vector<S> origin = position();
  // The material of the body moves on as it does, and with it what is its centre from now on. As differences
  // of places, so that of Fixed the way by which the centre came to a place makes no difference.
  const Vector<S> before = perp(rotate(centerOfMass_, rotation_)), after = perp(rotate(center, rotation_));
  if (before != after) {
    velocity_ = heldWithin(velocity_ + (after * angularVelocity_ - before * angularVelocity_), kMaxSpeed<S>);
    velocityBias_ = heldWithin(velocityBias_ + (after * angularVelocityBias_ - before * angularVelocityBias_),
                               kMaxSpeed<S>);
  }
  put(centerOfMass_, center, isDynamic());
  center_ = origin + rotate(centerOfMass_, rotation_);
}

template <Scalar S>
void Body<S>::setPosition(const Vector<S>& position) {
  // The step clamps what a position function sets to the world.
  requireWithin(position, stepping_ != 0 ? kMaxWorldExtent<S> : extent_, "Body::setPosition: position is ",
                " m");

  put(center_, position + rotate(centerOfMass_, rotation_));
  // A push out of where it no longer is.
  forgetBias();
}

template <Scalar S>
void Body<S>::setCenterOfMass(const Vector<S>& center) {
  requireWithin(center, kMaxCenterOfMass<S>, "Body::setCenterOfMass: centre is ", " m");

  moveCenter(center);
}

template <Scalar S>
void Body<S>::setVelocity(const Vector<S>& velocity) {
  requireWithin(velocity, kMaxSpeed<S>, "Body::setVelocity: velocity is ", " m/s");
  require<Fault::IllegalBody>(type_ != BodyType::staticBody || velocity == Vector<S>(),
                              "Body::setVelocity: velocity is ", velocity,
                              " m/s, allowed is 0 for a static body");

  put(velocity_, velocity);
}

template <Scalar S>
void Body<S>::setForce(const Vector<S>& force) {
  requireWithin(force, kMaxForce<S>, "Body::setForce: force is ", " N");

  put(force_, force, isDynamic());
}

template <Scalar S>
void Body<S>::setAngle(S angle) {
  requireWithin(angle, kMaxAngle<S>, "Body::setAngle: angle is ", " rad");
  const Vector<S> origin = position();

  put(angle_, angle);
  const SinCos<S> turn = sincos(angle);
  rotation_ = {turn.cos, turn.sin};
  center_ = origin + rotate(centerOfMass_, rotation_);
  forgetBias();
}

template <Scalar S>
void Body<S>::setAngularVelocity(S angularVelocity) {
  requireWithin(angularVelocity, kMaxAngularSpeed<S>, "Body::setAngularVelocity: angular velocity is ",
                " rad/s");
  require<Fault::IllegalBody>(type_ != BodyType::staticBody || angularVelocity == S(0),
                              "Body::setAngularVelocity: angular velocity is ", angularVelocity,
                              " rad/s, allowed is 0 for a static body");

  put(angularVelocity_, angularVelocity);
}

template <Scalar S>
void Body<S>::setTorque(S torque) {
  requireWithin(torque, kMaxForce<S>, "Body::setTorque: torque is ", " N m");

  put(torque_, torque, isDynamic());
}

#define SAMESTEP_EACH_SCALAR template class Body<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
