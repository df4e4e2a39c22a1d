// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/id.h>
#include <samestep/limits.h>
#include <samestep/transform.h>
#include <samestep/vector.h>

namespace samestep {

template <Scalar S>
class Space;
template <Scalar S>
struct BodyAccess;

/// Kind of motion of a body. MIS: BodyType, with Chipmunk's kinematic bodies.
enum class BodyType : std::uint8_t {
  dynamicBody = 0,    ///< Forces, gravity and contacts.
  kinematicBody = 1,  ///< Only its own velocity; pushes dynamic bodies, is pushed by nothing.
  staticBody = 2,     ///< Nothing; its velocity is zero.
};

/// State of a body: whether a step moves it. MIS: none, Chipmunk's sleeping
enum class Activity : std::uint8_t {
  awake = 0,
  asleep = 1,  ///< No step looks at it. Of a body that is not dynamic: nothing has moved it lately.
  roused = 2,  ///< Was asleep when somebody changed it: the next step wakes it with its island.
};

/// Names a position or velocity function registered with the Space; 0 is the built-in one.
using CallbackNumber = std::uint32_t;

/// Mass, centre and moment of all shapes of a body together.
template <Scalar S>
struct MassProperties {
  S mass{};
  Scaled<S> moment{};        ///< kg m^2 about the centre of mass.
  Vector<S> centerOfMass{};  ///< Place in body coordinates, m.
};

/// A rigid body: mass, pose and motion about its centre of mass. MIS section 4.
///
/// A value that carries the id its Space gave it, or none; see detached(). The ranges of samestep/limits.h
/// hold for every setter, which throws before it changes anything. A mass, moment or inverse of a static or
/// kinematic body reads 0: it cannot be moved by any impulse, and no infinity exists here.
template <Scalar S>
class Body {
 public:
  /// A dynamic body at rest at the origin.
  /// @param mass    kg, 0 or in [1e-3, 1e6]; 0 means: accumulate it from the shapes before the first step
  /// @param moment  kg m^2 about the centre of mass, 0 or in [2^-20, 2^30]
  /// @throws NaNMass, NegativeMass, InfiniteMass, MassOutOfRange, NaNMoment, NegativeMoment, InfiniteMoment,
  ///         MomentOutOfRange
  /// MIS: newBody, bodyInit
  Body(S mass, S moment);

  /// A dynamic body at rest at the origin whose mass comes from its shapes.
  Body() : Body(S(0), S(0)) {}

  /// MIS: newStaticBody
  static Body fixedInPlace();
  /// A body that moves by its velocity alone.
  static Body kinematic();
  /// A dynamic body that no impulse turns; it takes the place of an infinite moment.
  /// @throws as the constructor for mass
  static Body nonRotating(S mass);

  /// A copy that belongs to no Space.
  Body detached() const;

  /// The id its Space gave it; not valid() for a free body. MIS: bodyGetSpace
  BodyId id() const { return id_; }
  /// MIS: bodyGetType
  BodyType type() const { return type_; }
  bool isDynamic() const { return type_ == BodyType::dynamicBody; }
  /// True if contacts may turn the body.
  bool rotates() const { return rotates_ != 0; }

  /// Turns a free body into another type, which forgets the bias velocities. A static body loses its
  /// velocity; a dynamic one has the mass and moment it was last given. For a body in a Space use
  /// Space::setType.
  /// @throws AttachedBody
  /// MIS: bodySetType
  void setType(BodyType type);

  /// kg. MIS: bodyGetMass
  S mass() const { return isDynamic() ? mass_ : S(0); }
  /// 1/kg, 0 where nothing moves it.
  Scaled<S> inverseMass() const { return inverseMass_; }
  /// kg m^2 about the centre of mass, saturated. MIS: bodyGetMoment
  S moment() const;
  /// Moment at full range and precision.
  Scaled<S> exactMoment() const { return isDynamic() ? moment_ : Scaled<S>{}; }
  /// 1/(kg m^2), 0 where nothing turns it.
  Scaled<S> inverseMoment() const { return inverseMoment_; }
  /// Inverse moment times mass, 1/m^2, held at kMaxRelativeMoment; 0 of a body that nothing turns.
  S momentPerMass() const { return momentPerMass_; }

