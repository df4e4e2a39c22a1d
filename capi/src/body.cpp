// SPDX-License-Identifier: MIT
// Bodies.
#include "base/require_ieee.h"
#include "definitions.h"

namespace samestep::c {
namespace {

BodyId bodyId(samestep_body_id id) { return fromC<BodyId>(id); }

template <Scalar S>
const Body<S>& bodyOf(const WorldOf<S>& world, samestep_body_id id) {
  return std::as_const(world.space).body(bodyId(id));
}

template <Scalar S>
samestep_body_state stateOf(const Body<S>& body) {
  samestep_body_state state{};
  state.id = toC(body.id());
  state.user_data = body.userData();
  state.position = toVec2(body.position());
  state.rotation = toVec2(body.rotation());
  state.angle = toDouble(body.angle());
  state.center_of_mass = toVec2(body.centerOfMass());
  state.world_center = toVec2(body.worldCenter());
  state.velocity = toVec2(body.velocity());
  state.angular_velocity = toDouble(body.angularVelocity());
  state.force = toVec2(body.force());
  state.torque = toDouble(body.torque());
  state.mass = toDouble(body.mass());
  state.moment = toDouble(body.moment());
  state.kinetic_energy = toDouble(body.kineticEnergy());
  state.type = static_cast<std::int32_t>(body.type());
  state.rotates = body.rotates() ? 1 : 0;
  state.position_function = body.positionFunc();
  state.velocity_function = body.velocityFunc();
  state.sleeps = body.isSleeping() ? 1 : 0;
  state.may_sleep = body.maySleep() ? 1 : 0;
  state.gravity_scale = toDouble(body.gravityScale());
  state.linear_damping = toDouble(body.linearDamping());
  state.angular_damping = toDouble(body.angularDamping());
  state.speed_limit = toDouble(body.speedLimit());
  state.spin_limit = toDouble(body.spinLimit());
  state.bullet = body.bullet() ? 1 : 0;
  return state;
}

template <Scalar S>
Vector<S> rawVector(const std::int64_t raw[2]) {
  return {fromRaw<S>(raw[0]), fromRaw<S>(raw[1])};
}

template <Scalar S>
Vector<S> rawQuantity(const Body<S>& body, std::int32_t quantity) {
  switch (quantity) {
    case SAMESTEP_RAW_POSITION:
      return body.position();
    case SAMESTEP_RAW_ANGLE:
      return {body.angle(), S(0)};
    case SAMESTEP_RAW_ROTATION:
      return body.rotation();
    case SAMESTEP_RAW_VELOCITY:
      return body.velocity();
    case SAMESTEP_RAW_ANGULAR_VELOCITY:
      return {body.angularVelocity(), S(0)};
    case SAMESTEP_RAW_FORCE:
      return body.force();
    case SAMESTEP_RAW_TORQUE:
      return {body.torque(), S(0)};
    case SAMESTEP_RAW_MASS:
      return {body.mass(), S(0)};
    case SAMESTEP_RAW_MOMENT:
      return {body.moment(), S(0)};
    case SAMESTEP_RAW_CENTER_OF_MASS:
      return body.centerOfMass();
    case SAMESTEP_RAW_WORLD_CENTER:
      return body.worldCenter();
    default:
      refuse(SAMESTEP_UNKNOWN_VALUE);
  }
}

template <Scalar S>
void setRawQuantity(Body<S>& body, std::int32_t quantity, const Vector<S>& value) {
  switch (quantity) {
    case SAMESTEP_RAW_POSITION:
      return body.setPosition(value);
    case SAMESTEP_RAW_ANGLE:
      return body.setAngle(value.x);
    case SAMESTEP_RAW_VELOCITY:
      return body.setVelocity(value);
    case SAMESTEP_RAW_ANGULAR_VELOCITY:
      return body.setAngularVelocity(value.x);
    case SAMESTEP_RAW_FORCE:
      return body.setForce(value);
    case SAMESTEP_RAW_TORQUE:
      return body.setTorque(value.x);
    case SAMESTEP_RAW_MASS:
      return body.setMass(value.x);
    case SAMESTEP_RAW_MOMENT:
      return body.setMoment(value.x);
    case SAMESTEP_RAW_CENTER_OF_MASS:
      return body.setCenterOfMass(value);
    default:
      refuse(SAMESTEP_UNKNOWN_VALUE);
  }
}

/// Runs action(body, a number of its scalar's type) on a body that it may change.
template <class Action>
samestep_status change(samestep_world* world, samestep_body_id body, Action&& action) noexcept {
  return call(world,
              [&]<class World>(World& of) { action(of.space.body(bodyId(body)), typename World::Number()); });
}

/// Updates the velocity; what a velocity function gets for `damping` and `seconds` is checked by the body.
template <Scalar S>
void updateVelocity(Body<S>& body, const Vector<S>& gravity, S damping, S seconds) {
  body.updateVelocity(gravity, damping, seconds);
}

}  // namespace
}  // namespace samestep::c

