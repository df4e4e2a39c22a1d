// SPDX-License-Identifier: MIT
// Shapes.
#include "base/require_ieee.h"
#include "definitions.h"

namespace samestep::c {
namespace {

ShapeId shapeId(samestep_shape_id id) { return fromC<ShapeId>(id); }

template <Scalar S>
const Shape<S>& shapeOf(const WorldOf<S>& world, samestep_shape_id id) {
  return std::as_const(world.space).shape(shapeId(id));
}

std::int32_t kindOf(ShapeType type) {
  switch (type) {
    case ShapeType::circle:
      return SAMESTEP_CIRCLE;
    case ShapeType::segment:
      return SAMESTEP_SEGMENT;
    case ShapeType::poly:
      return SAMESTEP_POLYGON;
  }
  return SAMESTEP_POLYGON;
}

template <Scalar S>
samestep_shape_state stateOf(const Shape<S>& shape) {
  samestep_shape_state state{};
  state.id = toC(shape.id());
  state.body = toC(shape.body());
  state.user_data = shape.userData();
  state.kind = kindOf(shape.type());
  state.sensor = shape.sensor() ? 1 : 0;
  state.radius = toDouble(shape.radius());
  state.mass = toDouble(shape.mass());
  state.density = toDouble(shape.density());
  state.area = toDouble(shape.area());
  state.center_of_mass = toVec2(shape.centerOfMass());
  state.friction = toDouble(shape.friction());
  state.elasticity = toDouble(shape.elasticity());
  state.surface_velocity = toVec2(shape.surfaceVelocity());
  state.collision_type = shape.collisionType();
  state.group = shape.filter().group;
  state.category = shape.filter().category;
  state.mask = shape.filter().mask;
  state.material = shape.material();
  state.rolling_resistance = toDouble(shape.rollingResistance());
  return state;
}

/// Changes a shape by action(shape, a number of its scalar's type), all or nothing.
template <class Action>
samestep_status change(samestep_world* world, samestep_shape_id shape, Action&& action) noexcept {
  return call(world, [&]<class World>(World& of) {
    of.space.change(shapeId(shape), [&](auto& copy) { action(copy, typename World::Number()); });
  });
}

}  // namespace
}  // namespace samestep::c

using namespace samestep::c;

extern "C" {

samestep_status samestep_shape_create(samestep_world* world, samestep_body_id body,
                                      const samestep_shape_def* def, samestep_shape_id* shape) {
  return call(world, [&]<class World>(World& of) {
    at(shape);
    const samestep::BodyId owner = fromC<samestep::BodyId>(body);
    samestep::require<samestep::Fault::BodyNotFound>(of.space.contains(owner));
    const auto made = toShape<typename World::Number>(owner, current(def));
    *shape = toC(def->id == 0 ? of.space.add(made) : of.space.add(made, shapeId(def->id)));
  });
}

samestep_status samestep_shape_destroy(samestep_world* world, samestep_shape_id shape) {
  return call(world, [&](auto& of) { of.space.remove(shapeId(shape)); });
}

samestep_status samestep_shape_exists(const samestep_world* world, samestep_shape_id shape, int32_t* exists) {
  return call(world, [&](auto& of) { at(exists) = of.space.contains(shapeId(shape)) ? 1 : 0; });
}

samestep_status samestep_shape_replace(samestep_world* world, samestep_shape_id shape,
                                       const samestep_shape_def* def) {
  return call(world, [&]<class World>(World& of) {
    const samestep::BodyId owner = shapeOf(of, shape).body();
    of.space.replace(shapeId(shape), toShape<typename World::Number>(owner, current(def)));
  });
}

samestep_status samestep_shape_get(const samestep_world* world, samestep_shape_id shape,
                                   samestep_shape_state* state) {
  return call(world, [&](auto& of) { at(state) = stateOf(shapeOf(of, shape)); });
}

samestep_status samestep_shape_get_vertices(samestep_world* world, samestep_shape_id shape,
                                            const samestep_vec2** vertices, size_t* count) {
  return call(world, [&](auto& of) {
    at(vertices), at(count);
    const auto& found = shapeOf(of, shape);
    auto places = found.vertices();
    // Behind the ends of a segment stand the directions to its neighbours.
    if (found.type() == samestep::ShapeType::segment) places = places.first(2);
    of.vertices.clear();
    for (const auto& place : places) of.vertices.push_back(toVec2(place));
    give(of.vertices, vertices, count);
  });
}

samestep_status samestep_shape_get_bounding_box(samestep_world* world, samestep_shape_id shape,
                                                samestep_box* box) {
  return call(world, [&](auto& of) {
    at(box);
    *box = toBox(of.space.boundingBox(shapeId(shape)));
  });
}

samestep_status samestep_shape_set_mass(samestep_world* world, samestep_shape_id shape, double mass) {
  return change(world, shape, [&]<class S>(auto& of, S) { of.setMass(massNumber<S>(mass)); });
}

samestep_status samestep_shape_set_density(samestep_world* world, samestep_shape_id shape, double density) {
  return change(world, shape, [&]<class S>(auto& of, S) { of.setDensity(number<S>(density)); });
}

samestep_status samestep_shape_set_friction(samestep_world* world, samestep_shape_id shape, double friction) {
  return change(world, shape, [&]<class S>(auto& of, S) { of.setFriction(number<S>(friction)); });
}

samestep_status samestep_shape_set_elasticity(samestep_world* world, samestep_shape_id shape,
                                              double elasticity) {
  return change(world, shape, [&]<class S>(auto& of, S) { of.setElasticity(number<S>(elasticity)); });
}

samestep_status samestep_shape_set_surface_velocity(samestep_world* world, samestep_shape_id shape, double x,
                                                    double y) {
  return change(world, shape, [&]<class S>(auto& of, S) { of.setSurfaceVelocity(vector<S>(x, y)); });
}

samestep_status samestep_shape_set_filter(samestep_world* world, samestep_shape_id shape, uint32_t group,
                                          uint32_t category, uint32_t mask) {
  return change(world, shape, [&](auto& of, auto) { of.setFilter({group, category, mask}); });
}

samestep_status samestep_shape_set_rolling_resistance(samestep_world* world, samestep_shape_id shape,
                                                      double resistance) {
  return change(world, shape, [&]<class S>(auto& of, S) { of.setRollingResistance(number<S>(resistance)); });
}

samestep_status samestep_shape_set_material(samestep_world* world, samestep_shape_id shape,
                                            uint32_t material) {
  return change(world, shape, [&](auto& of, auto) { of.setMaterial(material); });
}

samestep_status samestep_shape_set_collision_type(samestep_world* world, samestep_shape_id shape,
                                                  uint32_t type) {
  return change(world, shape, [&](auto& of, auto) { of.setCollisionType(type); });
}

samestep_status samestep_shape_set_sensor(samestep_world* world, samestep_shape_id shape, int32_t sensor) {
  return change(world, shape, [&](auto& of, auto) { of.setSensor(sensor != 0); });
}

samestep_status samestep_shape_set_user_data(samestep_world* world, samestep_shape_id shape,
                                             uint64_t user_data) {
  return change(world, shape, [&](auto& of, auto) { of.setUserData(user_data); });
}

}  // extern "C"