  /// @throws StaticBodyMass, NaNMass, NegativeMass, InfiniteMass, MassOutOfRange
  /// MIS: bodySetMass
  void setMass(S mass);
  /// Sets the moment; a body that did not rotate does from here on.
  /// @throws StaticBodyMass, NaNMoment, NegativeMoment, InfiniteMoment, MomentOutOfRange
  /// MIS: bodySetMoment
  void setMoment(S moment);
  /// Mass, moment and centre of mass at once, as a set of shapes gives them. The origin of the body stays
  /// where it is, and the body moves on as it does: see setCenterOfMass.
  /// MIS: bodyAccumulateMassFromShapes (the body's part)
  /// @throws IllegalBody when the sum is outside the supported range
  void setMassProperties(const MassProperties<S>& properties);

  /// The place of the body's origin, m. MIS: bodyGetPosition
  Vector<S> position() const {
    // The product has the same bits where zero has no sign.
    if constexpr (FixedNumber<S>) {
      if (centerOfMass_ == Vector<S>()) return center_;
    }
    return center_ - rotate(centerOfMass_, rotation_);
  }
  /// The place of its centre of mass, m.
  const Vector<S>& worldCenter() const { return center_; }
  /// The centre of mass in body coordinates, m. MIS: bodyGetCenterOfMass
  const Vector<S>& centerOfMass() const { return centerOfMass_; }
  /// Velocity of the centre of mass, m/s. MIS: bodyGetVelocity
  const Vector<S>& velocity() const { return velocity_; }
  /// Acts on the centre of mass in the next step, which clears it, N. MIS: bodyGetForce
  const Vector<S>& force() const { return force_; }
  /// rad. MIS: bodyGetAngle
  S angle() const { return angle_; }
  /// The unit vector (cos, sin) of the angle. MIS: bodyGetRotation
  const Vector<S>& rotation() const { return rotation_; }
  /// rad/s, counter-clockwise. MIS: bodyGetAngularVelocity
  S angularVelocity() const { return angularVelocity_; }
  /// N m; see force. MIS: bodyGetTorque
  S torque() const { return torque_; }
  /// Transform from body to world coordinates.
  Transform<S> transform() const { return Transform<S>::rigid(position(), rotation_); }

  /// Moves the body and forgets the bias velocities: what pushed it out of an overlap is not to move it on
  /// from there.
  /// @throws IllegalBody outside the world
  /// MIS: bodySetPosition
  void setPosition(const Vector<S>& position);
  /// Moves the centre of mass within the body. The body's origin stays in place, and every point of the body
  /// keeps its velocity: that of the new centre is what the body's material had there, held at the speed
  /// limit.
  /// @throws IllegalBody farther than 2^8 m from the origin
  /// MIS: bodySetCenterOfMass
  void setCenterOfMass(const Vector<S>& center);
  /// @throws IllegalBody above the speed limit, or for a moving static body
  /// MIS: bodySetVelocity
  void setVelocity(const Vector<S>& velocity);
  /// @throws IllegalBody
  /// MIS: bodySetForce
  void setForce(const Vector<S>& force);
  /// Turns about the body's origin, which stays in place. Forgets the bias velocities, as setPosition does.
  /// @throws IllegalBody
  /// MIS: bodySetAngle
  void setAngle(S angle);
  /// @throws IllegalBody
  /// MIS: bodySetAngularVelocity
  void setAngularVelocity(S angularVelocity);
  /// @throws IllegalBody
  /// MIS: bodySetTorque
  void setTorque(S torque);

