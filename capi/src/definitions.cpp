// SPDX-License-Identifier: MIT
#include "definitions.h"

#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "base/require_ieee.h"

namespace samestep::c {
namespace {

template <Scalar S>
std::vector<Vector<S>> pointsOf(const samestep_shape_def& from) {
  if (from.vertex_count != 0) at(from.vertices);
  std::vector<Vector<S>> points(from.vertex_count);
  for (std::uint32_t i = 0; i < from.vertex_count; ++i) points[i] = vector<S>(from.vertices[i]);
  return points;
}

template <Scalar S>
Shape<S> segmentOf(BodyId body, const samestep_shape_def& from, S radius) {
  Shape<S> shape = segmentShape<S>(body, vector<S>(from.a), vector<S>(from.b), radius);
  if (from.has_neighbors != 0) {
    SegmentShape<S>(shape).setNeighbors(vector<S>(from.previous), vector<S>(from.next));
  }
  return shape;
}

template <Scalar S>
Shape<S> geometryOf(BodyId body, const samestep_shape_def& from) {
  const S radius = number<S>(from.radius);
  switch (from.kind) {
    case SAMESTEP_CIRCLE:
      return circleShape<S>(body, radius, vector<S>(from.a));
    case SAMESTEP_SEGMENT:
      return segmentOf<S>(body, from, radius);
    case SAMESTEP_POLYGON:
      return polyShape<S>(body, pointsOf<S>(from), Transform<S>(), radius);
    case SAMESTEP_EXACT_POLYGON:
      return polyShapeRaw<S>(body, pointsOf<S>(from), radius);
    case SAMESTEP_BOX:
      return boxShape<S>(body, number<S>(from.width), number<S>(from.height), radius);
    default:
      refuse(SAMESTEP_UNKNOWN_VALUE);
  }
}

/// A body that is to be pushed about only by what the definition says.
template <Scalar S>
Body<S> bodyOfType(const samestep_body_def& from) {
  const BodyType type = toBodyType(from.type);
  Body<S> body = from.rotates != 0 ? Body<S>() : Body<S>::nonRotating(S(0));
  if (type != BodyType::dynamicBody) body.setType(type);
  return body;
}

}  // namespace

BodyType toBodyType(std::int32_t type) {
  requireOr(type == SAMESTEP_DYNAMIC || type == SAMESTEP_KINEMATIC || type == SAMESTEP_STATIC,
            SAMESTEP_UNKNOWN_VALUE);
  return static_cast<BodyType>(type);
}

template <Scalar S>
Settings<S> toSettings(const samestep_settings& from) {
  current(&from);
  requireOr(from.solver == SAMESTEP_SEQUENTIAL_IMPULSES || from.solver == SAMESTEP_SOFT_STEP,
            SAMESTEP_UNKNOWN_VALUE);
  requireOr(from.precision == SAMESTEP_ACCURATE || from.precision == SAMESTEP_FAST, SAMESTEP_UNKNOWN_VALUE);
  Settings<S> settings;
  settings.solver = static_cast<SolverKind>(from.solver);
  settings.precision = static_cast<ContactPrecision>(from.precision);
  settings.iterations = from.iterations;
  settings.substeps = from.substeps;
  settings.collisionPersistence = from.collision_persistence;
  settings.gravity = vector<S>(from.gravity);
  settings.damping = number<S>(from.damping);
  settings.collisionSlop = number<S>(from.collision_slop);
  settings.collisionBias = number<S>(from.collision_bias);
  settings.contactHertz = number<S>(from.contact_hertz);
  settings.contactDamping = number<S>(from.contact_damping);
  settings.contactPushSpeed = number<S>(from.contact_push_speed);
  settings.contactMargin = number<S>(from.contact_margin);
  settings.bounceThreshold = number<S>(from.bounce_threshold);
  settings.worldExtent = number<S>(from.world_extent);
  settings.sleepTimeThreshold = number<S>(from.sleep_time_threshold);
  settings.idleSpeedThreshold = number<S>(from.idle_speed_threshold);
  settings.continuous = from.continuous != 0 ? 1 : 0;
  return settings;
}

template <Scalar S>
samestep_settings toC(const Settings<S>& from) {
  samestep_settings settings{};
  settings.version = SAMESTEP_C_VERSION;
  settings.solver = static_cast<std::int32_t>(from.solver);
  settings.precision = static_cast<std::int32_t>(from.precision);
  settings.iterations = from.iterations;
  settings.substeps = from.substeps;
  settings.collision_persistence = from.collisionPersistence;
  settings.gravity = toVec2(from.gravity);
  settings.damping = toDouble(from.damping);
  settings.collision_slop = toDouble(from.collisionSlop);
  settings.collision_bias = toDouble(from.collisionBias);
  settings.contact_hertz = toDouble(from.contactHertz);
  settings.contact_damping = toDouble(from.contactDamping);
  settings.contact_push_speed = toDouble(from.contactPushSpeed);
  settings.contact_margin = toDouble(from.contactMargin);
  settings.bounce_threshold = toDouble(from.bounceThreshold);
  settings.world_extent = toDouble(from.worldExtent);
  settings.sleep_time_threshold = toDouble(from.sleepTimeThreshold);
  settings.idle_speed_threshold = toDouble(from.idleSpeedThreshold);
  settings.continuous = from.continuous;
  return settings;
}

template <Scalar S>
Body<S> toBody(const samestep_body_def& from) {
  Body<S> body = bodyOfType<S>(current(&from));
  // A body that has no mass need not be one that may be given it, where nothing is asked for.
  if (from.mass != 0) body.setMass(massNumber<S>(from.mass));
  require<Fault::MomentOutOfRange>(from.rotates != 0 || from.moment == 0,
                                   "What does not rotate has no moment.");
  if (from.moment != 0) body.setMoment(momentNumber<S>(from.moment));
  body.setPosition(vector<S>(from.position));
  body.setAngle(number<S>(from.angle));
  body.setVelocity(vector<S>(from.velocity));
  body.setAngularVelocity(number<S>(from.angular_velocity));
  body.setBullet(from.bullet != 0);
  body.setUserData(from.user_data);
  body.setPositionFunc(from.position_function);
  body.setVelocityFunc(from.velocity_function);
  return body;
}

template <Scalar S>
Shape<S> toShape(BodyId body, const samestep_shape_def& from) {
  Shape<S> shape = geometryOf<S>(body, current(&from));
  if (from.density != 0) {
    shape.setDensity(number<S>(from.density));
  } else if (from.mass != 0) {
    shape.setMass(massNumber<S>(from.mass));
  }
  shape.setFriction(number<S>(from.friction));
  shape.setElasticity(number<S>(from.elasticity));
  shape.setSurfaceVelocity(vector<S>(from.surface_velocity));
  shape.setCollisionType(from.collision_type);
  shape.setFilter({from.group, from.category, from.mask});
  shape.setSensor(from.sensor != 0);
  shape.setMaterial(from.material);
  shape.setUserData(from.user_data);
  return shape;
}

template <Scalar S>
samestep_touch toC(const ContactPointSet<S>& set) {
  samestep_touch touch{};
  touch.normal = toVec2(set.normal);
  touch.count = set.count;
  for (std::int32_t i = 0; i < set.count; ++i) {
    touch.point_a[i] = toVec2(set.points[i].pointA);
    touch.point_b[i] = toVec2(set.points[i].pointB);
    touch.distance[i] = toDouble(set.points[i].distance);
  }
  return touch;
}

template <Scalar S>
samestep_contact_state toC(const Arbiter<S>& arbiter) {
  samestep_contact_state state{};
  state.shape_a = toC(arbiter.shapeA());
  state.shape_b = toC(arbiter.shapeB());
  state.body_a = toC(arbiter.bodyA());
  state.body_b = toC(arbiter.bodyB());
  state.touch = toC(arbiter.contactPointSet());
  state.friction = toDouble(arbiter.friction());
  state.restitution = toDouble(arbiter.restitution());
  state.surface_velocity = toVec2(arbiter.surfaceVelocity());
  state.total_impulse = toVec2(arbiter.totalImpulse());
  state.first = arbiter.isFirstContact() ? 1 : 0;
  state.removal = arbiter.isRemoval() ? 1 : 0;
  state.ignored = arbiter.ignored() ? 1 : 0;
  return state;
}

#define SAMESTEP_EACH_SCALAR                                       \
  template Settings<S> toSettings<S>(const samestep_settings&);    \
  template samestep_settings toC<S>(const Settings<S>&);           \
  template Body<S> toBody<S>(const samestep_body_def&);            \
  template Shape<S> toShape<S>(BodyId, const samestep_shape_def&); \
  template samestep_touch toC<S>(const ContactPointSet<S>&);       \
  template samestep_contact_state toC<S>(const Arbiter<S>&);
#include <samestep/each_scalar.h>

}  // namespace samestep::c

