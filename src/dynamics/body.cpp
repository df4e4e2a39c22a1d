// SPDX-License-Identifier: MIT
#include <samestep/body.h>

#include <samestep/error.h>
#include <samestep/high_water.h>

#include "base/require_ieee.h"
#include "geometry/shape_geometry.h"

namespace samestep {
namespace {

template <Scalar S>
void requireMoment(S moment, const char* asked) {
  constexpr const char* is = ": moment is ";
  require<Fault::NaNMoment>(moment == moment, asked, is, moment);
  require<Fault::NegativeMoment>(moment >= S(0), asked, is, moment, " kg m^2, allowed are 0 and ",
                                 kMinMoment<S>, " to ", kMaxMoment<S>, " kg m^2");
  require<Fault::InfiniteMoment>(isFinite(moment), asked, is, moment,
                                 "; see Body::nonRotating for a body that does not turn");
  require<Fault::MomentOutOfRange>(moment == S(0) || (moment >= kMinMoment<S> && moment <= kMaxMoment<S>),
                                   asked, is, moment, " kg m^2, allowed are 0 and ", kMinMoment<S>, " to ",
                                   kMaxMoment<S>, " kg m^2");
}

/// Refuses a number, or a vector by its components.
/// @param is  "Body::setForce: force is "
template <class T, Scalar S>
void requireWithin(const T& value, S limit, const char* is, const char* unit) {
  require<Fault::IllegalBody>(within(value, limit), is, value, unit, ", allowed are -", limit, " to ", limit,
                              unit);
}

/// Says of which kind a body is that is not dynamic.
const char* kindOf(BodyType type) {
  return type == BodyType::staticBody ? ": the body is static" : ": the body is kinematic";
}

/// Acceleration by a force of a thing of that inverse mass, kept where sums with gravity cannot overflow.
template <Scalar S>
S answer(S force, const Scaled<S>& inverse) {
  if (force == S(0)) return S(0);
  return toScalarWithin(toScaled(force) * inverse, S(1 << 30));
}

}  // namespace

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
  if (type_ > BodyType::staticBody || rotates_ > 1 || !restsWell()) return false;
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
  return {gravity + Vector<S>(answer(force_.x, inverseMass_), answer(force_.y, inverseMass_)),
          rotates() ? answer(torque_, inverseMoment_) : S(0)};
}

template <Scalar S>
typename Body<S>::Motion Body<S>::accelerated(const Vector<S>& gravity, S damping, S dt) const {
  const Motion pull = acceleration(gravity);
  return {{dot(velocity_.x, damping, pull.velocity.x, dt), dot(velocity_.y, damping, pull.velocity.y, dt)},
          dot(angularVelocity_, damping, pull.angularVelocity, dt)};
}

template <Scalar S>
std::uint8_t Body<S>::holdVelocity(const Motion& motion) {
  highWater<S>("body: speed before it is held", max(abs(motion.velocity.x), abs(motion.velocity.y)));
  highWater<S>("body: spin before it is held", motion.angularVelocity);
  velocity_ = heldWithin(motion.velocity, kMaxSpeed<S>);
  angularVelocity_ = clamp(motion.angularVelocity, -kMaxAngularSpeed<S>, kMaxAngularSpeed<S>);
  return static_cast<std::uint8_t>((velocity_ == motion.velocity ? kHeldNothing : kHeldSpeed) |
                                   (angularVelocity_ == motion.angularVelocity ? kHeldNothing : kHeldSpin));
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

#define SAMESTEP_EACH_SCALAR template class Body<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
