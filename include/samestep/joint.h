// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/id.h>
#include <samestep/limits.h>
#include <samestep/vector.h>

namespace samestep {

/// Kinds of joints. Which fields of a Joint count for which kind is a table in docs/joints.md.
enum class JointKind : std::uint8_t {
  revolute = 0,   ///< A point of A on a point of B, which turn about it: a hinge.
  prismatic = 1,  ///< B slides along an axis of A and does not turn against it.
  distance = 2,   ///< Distance of a point of B from one of A: a rod, a rope, a spring.
  weld = 3,       ///< B does not move against A: stiff, or as two springs.
  wheel = 4,      ///< A point of B slides along an axis of A, and B turns: a suspension, a pin in a groove.
  target = 5,   ///< Pulls a point of B to a point of A, with a greatest force and torque: a mouse, friction.
  gear = 6,     ///< Angle of B against A, by a ratio: a gear, a rotary spring, limit or motor.
  ratchet = 7,  ///< B turns against A in one direction only.
};

/// The impulses that a joint keeps from one substep to the next, with which it begins: of a force as the
/// speed in m/s that it gives the lighter body, of a torque as the spin in rad/s that it gives the one of
/// less moment.
template <Scalar S>
struct JointImpulses {
  /// On B: of a point held in x and y of the world; of an axis along it (x) and across it (y).
  Vector<S> linear{};
  /// Impulse that holds the angle.
  S angular{};
  S spring{}, motor{};
  /// Impulses of the limits, no less than 0, which keep B from less than the lower, and from more than the
  /// upper.
  S lower{}, upper{};

  friend constexpr bool operator==(const JointImpulses&, const JointImpulses&) = default;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("linear", self.linear);
    visit("angular", self.angular);
    visit("spring", self.spring);
    visit("motor", self.motor);
    visit("lower", self.lower);
    visit("upper", self.upper);
  }
};

/// A joint of two bodies: one record for all kinds. Points and the axis are in the coordinates of the body
/// they are on, from its origin. Space::add checks all of it. Forces act for a whole step: B is pushed, A is
/// pushed back. A coordinate of a joint is an angle, a translation along the axis or a distance, by its kind.
template <Scalar S>
struct Joint {
  BodyId bodyA{};
  BodyId bodyB{};
  /// Anchors, each within 2^10 m of the origin of its body along either axis.
  Vector<S> anchorA{};
  Vector<S> anchorB{};
  /// Axis of A along which B slides, a unit vector to 2^-10.
  Vector<S> axis{S(1), S(0)};
  /// Velocity of B against A at the anchors that a target without a spring aims at, in A's axes, m/s; each
  /// component within 2^10.
  Vector<S> velocity{};
  /// Where the spring rests; of a distance without spring, limits and motor what it holds; of a ratchet how
  /// far its teeth are apart, above 0. m or rad, within 2^20.
  S rest{};
  /// B's angle against A's at which the angle of the joint is 0; a phase of gears and ratchets. rad, 2^20.
  S angle{};
  /// The limits of the coordinate where `limited`, lower <= upper: m or rad, of any width within 2^20.
  S lower{};
  S upper{};
  /// Speed that the motor aims at, m/s within 2^10 or rad/s within 2^8; also the spin of a target.
  S motorSpeed{};
  /// The greatest force or torque of the motor, N or N m, 0 to 2^30; 0 does nothing.
  S motorMax{};
  /// Cycles per second, 0 to 1000, and damping ratio, 0 to 100, of the spring, of a weld's or target's pull
  /// at the anchors; 0 hertz of a weld are stiff, of a target mean a velocity.
  S hertz{};
  S damping{1};
  /// Frequency and damping ratio of the angle of a weld or target.
  S angularHertz{};
  S angularDamping{1};
  /// The greatest force and torque with which the joint holds what it holds, N and N m, 0 to 2^30; 0: any,
  /// but of a target none.
  S maxForce{};
  S maxTorque{};
  /// Force and torque, as the mean of a step, above which the joint breaks: it is removed at the end of that
  /// step and listed. N and N m, 0 to 2^30; 0: never.
  S breakForce{};
  S breakTorque{};
  /// Ratio of a gear: B's angle times this, less A's, is its coordinate. 2^-8 to 2^8 in size, of either sign.
  S ratio{1};
  std::uint64_t userData = 0;
  /// State of a ratchet, which the Space sets: how far it has come, rad.
  S latch{};
  /// State, which the Space sets.
  JointImpulses<S> kept{};
  /// Force and torque on B as means of the last step, N in the world and N m. A result and no state: 0
  /// until the joint's first step, and after a restore or load until the next one.
  Vector<S> force{};
  S torque{};
  JointKind kind = JointKind::revolute;
  // Each 0 or 1.
  std::uint8_t limited = 0;
  std::uint8_t motor = 0;
  std::uint8_t spring = 0;
  /// 1 where shapes of the two bodies collide with each other.
  std::uint8_t collideConnected = 0;
  /// Limits that hold since the last step and did not before: a result.
  std::uint8_t reached = kReachedNothing;
  std::uint8_t unused[2] = {};

