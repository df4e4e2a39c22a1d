// SPDX-License-Identifier: MIT
#include <samestep/joint.h>

#include <samestep/math.h>

#include "base/require_ieee.h"
#include "joints/joint_limits.h"

namespace samestep {
namespace {

template <Scalar S>
bool in(S value, S low, S high) {
  return value >= low && value <= high;
}

template <Scalar S>
const char* flawOfPlaces(const Joint<S>& joint) {
  const S far = kMaxJointCoordinate<S>;
  if (!within(joint.anchorA, kMaxAnchor<S>)) return "anchorA is out of range, allowed are -1024 to 1024 m";
  if (!within(joint.anchorB, kMaxAnchor<S>)) return "anchorB is out of range, allowed are -1024 to 1024 m";
  const bool near = within(joint.axis, S(2));
  const S unit = near ? lengthSq(joint.axis) : S(0);
  if (!in(unit, ratio<S>(1022, 1024), ratio<S>(1026, 1024))) return "axis is no unit vector";
  if (!within(joint.velocity, kMaxSpeed<S>)) return "velocity is out of range, allowed are -1024 to 1024 m/s";
  if (!within(joint.rest, far)) return "rest is out of range, allowed are -2^20 to 2^20";
  if (!within(joint.angle, far)) return "angle is out of range, allowed are -2^20 to 2^20 rad";
  if (!within(joint.lower, far) || !within(joint.upper, far)) {
    return "a limit is out of range, allowed are -2^20 to 2^20";
  }
  return joint.lower <= joint.upper ? nullptr : "the lower limit is above the upper one";
}

template <Scalar S>
const char* flawOfPulls(const Joint<S>& joint) {
  const S most = kMaxForce<S>;
  if (!within(joint.motorSpeed, mostMotorSpeed(joint))) {
    return "motorSpeed is out of range, allowed are -1024 to 1024 m/s or -256 to 256 rad/s";
  }
  if (!in(joint.motorMax, S(0), most)) return "motorMax is out of range, allowed are 0 to 2^30";
  if (!in(joint.hertz, S(0), S(1000)) || !in(joint.angularHertz, S(0), S(1000))) {
    return "hertz are out of range, allowed are 0 to 1000";
  }
  if (!in(joint.damping, S(0), S(100)) || !in(joint.angularDamping, S(0), S(100))) {
    return "damping is out of range, allowed are 0 to 100";
  }
  if (!in(joint.maxForce, S(0), most) || !in(joint.maxTorque, S(0), most)) {
    return "a greatest force or torque is out of range, allowed are 0 to 2^30";
  }
  const bool breaks = in(joint.breakForce, S(0), most) && in(joint.breakTorque, S(0), most);
  return breaks ? nullptr : "a force or torque that breaks it is out of range, allowed are 0 to 2^30";
}

/// Checks fields that only some kinds have.
template <Scalar S>
const char* flawOfKind(const Joint<S>& joint) {
  const S ratioSize = abs(joint.ratio);
  if (!in(ratioSize, ratio<S>(1, kMaxGearRatio), S(kMaxGearRatio))) {
    return "ratio is out of range, allowed are 2^-8 to 2^8 in size";
  }
  if (joint.kind == JointKind::distance && !(joint.rest >= S(0) && joint.lower >= S(0))) {
    return "a distance is below 0";
  }
  const S leastTooth = ratio<S>(1, 1 << 16);
  if (joint.kind == JointKind::ratchet && !(abs(joint.rest) >= leastTooth)) {
    return "rest is out of range: teeth of a ratchet are at least 2^-16 rad apart";
  }
  return nullptr;
}

template <Scalar S>
const char* flawOfKept(const Joint<S>& joint) {
  const JointImpulses<S>& kept = joint.kept;
  const S most = kMostKept<S>;
  const bool good = within(kept.linear, most) && within(kept.angular, most) && within(kept.spring, most) &&
                    within(kept.motor, most) && in(kept.lower, S(0), most) && in(kept.upper, S(0), most) &&
                    within(joint.latch, kMaxAngle<S>);
  return good ? nullptr : "an impulse is out of range";
}

template <Scalar S>
Joint<S> jointOf(JointKind kind, BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB) {
  Joint<S> joint;
  joint.kind = kind;
  joint.bodyA = a;
  joint.bodyB = b;
  joint.anchorA = anchorA;
  joint.anchorB = anchorB;
  return joint;
}

}  // namespace

template <Scalar S>
const char* flawOfJoint(const Joint<S>& joint) {
  const bool known = joint.kind <= JointKind::ratchet && joint.limited <= 1 && joint.motor <= 1 &&
                     joint.spring <= 1 && joint.collideConnected <= 1;
  if (!known) return "kind or a switch has a value that names nothing";
  if (const char* flaw = flawOfPlaces(joint)) return flaw;
  if (const char* flaw = flawOfPulls(joint)) return flaw;
  if (const char* flaw = flawOfKind(joint)) return flaw;
  return flawOfKept(joint);
}

template <Scalar S>
Joint<S> revoluteJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB) {
  return jointOf(JointKind::revolute, a, b, anchorA, anchorB);
}

template <Scalar S>
Joint<S> prismaticJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB,
                        const Vector<S>& axis) {
  Joint<S> joint = jointOf(JointKind::prismatic, a, b, anchorA, anchorB);
  joint.axis = axis;
  return joint;
}

template <Scalar S>
Joint<S> distanceJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB, S length) {
  Joint<S> joint = jointOf(JointKind::distance, a, b, anchorA, anchorB);
  joint.rest = length;
  return joint;
}

template <Scalar S>
Joint<S> ropeJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB, S least, S most) {
  Joint<S> joint = distanceJoint(a, b, anchorA, anchorB, most);
  joint.limited = 1;
  joint.lower = least;
  joint.upper = most;
  return joint;
}

