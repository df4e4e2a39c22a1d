// SPDX-License-Identifier: MIT
#include "world/objects.h"

#include <samestep/expects.h>

#include <algorithm>
#include <utility>

#include "base/change.h"
#include "base/require_ieee.h"
#include "contacts/stages/contact_callbacks.h"
#include "dynamics/body_access.h"
#include "islands/rouse.h"

namespace samestep {

template <Scalar S>
void Objects<S>::checkNew(const Context& world, const Body<S>& body) {
  require<Fault::DuplicateBody>(!body.id().valid() || body.id().space != world.state.bodies.space(),
                                "Space::add: the body is in this Space already, as ", body.id(),
                                "; Body::detached is a free copy");
  require<Fault::AttachedBody>(!body.id().valid(), "Space::add: the body is in another Space, as ", body.id(),
                               "; Body::detached is a free copy");
  const S extent = world.state.settings.worldExtent;
  require<Fault::IllegalBody>(within(body.worldCenter(), extent), "Space::add: the centre of mass is at ",
                              body.worldCenter(), " m, allowed are -", extent, " to ", extent, " m");
}

template <Scalar S>
void Objects<S>::insert(Context& world, const Body<S>& body, BodyId id) {
  world.derived.ensure(world.state);
  world.derived.growBodies(max(world.state.bodies.slots(), id.index + 1));
  world.state.bodies.store(id, body);
  Body<S>& own = world.state.bodies.valueAt(id.index);
  BodyAccess<S>::attach(own, world.state.bodies.idAt(id.index), world.state.settings.worldExtent);
  BodyAccess<S>::begin(own);
  world.derived.activeKnown = false;
  world.derived.touch(id.index);
}

template <Scalar S>
void Objects<S>::erase(Context& world, BodyId id) {
  world.state.bodies.erase(id);
  world.derived.poses[id.index] = {};
  world.derived.activeKnown = false;
}

template <Scalar S>
void Objects<S>::eraseWithShapes(Context& world, BodyId id) {
  Derived<S>& derived = world.derived;
  derived.ensure(world.state);
  Change change(world.leftMidway);
  ContactCallbacks<S>::dropPairs(world, id, {});
  derived.shapesHashKnown = false;
  std::uint32_t dropped = 0;
  for (std::uint32_t i = derived.firstShape[id.index]; i != kNone;) {
    if (++dropped % Budget::kObjectsAtOnce == 0) world.pay(Budget::kPerObject * Budget::kObjectsAtOnce);
    derived.dropBox(i);
    world.state.shapes.erase(world.state.shapes.idAt(i));
    i = std::exchange(derived.nextShape[i], kNone);
  }
  derived.firstShape[id.index] = derived.lastShape[id.index] = kNone;
  derived.compoundKnown = false;
  erase(world, id);
  change.done();
}

template <Scalar S>
void Objects<S>::setType(Context& world, BodyId id, BodyType type) {
  Body<S>& kept = world.state.bodies.template at<Fault::BodyNotFound>(id, "Space::setType");
  world.derived.touch(id.index);
  require<Fault::MainStaticBody>(id != world.state.staticBody || type == BodyType::staticBody,
                                 "Space::setType: body ", id,
                                 " is the static body of the Space, which stays static");
  if (type == kept.type()) return;
  Body<S> changed = kept.detached();
  changed.setType(type);
  for (std::uint32_t i = world.derived.firstShapeOf(world.state, id); i != kNone;
       i = world.derived.nextShape[i]) {
    checkShape(world.state.shapes.valueAt(i), changed);
  }
  if (changed.isDynamic() && changed.mass() == S(0)) {
    const MassProperties<S> mass = massOfShapes(world, id, kNone, nullptr);
    if (mass.mass > S(0)) changed.setMassProperties(mass);
  }

  BodyAccess<S>::attach(changed, kept.id(), world.state.settings.worldExtent);
  BodyAccess<S>::takePlaceOf(changed, kept);
  kept = changed;
  world.derived.forgetWhoMoves();
}

template <Scalar S>
void Objects<S>::accumulateMass(Context& world, BodyId id) {
  world.state.bodies.template requireAlive<Fault::BodyNotFound>(id, "Space::accumulateMassFromShapes");
  world.derived.touch(id.index);
  takeMass(world, id, kNone, nullptr);
}

template <Scalar S>
void Objects<S>::checkShape(const Shape<S>& shape, const Body<S>& body) {
  const S limit = body.type() == BodyType::staticBody ? S(kMaxExtent) : S(kMaxDynamicExtent);
  require<Fault::SizeOutOfRange>(shape.extent() <= limit, "a shape reaches ", shape.extent(),
                                 " m from the origin of its body, allowed are up to ", limit,
                                 body.type() == BodyType::staticBody ? " m" : " m for a body that moves");
}

/// Mass of the shapes of a body together, with `by`, unless it is null, in place of the one in the slot
/// `replaced`, if there is one. By rising slot, so that it does not matter which came first.
template <Scalar S>
MassProperties<S> Objects<S>::massOfShapes(Context& world, BodyId id, std::uint32_t replaced,
                                           const Shape<S>* by) {
  // The shapes' own sums first, then the parallel axes, all at full range: no Fixed intermediate can
  // overflow or lose a small shape beside a large one.
  struct Part {
    Scaled<S> mass, x, y, unitMoment;
  };
  Scaled<S> mass{}, x{}, y{}, moment{};
  const auto eachPart = [&](auto&& visit) {
    const auto visitShape = [&](const Shape<S>& shape) {
      const ShapeMassInfo<S>& info = shape.massInfo();
      if (info.mass > S(0)) {
        visit(
            Part{toScaled(info.mass), toScaled(info.centroid.x), toScaled(info.centroid.y), info.unitMoment});
      }
    };
    const Shape<S>* waiting = by;
    for (std::uint32_t i = world.derived.firstShapeOf(world.state, id); i != kNone;
         i = world.derived.nextShape[i]) {
      if (waiting != nullptr && i >= replaced) {
        visitShape(*waiting);
        waiting = nullptr;
      }
      if (i != replaced) visitShape(world.state.shapes.valueAt(i));
    }
    if (waiting != nullptr) visitShape(*waiting);
  };
  // One lonely shape keeps its numbers exactly.
  std::uint64_t parts = 0;
  eachPart([&](const Part& part) {
    ++parts;
    const Scaled<S> sum = mass + part.mass;
    const Scaled<S> dx = part.x - x;
    const Scaled<S> dy = part.y - y;
    moment = moment + part.mass * part.unitMoment;
    if (mass > Scaled<S>{}) {
      moment = moment + (dx * dx + dy * dy) * (mass * part.mass / sum);
      x = x + dx * (part.mass / sum);
      y = y + dy * (part.mass / sum);
    } else {
      x = part.x;
      y = part.y;
    }
    mass = sum;
  });
  world.wiring.budget.note(Budget::kPerObject / 2 * parts);
  return {saturated<S>(mass), moment, {toScalar<S>(x), toScalar<S>(y)}};
}

/// True if any shape of a body has mass, with `by` in place of one of them as in massOfShapes.
template <Scalar S>
bool Objects<S>::anyShapeWeighs(Context& world, BodyId id, std::uint32_t replaced, const Shape<S>* by) {
  if (by != nullptr && by->mass() > S(0)) return true;
  for (std::uint32_t i = world.derived.firstShapeOf(world.state, id); i != kNone;
       i = world.derived.nextShape[i]) {
    if (i != replaced && world.state.shapes.valueAt(i).mass() > S(0)) return true;
  }
  return false;
}

/// Makes a body weigh what its shapes do, after a change of those that have mass. One that is not dynamic
/// has no use for a mass, whose parts may be beyond what a dynamic one may have: it is summed when it
/// becomes dynamic.
template <Scalar S>
void Objects<S>::takeMass(Context& world, BodyId id, std::uint32_t replaced, const Shape<S>* by) {
  Body<S>& holder = world.state.bodies.valueAt(id.index);
  if (holder.isDynamic()) {
    holder.setMassProperties(massOfShapes(world, id, replaced, by));
  } else if (anyShapeWeighs(world, id, replaced, by)) {
    BodyAccess<S>::forgetMass(holder);
  } else {
    holder.setMassProperties({});
  }
}

template <Scalar S>
void Objects<S>::insert(Context& world, const Shape<S>& shape, ShapeId id) {
  require<Fault::DuplicateShape>(!shape.id().valid() || shape.id().space != world.state.shapes.space(),
                                 "Space::add: the shape is in this Space already, as ", shape.id(),
                                 "; Shape::detached is a free copy");
  require<Fault::AttachedShape>(!shape.id().valid(), "Space::add: the shape is in another Space, as ",
                                shape.id(), "; Shape::detached is a free copy");
  const Body<S>& holder =
      world.state.bodies.template at<Fault::BodyNotFound>(shape.body(), "Space::add: the body of the shape");
  require<Fault::DegenerateShape>(shape.wellFormed());
  checkShape(shape, holder);
  expects(!world.state.shapes.contains(id));
  Derived<S>& derived = world.derived;
  derived.ensure(world.state);
  derived.growShapes(max(world.state.shapes.slots(), id.index + 1));
  derived.reserveFor(shape);
  Shape<S> own = shape;
  ShapeId named = id;
  named.space = world.state.shapes.space();
  own.attach(named);
  world.state.shapes.reserve(id.index);
  const BodyId bodyId = shape.body();
  if (shape.mass() > S(0)) takeMass(world, bodyId, id.index, &shape);

  derived.shapesHashKnown = false;
  world.state.shapes.store(id, std::move(own));
  derived.linkShape(bodyId.index, id.index);
  derived.prepareShape(id.index, world.state.shapes.valueAt(id.index));
  // The next step or query places all shapes of the body.
  derived.poses[bodyId.index].known = false;
  derived.touch(bodyId.index);
  Change change(world.leftMidway);
  rouseNear(world, id);
  change.done();
}

/// Wakes the body of a shape that came to be, or those that lie where it is and so may be touched by it.
template <Scalar S>
void Objects<S>::rouseNear(Context& world, ShapeId id) {
  const std::uint32_t body = world.state.shapes.valueAt(id.index).body().index;
  if (world.state.settings.sleepTimeThreshold == S(0)) return;
  if (world.state.bodies.valueAt(body).type() == BodyType::staticBody) {
    Rouse<S>::near(world.state, world.derived, id.index);
  } else {
    Rouse<S>::body(world.state, world.derived, body);
  }
}

template <Scalar S>
void Objects<S>::erase(Context& world, ShapeId id) {
  Derived<S>& derived = world.derived;
  derived.ensure(world.state);
  const BodyId bodyId = world.state.shapes.valueAt(id.index).body();
  Change change(world.leftMidway);
  ContactCallbacks<S>::dropPairs(world, bodyId, id);

  if (world.state.shapes.valueAt(id.index).mass() > S(0)) takeMass(world, bodyId, id.index, nullptr);
  derived.dropBox(id.index);
  derived.unlinkShape(bodyId.index, id.index);
  derived.shapesHashKnown = false;
  world.state.shapes.erase(id);
  derived.touch(bodyId.index);
  Rouse<S>::sleeper(world.state, derived, bodyId.index);
  change.done();
}

template <Scalar S>
void Objects<S>::replace(Context& world, ShapeId id, const Shape<S>& shape, bool locked) {
  Shape<S>& kept = world.state.shapes.template at<Fault::ShapeNotFound>(id, "Space::replace");
  Shape<S> next = shape;
  next.attach(kept.id());
  next.setBody(kept.body());
  const std::span<const Vector<S>> before = kept.vertices(), after = next.vertices();
  const bool sameGeometry = next.type() == kept.type() && next.radius() == kept.radius() &&
                            std::equal(before.begin(), before.end(), after.begin(), after.end());
  // A body has nothing of the centroid of a shape without mass.
  const bool weighs = next.mass() > S(0) || kept.mass() > S(0);
  const bool sameMass = !weighs || next.massInfo() == kept.massInfo();
  if (!sameGeometry || !sameMass) {
    require<Fault::SpaceLocked>(!locked);
    require<Fault::DegenerateShape>(next.wellFormed());
    checkShape(next, world.state.bodies.valueAt(kept.body().index));
  }
  world.derived.ensure(world.state);
  std::span<const std::uint32_t> touching;
  if (sameGeometry) {
    world.derived.reserveSurface();
  } else {
    world.derived.reserveFor(next);
    touching = world.derived.pairsOf(world.state, kept.body());
  }
  if (!sameGeometry || !sameMass) {
    if (!sameMass) takeMass(world, kept.body(), id.index, &next);
    world.derived.touch(kept.body().index);
  }

  world.derived.shapesHashKnown = false;
  world.derived.surfacesKnown = false;
  const bool matters = !sameGeometry || !sameMass || !collidesAlike(kept, next);
  kept = std::move(next);
  world.derived.takeTraits(id.index, kept);
  if (!sameGeometry) {
    forgetManifolds(world, id, touching);
    world.derived.prepareShape(id.index, kept);
    world.derived.poses[kept.body().index].known = false;
  }
  if (!matters) return;
  Change change(world.leftMidway);
  Rouse<S>::pairsOf(world.state, world.derived, id);
  rouseNear(world, id);
  change.done();
}

/// True if two shapes of one geometry do the same where they touch something.
template <Scalar S>
bool Objects<S>::collidesAlike(const Shape<S>& a, const Shape<S>& b) {
  return a.friction() == b.friction() && a.elasticity() == b.elasticity() &&
         a.rollingResistance() == b.rollingResistance() && a.surfaceVelocity() == b.surfaceVelocity() &&
         a.sensor() == b.sensor() && a.filter() == b.filter() && a.collisionType() == b.collisionType();
}

/// The next step collides anew what touches a shape.
/// @param touching  the pairs of its body
template <Scalar S>
void Objects<S>::forgetManifolds(Context& world, ShapeId id, std::span<const std::uint32_t> touching) {
  for (const std::uint32_t index : touching) {
    Pair<S>& pair = world.state.pairs[index];
    if (pair.a == id || pair.b == id) pair.manifold = Manifold::unknown;
  }
  for (Pair<S>& pair : world.state.restingPairs) {
    if (pair.a == id || pair.b == id) pair.manifold = Manifold::unknown;
  }
}

#define SAMESTEP_EACH_SCALAR template struct Objects<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