  /// Bits of `reached`.
  enum Reached : std::uint8_t { kReachedNothing = 0, kReachedLower = 1, kReachedUpper = 2 };

  /// Every field of the state, by name, in the order of the canonical encoding.
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("kind", self.kind);
    visit("limited", self.limited);
    visit("motor", self.motor);
    visit("spring", self.spring);
    visit("collideConnected", self.collideConnected);
    visit("bodyA", self.bodyA);
    visit("bodyB", self.bodyB);
    visit("anchorA", self.anchorA);
    visit("anchorB", self.anchorB);
    visit("axis", self.axis);
    visit("velocity", self.velocity);
    visit("rest", self.rest);
    visit("angle", self.angle);
    visit("lower", self.lower);
    visit("upper", self.upper);
    visit("motorSpeed", self.motorSpeed);
    visit("motorMax", self.motorMax);
    visit("hertz", self.hertz);
    visit("damping", self.damping);
    visit("angularHertz", self.angularHertz);
    visit("angularDamping", self.angularDamping);
    visit("maxForce", self.maxForce);
    visit("maxTorque", self.maxTorque);
    visit("breakForce", self.breakForce);
    visit("breakTorque", self.breakTorque);
    visit("ratio", self.ratio);
    visit("userData", self.userData);
    visit("latch", self.latch);
    visit("kept", self.kept);
  }
};

/// Forgets the results of the last step.
template <Scalar S>
void forgetResults(Joint<S>& joint) {
  joint.force = {};
  joint.torque = S(0);
  joint.reached = 0;
}

/// Bounds of the coordinates of anchors, m, and of lengths and angles of joints, m and rad.
template <Scalar S>
inline constexpr S kMaxAnchor = S(1 << 10);
template <Scalar S>
inline constexpr S kMaxJointCoordinate = S(1 << 20);
/// Bound of the ratio of a gear, and of its inverse.
inline constexpr int kMaxGearRatio = 1 << 8;

/// Checks a record, whatever its bodies are.
/// @return null, or the field that is out of range, and what is allowed
template <Scalar S>
const char* flawOfJoint(const Joint<S>& joint);

// The joints of Chipmunk and Box2D, each by one of ours. Anchors are in the coordinates of their bodies.

/// Box2D's revolute, Chipmunk's pivot.
template <Scalar S>
Joint<S> revoluteJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB);
/// Box2D's prismatic: B slides along an axis of A.
template <Scalar S>
Joint<S> prismaticJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB,
                        const Vector<S>& axis);
/// Box2D's distance, Chipmunk's pin.
template <Scalar S>
Joint<S> distanceJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB, S length);
/// Chipmunk's slide: no nearer than `least`, no farther than `most`; a rope from 0 on.
template <Scalar S>
Joint<S> ropeJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB, S least, S most);
/// Box2D's distance with a spring, Chipmunk's damped spring.
template <Scalar S>
Joint<S> springJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB, S length,
                     S hertz, S damping);
/// Box2D's weld: B's angle stays at `angle` against A's.
template <Scalar S>
Joint<S> weldJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB, S angle);
/// Box2D's wheel: B's anchor slides along an axis of A, on a spring that rests at the anchor of A.
template <Scalar S>
Joint<S> wheelJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB,
                    const Vector<S>& axis, S hertz, S damping);
/// Chipmunk's groove: B's anchor slides on a segment of A.
/// @pre the ends are not the same place
template <Scalar S>
Joint<S> grooveJoint(BodyId a, BodyId b, const Vector<S>& start, const Vector<S>& end,
                     const Vector<S>& anchorB);
/// Box2D's mouse: pulls B's anchor to a point of A.
template <Scalar S>
Joint<S> targetJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB, S hertz,
                     S damping, S maxForce);
/// Box2D's friction: slows B against A, as on a table seen from above.
template <Scalar S>
Joint<S> frictionJoint(BodyId a, BodyId b, S maxForce, S maxTorque);
/// Chipmunk's and Box2D's gear: B's angle times the ratio, less A's, stays at `phase`.
template <Scalar S>
Joint<S> gearJoint(BodyId a, BodyId b, S phase, S ratio);
/// Chipmunk's damped rotary spring.
template <Scalar S>
Joint<S> rotarySpringJoint(BodyId a, BodyId b, S angle, S hertz, S damping);
/// Chipmunk's rotary limit.
template <Scalar S>
Joint<S> rotaryLimitJoint(BodyId a, BodyId b, S least, S most);
/// Chipmunk's simple motor: B turns against A.
template <Scalar S>
Joint<S> motorJoint(BodyId a, BodyId b, S speed, S maxTorque);
/// Chipmunk's ratchet: B turns against A forward only, from tooth to tooth; backward where `tooth` is below
/// 0.
template <Scalar S>
Joint<S> ratchetJoint(BodyId a, BodyId b, S phase, S tooth);

}  // namespace samestep
