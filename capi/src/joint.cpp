// SPDX-License-Identifier: MIT
// Joints.
#include "base/require_ieee.h"
#include "definitions.h"

namespace samestep::c {
namespace {

JointId jointId(samestep_joint_id id) { return fromC<JointId>(id); }

template <Scalar S>
const Joint<S>& jointOf(const WorldOf<S>& world, samestep_joint_id id) {
  return std::as_const(world.space).joint(jointId(id));
}

std::uint8_t toSwitch(std::int32_t x) { return x != 0 ? 1 : 0; }

/// Calls put(number of the definition, field of the joint) for each plain number.
template <class Def, class Made, class Put>
void eachNumber(Def& def, Made& joint, Put&& put) {
  put(def.rest, joint.rest);
  put(def.angle, joint.angle);
  put(def.lower, joint.lower);
  put(def.upper, joint.upper);
  put(def.motor_speed, joint.motorSpeed);
  put(def.motor_max, joint.motorMax);
  put(def.hertz, joint.hertz);
  put(def.damping, joint.damping);
  put(def.angular_hertz, joint.angularHertz);
  put(def.angular_damping, joint.angularDamping);
  put(def.max_force, joint.maxForce);
  put(def.max_torque, joint.maxTorque);
  put(def.break_force, joint.breakForce);
  put(def.break_torque, joint.breakTorque);
  put(def.ratio, joint.ratio);
}

}  // namespace

template <Scalar S>
Joint<S> toJoint(const samestep_joint_def& from) {
  requireOr(from.kind >= SAMESTEP_REVOLUTE && from.kind <= SAMESTEP_RATCHET, SAMESTEP_UNKNOWN_VALUE);
  Joint<S> joint;
  joint.kind = static_cast<JointKind>(from.kind);
  joint.bodyA = fromC<BodyId>(from.body_a);
  joint.bodyB = fromC<BodyId>(from.body_b);
  joint.userData = from.user_data;
  joint.anchorA = vector<S>(from.anchor_a);
  joint.anchorB = vector<S>(from.anchor_b);
  joint.axis = vector<S>(from.axis);
  joint.velocity = vector<S>(from.velocity);
  eachNumber(from, joint, [](double given, S& field) { field = number<S>(given); });
  joint.limited = toSwitch(from.limited);
  joint.motor = toSwitch(from.motor);
  joint.spring = toSwitch(from.spring);
  joint.collideConnected = toSwitch(from.collide_connected);
  return joint;
}

template <Scalar S>
samestep_joint_def toC(JointId id, const Joint<S>& from) {
  samestep_joint_def def;
  samestep_joint_def_init(&def);
  def.kind = static_cast<std::int32_t>(from.kind);
  def.id = toC(id);
  def.body_a = toC(from.bodyA);
  def.body_b = toC(from.bodyB);
  def.user_data = from.userData;
  def.anchor_a = toVec2(from.anchorA);
  def.anchor_b = toVec2(from.anchorB);
  def.axis = toVec2(from.axis);
  def.velocity = toVec2(from.velocity);
  eachNumber(def, from, [](double& to, S field) { to = toDouble(field); });
  def.limited = from.limited;
  def.motor = from.motor;
  def.spring = from.spring;
  def.collide_connected = from.collideConnected;
  return def;
}

#ifndef SAMESTEP_FIXED_ONLY
template Joint<double> toJoint<double>(const samestep_joint_def&);
template samestep_joint_def toC<double>(JointId, const Joint<double>&);
#endif
template Joint<Fixed> toJoint<Fixed>(const samestep_joint_def&);
template samestep_joint_def toC<Fixed>(JointId, const Joint<Fixed>&);

}  // namespace samestep::c

using namespace samestep::c;

extern "C" {

samestep_status samestep_joint_create(samestep_world* world, const samestep_joint_def* def,
                                      samestep_joint_id* joint) {
  return call(world, [&]<class World>(World& of) {
    at(joint);
    const auto made = toJoint<typename World::Number>(current(def));
    *joint = toC(def->id == 0 ? of.space.add(made) : of.space.add(made, jointId(def->id)));
  });
}

samestep_status samestep_joint_destroy(samestep_world* world, samestep_joint_id joint) {
  return call(world, [&](auto& of) { of.space.remove(jointId(joint)); });
}

samestep_status samestep_joint_exists(const samestep_world* world, samestep_joint_id joint, int32_t* exists) {
  return call(world, [&](auto& of) { at(exists) = of.space.contains(jointId(joint)) ? 1 : 0; });
}

samestep_status samestep_joint_replace(samestep_world* world, samestep_joint_id joint,
                                       const samestep_joint_def* def) {
  return call(world, [&]<class World>(World& of) {
    of.space.replace(jointId(joint), toJoint<typename World::Number>(current(def)));
  });
}

samestep_status samestep_joint_get(const samestep_world* world, samestep_joint_id joint,
                                   samestep_joint_def* def) {
  return call(world, [&](auto& of) { at(def) = toC(jointId(joint), jointOf(of, joint)); });
}

samestep_status samestep_joint_get_state(const samestep_world* world, samestep_joint_id joint,
                                         samestep_joint_state* state) {
  return call(world, [&](auto& of) {
    const auto& found = jointOf(of, joint);
    at(state) = {toVec2(found.force), toDouble(found.torque)};
  });
}

samestep_status samestep_world_get_joint_count(const samestep_world* world, uint32_t* count) {
  return call(world, [&](auto& of) { at(count) = of.space.jointCount(); });
}

samestep_status samestep_body_get_joints(samestep_world* world, samestep_body_id body,
                                         const samestep_joint_id** joints, size_t* count) {
  return call(world, [&](auto& of) {
    at(joints), at(count);
    of.joints.clear();
    of.space.eachJoint(fromC<samestep::BodyId>(body),
                       [&](samestep::JointId id, const auto&) { of.joints.push_back(toC(id)); });
    give(of.joints, joints, count);
  });
}

samestep_status samestep_body_get_connected(samestep_world* world, samestep_body_id body,
                                            const samestep_body_id** bodies, size_t* count) {
  return call(world, [&](auto& of) {
    at(bodies), at(count);
    of.connected.clear();
    of.space.eachConnected(fromC<samestep::BodyId>(body),
                           [&](samestep::BodyId id) { of.connected.push_back(toC(id)); });
    give(of.connected, bodies, count);
  });
}

}  // extern "C"