using namespace samestep::c;

extern "C" {

samestep_status samestep_body_create(samestep_world* world, const samestep_body_def* def,
                                     samestep_body_id* body) {
  return call(world, [&]<class World>(World& of) {
    at(body);
    const auto made = toBody<typename World::Number>(current(def));
    *body = toC(def->id == 0 ? of.space.add(made) : of.space.add(made, bodyId(def->id)));
  });
}

samestep_status samestep_body_destroy(samestep_world* world, samestep_body_id body) {
  return call(world, [&](auto& of) { of.space.removeWithShapes(bodyId(body)); });
}

samestep_status samestep_world_get_static_body(const samestep_world* world, samestep_body_id* body) {
  return call(world, [&](auto& of) { at(body) = toC(of.space.staticBody()); });
}

samestep_status samestep_body_exists(const samestep_world* world, samestep_body_id body, int32_t* exists) {
  return call(world, [&](auto& of) { at(exists) = of.space.contains(bodyId(body)) ? 1 : 0; });
}

samestep_status samestep_world_get_poses(samestep_world* world, const samestep_pose** poses, size_t* count) {
  return call(world, [&](auto& of) {
    at(poses), at(count);
    of.poses.clear();
    std::as_const(of.space).eachBody([&](const auto& body) {
      of.poses.push_back({toC(body.id()), toVec2(body.position()), toVec2(body.rotation())});
    });
    give(of.poses, poses, count);
  });
}

samestep_status samestep_body_get(const samestep_world* world, samestep_body_id body,
                                  samestep_body_state* state) {
  return call(world, [&](auto& of) { at(state) = stateOf(bodyOf(of, body)); });
}

samestep_status samestep_body_set_position(samestep_world* world, samestep_body_id body, double x, double y) {
  return change(world, body, [&]<class S>(auto& of, S) { of.setPosition(vector<S>(x, y)); });
}

samestep_status samestep_body_set_angle(samestep_world* world, samestep_body_id body, double angle) {
  return change(world, body, [&]<class S>(auto& of, S) { of.setAngle(number<S>(angle)); });
}

samestep_status samestep_body_set_velocity(samestep_world* world, samestep_body_id body, double x, double y) {
  return change(world, body, [&]<class S>(auto& of, S) { of.setVelocity(vector<S>(x, y)); });
}

samestep_status samestep_body_set_angular_velocity(samestep_world* world, samestep_body_id body,
                                                   double angular_velocity) {
  return change(world, body,
                [&]<class S>(auto& of, S) { of.setAngularVelocity(number<S>(angular_velocity)); });
}

samestep_status samestep_body_set_force(samestep_world* world, samestep_body_id body, double x, double y) {
  return change(world, body, [&]<class S>(auto& of, S) { of.setForce(vector<S>(x, y)); });
}

samestep_status samestep_body_set_gravity_scale(samestep_world* world, samestep_body_id body, double scale) {
  return change(world, body, [&]<class S>(auto& of, S) { of.setGravityScale(number<S>(scale)); });
}

samestep_status samestep_body_set_damping(samestep_world* world, samestep_body_id body, double linear,
                                          double angular) {
  return change(world, body, [&]<class S>(auto& of, S) {
    auto changed = of;
    changed.setLinearDamping(number<S>(linear));
    changed.setAngularDamping(number<S>(angular));
    of.setLinearDamping(changed.linearDamping());
    of.setAngularDamping(changed.angularDamping());
  });
}

samestep_status samestep_body_set_limits(samestep_world* world, samestep_body_id body, double speed,
                                         double spin) {
  return change(world, body, [&]<class S>(auto& of, S) {
    auto changed = of;
    changed.setSpeedLimit(number<S>(speed));
    changed.setSpinLimit(number<S>(spin));
    of.setSpeedLimit(changed.speedLimit());
    of.setSpinLimit(changed.spinLimit());
  });
}

samestep_status samestep_body_set_rotates(samestep_world* world, samestep_body_id body, int32_t rotates) {
  return change(world, body, [&](auto& of, auto) { of.setRotates(rotates != 0); });
}

samestep_status samestep_body_activate(samestep_world* world, samestep_body_id body) {
  return change(world, body, []<class S>(auto& of, S) { of.activate(); });
}

samestep_status samestep_body_sleep(samestep_world* world, samestep_body_id body) {
  return change(world, body, []<class S>(auto& of, S) { of.sleep(); });
}

samestep_status samestep_body_set_may_sleep(samestep_world* world, samestep_body_id body, int32_t may_sleep) {
  return change(world, body, [&]<class S>(auto& of, S) { of.setMaySleep(may_sleep != 0); });
}

samestep_status samestep_body_set_torque(samestep_world* world, samestep_body_id body, double torque) {
  return change(world, body, [&]<class S>(auto& of, S) { of.setTorque(number<S>(torque)); });
}

samestep_status samestep_body_set_mass(samestep_world* world, samestep_body_id body, double mass) {
  return change(world, body, [&]<class S>(auto& of, S) { of.setMass(massNumber<S>(mass)); });
}

samestep_status samestep_body_set_moment(samestep_world* world, samestep_body_id body, double moment) {
  return change(world, body, [&]<class S>(auto& of, S) { of.setMoment(momentNumber<S>(moment)); });
}

samestep_status samestep_body_set_center_of_mass(samestep_world* world, samestep_body_id body, double x,
                                                 double y) {
  return change(world, body, [&]<class S>(auto& of, S) { of.setCenterOfMass(vector<S>(x, y)); });
}

samestep_status samestep_body_set_mass_from_shapes(samestep_world* world, samestep_body_id body) {
  return call(world, [&](auto& of) { of.space.accumulateMassFromShapes(bodyId(body)); });
}

samestep_status samestep_body_set_type(samestep_world* world, samestep_body_id body, int32_t type) {
  return call(world, [&](auto& of) { of.space.setType(bodyId(body), toBodyType(type)); });
}

samestep_status samestep_body_set_user_data(samestep_world* world, samestep_body_id body,
                                            uint64_t user_data) {
  return change(world, body, [&](auto& of, auto) { of.setUserData(user_data); });
}

samestep_status samestep_body_set_bullet(samestep_world* world, samestep_body_id body, int32_t bullet) {
  return change(world, body, [&](auto& of, auto) { of.setBullet(bullet != 0); });
}

samestep_status samestep_body_set_functions(samestep_world* world, samestep_body_id body,
                                            uint32_t position_function, uint32_t velocity_function) {
  return change(world, body, [&](auto& of, auto) {
    of.setPositionFunc(position_function);
    of.setVelocityFunc(velocity_function);
  });
}

samestep_status samestep_body_apply_impulse(samestep_world* world, samestep_body_id body, double impulse_x,
                                            double impulse_y, double point_x, double point_y) {
  return change(world, body, [&]<class S>(auto& of, S) {
    of.applyImpulse(vector<S>(impulse_x, impulse_y), place<S>(point_x, point_y));
  });
}

samestep_status samestep_body_apply_force(samestep_world* world, samestep_body_id body, double force_x,
                                          double force_y, double point_x, double point_y) {
  return change(world, body, [&]<class S>(auto& of, S) {
    of.applyForce(vector<S>(force_x, force_y), place<S>(point_x, point_y));
  });
}

samestep_status samestep_body_get_velocity_at(const samestep_world* world, samestep_body_id body, double x,
                                              double y, samestep_vec2* velocity) {
  return call(world, [&]<class World>(World& of) {
    at(velocity) = toVec2(bodyOf(of, body).velocityAt(place<typename World::Number>(x, y)));
  });
}

samestep_status samestep_body_to_world(const samestep_world* world, samestep_body_id body, double x, double y,
                                       samestep_vec2* point) {
  return call(world, [&]<class World>(World& of) {
    at(point) = toVec2(bodyOf(of, body).toWorld(place<typename World::Number>(x, y)));
  });
}

samestep_status samestep_body_to_local(const samestep_world* world, samestep_body_id body, double x, double y,
                                       samestep_vec2* point) {
  return call(world, [&]<class World>(World& of) {
    at(point) = toVec2(bodyOf(of, body).toLocal(place<typename World::Number>(x, y)));
  });
}

samestep_status samestep_body_get_shapes(samestep_world* world, samestep_body_id body,
                                         const samestep_shape_id** shapes, size_t* count) {
  return call(world, [&](auto& of) {
    at(shapes), at(count);
    of.bodyShapes.clear();
    std::as_const(of.space).eachShape(bodyId(body),
                                      [&](const auto& shape) { of.bodyShapes.push_back(toC(shape.id())); });
    give(of.bodyShapes, shapes, count);
  });
}

samestep_status samestep_body_get_raw(const samestep_world* world, samestep_body_id body, int32_t quantity,
                                      int64_t raw[2]) {
  return call(world, [&](auto& of) {
    at(raw);
    const auto value = rawQuantity(bodyOf(of, body), quantity);
    raw[0] = toRaw(value.x);
    raw[1] = toRaw(value.y);
  });
}

samestep_status samestep_body_set_raw(samestep_world* world, samestep_body_id body, int32_t quantity,
                                      const int64_t raw[2]) {
  return change(world, body,
                [&]<class S>(auto& of, S) { setRawQuantity(of, quantity, rawVector<S>(&at(raw))); });
}

samestep_status samestep_number_to_raw(const samestep_world* world, double number, int64_t* raw) {
  return call(world, [&]<class World>(World&) {
    using S = typename World::Number;
    constexpr bool kDouble = samestep::ScalarTraits<S>::kKind == samestep::ScalarKind::float64;
    const S value = samestep::c::number<S>(number);
    constexpr double kEnd = 2147483648;
    samestep::require<samestep::Fault::ValueOutOfRange>(kDouble || (number >= -kEnd && number < kEnd));
    at(raw) = toRaw(value);
  });
}

samestep_status samestep_number_from_raw(const samestep_world* world, int64_t raw, double* number) {
  return call(world,
              [&]<class World>(World&) { at(number) = toDouble(fromRaw<typename World::Number>(raw)); });
}

samestep_status samestep_body_update_position(samestep_world* world, samestep_body_id body, double seconds) {
  return change(world, body, [&]<class S>(auto& of, S) { of.updatePosition(number<S>(seconds)); });
}

samestep_status samestep_body_update_velocity(samestep_world* world, samestep_body_id body, double gravity_x,
                                              double gravity_y, double damping, double seconds) {
  return change(world, body, [&]<class S>(auto& of, S) {
    updateVelocity(of, vector<S>(gravity_x, gravity_y), number<S>(damping), number<S>(seconds));
  });
}

}  // extern "C"