  /// The number of the function that moves it. MIS: bodySetPositionFunc
  void setPositionFunc(CallbackNumber number) { put(positionFunc_, number); }
  CallbackNumber positionFunc() const { return positionFunc_; }
  /// The number of the function that changes its velocity. MIS: bodySetVelocityFunc
  void setVelocityFunc(CallbackNumber number) { put(velocityFunc_, number); }
  CallbackNumber velocityFunc() const { return velocityFunc_; }

  /// Factor of gravity in the body's acceleration; 1 at first.
  S gravityScale() const { return gravityScale_; }
  /// @param scale  within +-2^10
  /// @throws IllegalBody
  void setGravityScale(S scale);
  /// Part of its velocity that the body loses by itself, per second: a step of dt seconds divides what it had
  /// by 1 + damping * dt, beside the damping of the Space; 0 at first.
  S linearDamping() const { return linearDamping_; }
  S angularDamping() const { return angularDamping_; }
  /// @param perSecond  1/s, 0 to 2^10
  /// @throws IllegalBody
  void setLinearDamping(S perSecond);
  void setAngularDamping(S perSecond);
  /// Speed of the centre of mass, m/s, and spin, rad/s, beyond which no step and no impulse leaves a dynamic
  /// body: the largest a body may have at all, at first.
  S speedLimit() const { return speedLimit_; }
  S spinLimit() const { return spinLimit_; }
  /// @param limit  0 to kMaxSpeed, which is none
  /// @throws IllegalBody
  void setSpeedLimit(S limit);
  /// @param limit  0 to kMaxAngularSpeed, which is none
  /// @throws IllegalBody
  void setSpinLimit(S limit);
  /// Has impulses and torques turn the body, or not. One that they do not turn goes on at the spin it has.
  void setRotates(bool rotates);
  /// True if a step stops it also where it meets what contacts move, see docs/continuous.md. It is stopped by
  /// what they do not move in any case.
  bool bullet() const { return bullet_ != 0; }
  void setBullet(bool bullet) { bullet_ = bullet ? 1 : 0; }

  void setUserData(std::uint64_t data) { userData_ = data; }
  std::uint64_t userData() const { return userData_; }

  // Sleeping, see docs/sleeping.md. A setter that changes anything wakes the body, with its island as the
  // next step begins, and counts its rest anew.

  /// True if steps leave it alone, as they do with an island at rest: see Settings::sleepTimeThreshold.
  bool isSleeping() const { return activity_ == Activity::asleep && isDynamic(); }
  Activity activity() const { return activity_; }
  /// Wakes it.
  void activate() { rouse(); }
  /// Spares a dynamic body the wait: as if it had been at rest for long. It sleeps from the end of the first
  /// step on that its island may sleep at, so never where nothing holds it.
  void sleep() {
    if (isDynamic() && activity_ != Activity::asleep) restTime_ = kMaxRestTime<S>;
  }
  /// True if it, and what touches it, may ever sleep.
  bool maySleep() const { return maySleep_ != 0; }
  void setMaySleep(bool may);
  /// For how long it has been at rest, s, counted while anything may sleep; 0 while it sleeps.
  S restTime() const { return restTime_; }
  /// Island of a sleeper: its lowest slot, plus 1; they wake together. Else 0, unless it was woken by hand
  /// since the last step.
  std::uint32_t island() const { return island_; }

  /// World from body coordinates and back.
  Vector<S> toWorld(const Vector<S>& point) const { return transformPoint(transform(), point); }
  Vector<S> toLocal(const Vector<S>& point) const { return unrotate(point - position(), rotation_); }
  /// The velocity of the body's material at a point in world coordinates, m/s.
  Vector<S> velocityAt(const Vector<S>& worldPoint) const;