extern "C" {

void samestep_settings_init(samestep_settings* settings) {
  if (settings == nullptr) return;
  *settings = samestep::c::toC(samestep::Settings<samestep::Fixed>());
  // A double tells these more exactly than Fixed does.
  settings->collision_slop = 0.005;
  settings->collision_bias = 0.00179701;
  settings->contact_margin = 0.02;
  settings->idle_speed_threshold = 0.05;
}

void samestep_world_def_init(samestep_world_def* def) {
  if (def == nullptr) return;
  *def = {};
  def->version = SAMESTEP_C_VERSION;
  def->scalar = SAMESTEP_FIXED;
  def->max_pairs = samestep::kDefaultMaxPairs;
  def->workers = 1;
  samestep_settings_init(&def->settings);
}

void samestep_body_def_init(samestep_body_def* def) {
  if (def == nullptr) return;
  *def = {};
  def->version = SAMESTEP_C_VERSION;
  def->rotates = 1;
}

void samestep_shape_def_init(samestep_shape_def* def) {
  if (def == nullptr) return;
  *def = {};
  def->version = SAMESTEP_C_VERSION;
  def->kind = SAMESTEP_BOX;
  def->width = def->height = 1;
  def->category = def->mask = 0xffffffffu;
}

void samestep_joint_def_init(samestep_joint_def* def) {
  if (def == nullptr) return;
  *def = {};
  def->version = SAMESTEP_C_VERSION;
  def->axis.x = 1;
  def->damping = def->angular_damping = def->ratio = 1;
}

void samestep_command_init(samestep_command* command) {
  if (command == nullptr) return;
  *command = {};
  command->version = SAMESTEP_C_VERSION;
}

}  // extern "C"