template <Scalar S>
Joint<S> springJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB, S length,
                     S hertz, S damping) {
  Joint<S> joint = distanceJoint(a, b, anchorA, anchorB, length);
  joint.spring = 1;
  joint.hertz = hertz;
  joint.damping = damping;
  return joint;
}

template <Scalar S>
Joint<S> weldJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB, S angle) {
  Joint<S> joint = jointOf(JointKind::weld, a, b, anchorA, anchorB);
  joint.angle = angle;
  return joint;
}

template <Scalar S>
Joint<S> wheelJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB,
                    const Vector<S>& axis, S hertz, S damping) {
  Joint<S> joint = jointOf(JointKind::wheel, a, b, anchorA, anchorB);
  joint.axis = axis;
  joint.spring = 1;
  joint.hertz = hertz;
  joint.damping = damping;
  return joint;
}

template <Scalar S>
Joint<S> grooveJoint(BodyId a, BodyId b, const Vector<S>& start, const Vector<S>& end,
                     const Vector<S>& anchorB) {
  Joint<S> joint = jointOf(JointKind::wheel, a, b, start, anchorB);
  joint.axis = normalize(end - start);
  joint.limited = 1;
  joint.upper = length(end - start);
  joint.collideConnected = 1;
  return joint;
}

template <Scalar S>
Joint<S> targetJoint(BodyId a, BodyId b, const Vector<S>& anchorA, const Vector<S>& anchorB, S hertz,
                     S damping, S maxForce) {
  Joint<S> joint = jointOf(JointKind::target, a, b, anchorA, anchorB);
  joint.hertz = hertz;
  joint.damping = damping;
  joint.maxForce = maxForce;
  joint.collideConnected = 1;
  return joint;
}

template <Scalar S>
Joint<S> frictionJoint(BodyId a, BodyId b, S maxForce, S maxTorque) {
  Joint<S> joint = targetJoint<S>(a, b, {}, {}, S(0), S(1), maxForce);
  joint.maxTorque = maxTorque;
  return joint;
}

template <Scalar S>
Joint<S> gearJoint(BodyId a, BodyId b, S phase, S ratio) {
  Joint<S> joint = jointOf<S>(JointKind::gear, a, b, {}, {});
  joint.angle = phase;
  joint.ratio = ratio;
  joint.collideConnected = 1;
  return joint;
}

template <Scalar S>
Joint<S> rotarySpringJoint(BodyId a, BodyId b, S angle, S hertz, S damping) {
  Joint<S> joint = gearJoint(a, b, S(0), S(1));
  joint.spring = 1;
  joint.rest = angle;
  joint.hertz = hertz;
  joint.damping = damping;
  return joint;
}

template <Scalar S>
Joint<S> rotaryLimitJoint(BodyId a, BodyId b, S least, S most) {
  Joint<S> joint = gearJoint(a, b, S(0), S(1));
  joint.limited = 1;
  joint.lower = least;
  joint.upper = most;
  return joint;
}

template <Scalar S>
Joint<S> motorJoint(BodyId a, BodyId b, S speed, S maxTorque) {
  Joint<S> joint = gearJoint(a, b, S(0), S(1));
  joint.motor = 1;
  joint.motorSpeed = speed;
  joint.motorMax = maxTorque;
  return joint;
}

template <Scalar S>
Joint<S> ratchetJoint(BodyId a, BodyId b, S phase, S tooth) {
  Joint<S> joint = jointOf<S>(JointKind::ratchet, a, b, {}, {});
  joint.angle = phase;
  joint.rest = tooth;
  joint.collideConnected = 1;
  return joint;
}

#define SAMESTEP_EACH_SCALAR                                                                                 \
  template const char* flawOfJoint<S>(const Joint<S>&);                                                      \
  template Joint<S> revoluteJoint<S>(BodyId, BodyId, const Vector<S>&, const Vector<S>&);                    \
  template Joint<S> prismaticJoint<S>(BodyId, BodyId, const Vector<S>&, const Vector<S>&, const Vector<S>&); \
  template Joint<S> distanceJoint<S>(BodyId, BodyId, const Vector<S>&, const Vector<S>&, S);                 \
  template Joint<S> ropeJoint<S>(BodyId, BodyId, const Vector<S>&, const Vector<S>&, S, S);                  \
  template Joint<S> springJoint<S>(BodyId, BodyId, const Vector<S>&, const Vector<S>&, S, S, S);             \
  template Joint<S> weldJoint<S>(BodyId, BodyId, const Vector<S>&, const Vector<S>&, S);                     \
  template Joint<S> wheelJoint<S>(BodyId, BodyId, const Vector<S>&, const Vector<S>&, const Vector<S>&, S,   \
                                  S);                                                                        \
  template Joint<S> grooveJoint<S>(BodyId, BodyId, const Vector<S>&, const Vector<S>&, const Vector<S>&);    \
  template Joint<S> targetJoint<S>(BodyId, BodyId, const Vector<S>&, const Vector<S>&, S, S, S);             \
  template Joint<S> frictionJoint<S>(BodyId, BodyId, S, S);                                                  \
  template Joint<S> gearJoint<S>(BodyId, BodyId, S, S);                                                      \
  template Joint<S> rotarySpringJoint<S>(BodyId, BodyId, S, S, S);                                           \
  template Joint<S> rotaryLimitJoint<S>(BodyId, BodyId, S, S);                                               \
  template Joint<S> motorJoint<S>(BodyId, BodyId, S, S);                                                     \
  template Joint<S> ratchetJoint<S>(BodyId, BodyId, S, S);
#include <samestep/each_scalar.h>

}  // namespace samestep