  /// An impulse in N s at a world point changes the velocities at once; they are held at the limits. Does
  /// nothing to a body that is not dynamic.
  /// @throws IllegalBody for an impulse that is not finite
  void applyImpulse(const Vector<S>& impulse, const Vector<S>& worldPoint);
  /// Applies an impulse to the bias velocities.
  /// @throws IllegalBody for an impulse that is not finite
  void applyBiasImpulse(const Vector<S>& impulse, const Vector<S>& worldPoint);
  /// A force in N at a world point is added to force and torque.
  /// @throws IllegalBody where the sum is out of range
  void applyForce(const Vector<S>& force, const Vector<S>& worldPoint);

  /// Moves by its velocities for dt seconds, in [-1, 1], and forgets the bias velocities.
  /// @throws IllegalBody for dt, or where that leaves the world; in a step's position function it is held
  /// there MIS: bodyUpdatePosition
  void updatePosition(S dt);
  /// Gravity, force and torque for dt seconds, in [-1, 1]; clears force and torque. Does nothing to a body
  /// that is not dynamic.
  /// @throws IllegalBody for a body without mass, an argument out of range, or beyond the speed limits; in a
  ///         step's velocity function it is held at them
  /// MIS: bodyUpdateVelocity
  void updateVelocity(const Vector<S>& gravity, S dt) { updateVelocity(gravity, S(1), dt); }
  /// Updates the velocities after multiplying them by `damping`, in [0, 1].
  void updateVelocity(const Vector<S>& gravity, S damping, S dt);

  /// (m v^2 + I w^2) / 2, J, saturated. MIS: bodyKineticEnergy
  S kineticEnergy() const;

  /// Bias velocity: what the solver adds only to push overlapping shapes apart, m/s and rad/s.
  const Vector<S>& velocityBias() const { return velocityBias_; }
  S angularVelocityBias() const { return angularVelocityBias_; }

  /// Values that were clamped to their limits, as bits.
  enum Held : std::uint8_t { kHeldNothing = 0, kHeldSpeed = 1, kHeldSpin = 2, kHeldAtBorder = 4 };

  /// Every field of the state, by name, in the order of the canonical encoding.
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("type", self.type_);
    visit("rotates", self.rotates_);
    visit("mass", self.mass_);
    visit("moment", self.moment_);
    visit("centerOfMass", self.centerOfMass_);
    visit("center", self.center_);
    visit("velocity", self.velocity_);
    visit("force", self.force_);
    visit("angle", self.angle_);
    visit("angularVelocity", self.angularVelocity_);
    visit("torque", self.torque_);
    visit("velocityBias", self.velocityBias_);
    visit("angularVelocityBias", self.angularVelocityBias_);
    visit("positionFunc", self.positionFunc_);
    visit("velocityFunc", self.velocityFunc_);
    visit("userData", self.userData_);
    visit("gravityScale", self.gravityScale_);
    visit("linearDamping", self.linearDamping_);
    visit("angularDamping", self.angularDamping_);
    visit("speedLimit", self.speedLimit_);
    visit("spinLimit", self.spinLimit_);
    visit("restTime", self.restTime_);
    visit("island", self.island_);
    visit("activity", self.activity_);
    visit("maySleep", self.maySleep_);
    visit("bullet", self.bullet_);
  }
  /// Computes what follows from the fields.
  void derive();
  /// True if the record could have been made by the functions of this library: for what was read from
  /// outside.
  bool wellFormed() const;

 private:
  friend struct BodyAccess<S>;

  /// Notes a change that whoever rests on the body, or it itself, may have to answer to.
  void rouse() {
    // Its own function's changes in a step are its motion.
    if (stepping_ != 0) return;
    restTime_ = S(0);
    if (activity_ == Activity::asleep) activity_ = Activity::roused;
  }
  /// Sets a field; what was so already wakes nobody.
  /// @param counts  false where it is nothing to a body of this type
  template <class T>
  void put(T& field, const T& value, bool counts = true) {
    const bool same = field == value;
    // Zeros of two signs are equal, and not the same.
    field = value;
    if (!same && counts) rouse();
  }

  struct Motion {
    Vector<S> velocity;
    S angularVelocity;
  };
  /// Change of the velocities by an impulse at a world point; none where the body is not dynamic.
  Motion pushed(const Vector<S>& impulse, const Vector<S>& worldPoint) const;
  /// The velocities after gravity, force and torque, unchecked.
  Motion accelerated(const Vector<S>& gravity, S damping, S dt) const;
  /// The velocities that its own damping leaves of what it has.
  Motion damped(S dt) const;
  /// True if its damping and limits are within their ranges.
  bool movesWell() const;
  /// Velocities within the body's own limits.
  Motion limited(const Motion& motion) const;
  /// Acceleration by gravity, force and torque, per second.
  Motion acceleration(const Vector<S>& gravity) const;
  /// True if what it says of its rest may be.
  bool restsWell() const;
  /// Moves the centre of mass within the body, whose material moves on as before.
  void moveCenter(const Vector<S>& center);
  /// Computes what follows from type, mass and moment.
  void deriveMass();
  /// Makes the mass of a body that is not dynamic be summed over its shapes when it becomes so.
  void forgetMass();
  void forgetBias();
  /// Reason why the body cannot be stepped, or nullptr.
  const char* cannotStep() const;
  /// Takes the velocities, held at the limits; says what was held.
  std::uint8_t holdVelocity(const Motion& motion);
  /// Lets updatePosition and updateVelocity clamp what leaves its range, and note it, instead of throwing,
  /// while it lives: for the functions a step calls.
  class WithinStep {
   public:
    WithinStep(Body& body, std::uint8_t& held) : body_(body), held_(held) {
      body_.stepping_ = 1;
      body_.held_ = 0;
    }
    ~WithinStep() {
      body_.stepping_ = 0;
      held_ |= body_.held_;
    }
    WithinStep(const WithinStep&) = delete;
    WithinStep& operator=(const WithinStep&) = delete;

   private:
    Body& body_;
    std::uint8_t& held_;
  };
  /// Moves, held within `extent` metres of the origin; says what was held.
  std::uint8_t holdPosition(S dt, S extent);
  std::uint8_t holdMoved(const Vector<S>& by, S angle, S extent);

  // State.
  Vector<S> center_{};
  Vector<S> velocity_{};
  Vector<S> velocityBias_{};
  S angle_{};
  S angularVelocity_{};
  S angularVelocityBias_{};
  Vector<S> force_{};
  S torque_{};
  S mass_{};
  Scaled<S> moment_{};
  Vector<S> centerOfMass_{};
  S gravityScale_{1};
  S linearDamping_{};
  S angularDamping_{};
  S speedLimit_ = kMaxSpeed<S>;
  S spinLimit_ = kMaxAngularSpeed<S>;
  std::uint64_t userData_ = 0;
  CallbackNumber positionFunc_ = 0;
  CallbackNumber velocityFunc_ = 0;
  S restTime_{};
  std::uint32_t island_ = 0;
  Activity activity_ = Activity::awake;
  std::uint8_t maySleep_ = 1;
  std::uint8_t bullet_ = 0;
  std::uint8_t unused_ = 0;
  // Follows from the state.
  Vector<S> rotation_{S(1), S(0)};
  Scaled<S> inverseMass_{};
  Scaled<S> inverseMoment_{};
  S momentPerMass_{};
  // The Space gives its own number, the slot and how far from the origin the body may be set; none of them is
  // part of the state.
  S extent_ = kMaxWorldExtent<S>;
  BodyId id_{};
  BodyType type_ = BodyType::dynamicBody;
  std::uint8_t rotates_ = 1;
  // This is 1 during a call from within a step.
  std::uint8_t stepping_ = 0;
  std::uint8_t held_ = 0;
};

#define SAMESTEP_EACH_SCALAR extern template class Body<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
