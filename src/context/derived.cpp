// SPDX-License-Identifier: MIT
#include "context/derived.h"

#include <algorithm>
#include <utility>

#include "base/require_ieee.h"

namespace samestep {

template <Scalar S>
void LocalPlanes<S>::clear() {
  planes_.clear();
  geometries_.clear();
  firstFree_.assign(kMaxPolyVertices + 1, kNone);
  last_ = kNone;
}

template <Scalar S>
void LocalPlanes<S>::reserve(std::uint32_t count) {
  makeRoom(geometries_, geometries_.size() + 1);
  makeRoom(planes_, planes_.size() + count);
}

template <Scalar S>
std::uint32_t LocalPlanes<S>::use(const Plane<S>* planes, std::uint32_t count) {
  static_assert(std::is_trivially_copyable_v<Plane<S>>);
  // Planes are compared by bits: zeros of two signs are equal, and not the same.
  const bool same = last_ != kNone && geometries_[last_].count == count && geometries_[last_].users != 0 &&
                    std::memcmp(of(last_), planes, count * sizeof(Plane<S>)) == 0;
  if (same) {
    ++geometries_[last_].users;
    return last_;
  }
  last_ = firstFree_[count];
  if (last_ == kNone) {
    last_ = static_cast<std::uint32_t>(geometries_.size());
    geometries_.push_back({static_cast<std::uint32_t>(planes_.size()), count, 1, kNone});
    planes_.insert(planes_.end(), planes, planes + count);
  } else {
    Geometry& again = geometries_[last_];
    firstFree_[count] = again.nextFree;
    again.users = 1;
    std::copy(planes, planes + count, planes_.begin() + again.offset);
  }
  return last_;
}

template <Scalar S>
void LocalPlanes<S>::release(std::uint32_t geometry) {
  if (geometry == kNone || --geometries_[geometry].users != 0) return;
  Geometry& unused = geometries_[geometry];
  unused.nextFree = firstFree_[unused.count];
  firstFree_[unused.count] = geometry;
}

template <Scalar S>
void Derived<S>::copyFrom(const Derived& other) {
  cached = false;
  forgetWhoMoves();
  shapesHashKnown = other.shapesHashKnown;
  shapesHash = other.shapesHash;
  if (!other.cached) return;
  stands = other.stands;
  firstShape = other.firstShape;
  lastShape = other.lastShape;
  nextShape = other.nextShape;
  placed = other.placed;
  traits = other.traits;
  around = other.around;
  surfaces = other.surfaces;
  surfacesKnown = other.surfacesKnown;
  planeOffset = other.planeOffset;
  planes = other.planes;
  localPlanes = other.localPlanes;
  geometry = other.geometry;
  touched = other.touched;
  isTouched = other.isTouched;
  planeRoom = other.planeRoom;
  staticTree.copyFrom(other.staticTree);
  dynamicTree.copyFrom(other.dynamicTree);
  makeRoom(touched, firstShape.size());
  bulks.assign(firstShape.size(), {});
  usePlanes();
  cached = true;
}

template <Scalar S>
void Derived<S>::saveTo(Derived& saved) const {
  saved.copyFrom(*this);
  if (!cached) return;
  saved.cached = false;
  saved.stands.resize(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    saved.stands[i] = poses[i].known && isTouched[i] == 0 ? 1 : 0;
  }
  saved.cached = true;
}

template <Scalar S>
void Derived<S>::restoreFrom(const Derived& saved, const WorldState<S>& world) {
  cached = false;
  if (saved.cached) poses.resize(saved.stands.size());
  copyFrom(saved);
  for (std::uint32_t i = 0; cached && i < poses.size(); ++i) {
    const bool known = saved.stands[i] != 0 && world.bodies.aliveAt(i);
    poses[i] = known ? PlacedPose<S>::of(world.bodies.valueAt(i)) : PlacedPose<S>();
  }
}

template <Scalar S>
void Derived<S>::findKeptApart(const WorldState<S>& world) {
  if (jointedKnown) return;
  keptApart.clear();
  world.joints.each([&](JointId, const Joint<S>& joint) {
    if (joint.collideConnected != 0) return;
    const std::uint32_t a = joint.bodyA.index, b = joint.bodyB.index;
    keptApart.push_back(std::uint64_t{min(a, b)} << 32 | max(a, b));
  });
  // total order: those that are equal are the same.
  std::sort(keptApart.begin(), keptApart.end());
  jointedKnown = true;
}

template <Scalar S>
bool Derived<S>::areKeptApart(std::uint32_t a, std::uint32_t b) const {
  return std::binary_search(keptApart.begin(), keptApart.end(), std::uint64_t{min(a, b)} << 32 | max(a, b));
}

template <Scalar S>
void Derived<S>::completePairs(WorldState<S>& world) {
  if (!surfacesLacking) return;
  surfacesLacking = false;
  for (Pair<S>& pair : world.pairs) takeShapesSurfaces(world, pair);
  for (Pair<S>& pair : world.restingPairs) takeShapesSurfaces(world, pair);
  surfacesKnown = true;
}

template <Scalar S>
void Derived<S>::takeShapesSurfaces(const WorldState<S>& world, Pair<S>& pair) {
  const Shape<S>& a = world.shapes.valueAt(pair.a.index);
  const Shape<S>& b = world.shapes.valueAt(pair.b.index);
  const bool belt = a.surfaceVelocity() != b.surfaceVelocity();
  takeSurfaces(pair, Surface<S>::of(a), Surface<S>::of(b),
               belt ? worldNormal(pair, world.bodies.valueAt(a.body().index)) : Vector<S>());
}

template <Scalar S>
void Derived<S>::usePlanes() {
  for (std::size_t i = 0; i < placed.size(); ++i) {
    placed[i].planes = planes.data() + planeOffset[i];
    placed[i].local = geometry[i] == LocalPlanes<S>::kNone ? nullptr : localPlanes.of(geometry[i]);
  }
}

template <Scalar S>
std::uint64_t Derived<S>::bytes() const {
  const auto of = [](const auto&... list) {
    return (std::uint64_t{0} + ... + (list.size() * sizeof(list[0])));
  };
  if (!cached) return 0;
  return of(stands, firstShape, lastShape, nextShape, placed, traits, around, planeOffset, planes, touched,
            isTouched, planeRoom, geometry) +
         localPlanes.bytes() + surfaces.bytes() + staticTree.bytes() + dynamicTree.bytes();
}

template <Scalar S>
void Derived<S>::growBodies(std::uint32_t slots) {
  // Each body is touched once. All have room before any grows.
  makeRoomForEach(slots, touched, poses, firstShape, lastShape, isTouched, bulks);
  bulks.resize(slots);
  poses.resize(slots);
  firstShape.resize(slots, kNone);
  lastShape.resize(slots, kNone);
  isTouched.resize(slots, 0);
}

template <Scalar S>
void Derived<S>::growShapes(std::uint32_t slots) {
  makeRoomForEach(slots, nextShape, placed, traits, around, planeOffset, planeRoom, geometry);
  nextShape.resize(slots, kNone);
  placed.resize(slots);
  traits.resize(slots);
  around.resize(slots);
  planeOffset.resize(slots, 0);
  planeRoom.resize(slots, 0);
  geometry.resize(slots, kNone);
}

template <Scalar S>
void Derived<S>::reserveSurface() {
  if (surfaces.tooMany(traits.size())) countSurfaces();
  surfaces.reserve(surfaces.size() + 1);
}

template <Scalar S>
void Derived<S>::reserveFor(const Shape<S>& shape) {
  const std::uint32_t count = static_cast<std::uint32_t>(planeCount(shape));
  reserveSurface();
  // Lists that placed shapes point to may go elsewhere, once nothing can fail that was to make it do so.
  const auto reserve = [this](const auto& list, auto&& grow) {
    const Plane<S>* const before = list.data();
    grow();
    if (list.data() != before) usePlanes();
  };
  reserve(localPlanes, [&] { localPlanes.reserve(count); });
  reserve(planes, [&] { makeRoom(planes, planes.size() + count); });
}

template <Scalar S>
void Derived<S>::touch(std::uint32_t body) {
  if (body >= isTouched.size() || isTouched[body] != 0) return;
  // Its centre of mass may be another one.
  bulks[body] = {};
  isTouched[body] = 1;
  touched.push_back(body);
}

template <Scalar S>
void Derived<S>::forgetTouched(const WorldState<S>& world) {
  std::size_t kept = 0;
  for (const std::uint32_t slot : touched) {
    const bool alive = world.bodies.aliveAt(slot);
    const Body<S>& body = world.bodies.valueAt(slot);
    const bool pulled = body.force() != Vector<S>() || body.torque() != S(0);
    // Within a step a callback may have roused it, or given it a force that only the next step takes away.
    if (alive && (body.activity() == Activity::roused || (body.type() == BodyType::staticBody && pulled))) {
      touched[kept++] = slot;
    } else {
      isTouched[slot] = 0;
    }
  }
  touched.resize(kept);
}

template <Scalar S>
void Derived<S>::linkShape(std::uint32_t body, std::uint32_t shape) {
  compoundKnown = false;
  // Shapes of a body are linked by rising slot. A new shape nearly always has the highest one.
  std::uint32_t before = lastShape[body];
  if (before != kNone && before > shape) {
    before = kNone;
    for (std::uint32_t i = firstShape[body]; i != kNone && i < shape; i = nextShape[i]) before = i;
  }
  std::uint32_t& link = before == kNone ? firstShape[body] : nextShape[before];
  nextShape[shape] = link;
  link = shape;
  if (nextShape[shape] == kNone) lastShape[body] = shape;
  bulks[body] = {};
}

template <Scalar S>
void Derived<S>::unlinkShape(std::uint32_t body, std::uint32_t shape) {
  compoundKnown = false;
  std::uint32_t before = kNone;
  for (std::uint32_t i = firstShape[body]; i != shape; i = nextShape[i]) before = i;
  (before == kNone ? firstShape[body] : nextShape[before]) = nextShape[shape];
  if (lastShape[body] == shape) lastShape[body] = before;
  nextShape[shape] = kNone;
  bulks[body] = {};
}

template <Scalar S>
void Derived<S>::prepareShape(std::uint32_t index, const Shape<S>& shape) {
  const std::uint32_t count = static_cast<std::uint32_t>(planeCount(shape));
  Plane<S> local[kMaxPolyVertices];
  prepare(shape, local, placed[index]);
  takeTraits(index, shape);
  const Plane<S>* const before = planes.data();
  const Plane<S>* const localBefore = localPlanes.data();
  localPlanes.release(geometry[index]);
  geometry[index] = localPlanes.use(local, count);
  if (count > planeRoom[index]) {
    planeOffset[index] = static_cast<std::uint32_t>(planes.size());
    planeRoom[index] = count;
    planes.resize(planes.size() + count);
  }
  if (planes.data() != before || localPlanes.data() != localBefore) usePlanes();
  placed[index].planes = planes.data() + planeOffset[index];
  placed[index].local = localPlanes.of(geometry[index]);
}

template <Scalar S>
void Derived<S>::takeTraits(std::uint32_t index, const Shape<S>& shape) {
  traits[index] = ShapeTraits<S>::of(shape, surfaces.number(Surface<S>::of(shape)));
  around[index] = CircleAround<S>::of(shape);
  bulks[shape.body().index] = {};
}

/// A turn moves the surface of a circle along itself, and nothing but its centre.
template <Scalar S>
BodyBulk<S> Derived<S>::findBulk(const WorldState<S>& world, std::uint32_t body) const {
  const Vector<S>& center = world.bodies.valueAt(body).centerOfMass();
  BodyBulk<S> bulk{S(kMaxExtent), S(0), S(0), S(0)};
  for (std::uint32_t i = firstShape[body]; i != kNone; i = nextShape[i]) {
    const bool round = placed[i].type == ShapeType::circle;
    bulk.room = min(bulk.room, max(around[i].thickness * ratio<S>(1, 2), kLeastRoom<S>));
    bulk.reach = max(bulk.reach, length(around[i].center - center) + (round ? S(0) : around[i].radius));
  }
  const S half = ratio<S>(1, 2);
  bulk.way = bulk.room * half;
  // A turn by more than 1 counts as far wherever it moves anything.
  const S turn = bulk.reach > bulk.way ? bulk.way / bulk.reach : S(1);
  bulk.turn = bulk.reach == S(0) ? kMaxAngularSpeed<S> : turn * half;
  return bulk;
}

/// Forgets the surfaces that shapes no longer have.
template <Scalar S>
void Derived<S>::countSurfaces() {
  Surfaces<S> anew;
  anew.reserve(traits.size());
  for (ShapeTraits<S>& each : traits) each.surface = anew.number(surfaces[each.surface]);
  surfaces = std::move(anew);
}

template <Scalar S>
void Derived<S>::putBox(std::uint32_t shape, bool isStatic, const BB<S>& box, const Vector<S>& velocity) {
  BBTree<S>& other = isStatic ? dynamicTree : staticTree;
  if (other.contains(shape)) [[unlikely]]
    other.remove(shape);
  if (isStatic) {
    staticTree.update(shape, box);
  } else {
    dynamicTree.update(shape, box, velocity);
  }
}

template <Scalar S>
void Derived<S>::dropBox(std::uint32_t shape) {
  if (staticTree.contains(shape)) staticTree.remove(shape);
  if (dynamicTree.contains(shape)) dynamicTree.remove(shape);
}

template <Scalar S>
void Derived<S>::compute(const WorldState<S>& world) {
  makeRoom(touched, world.bodies.slots());
  poses.assign(world.bodies.slots(), {});
  bulks.assign(world.bodies.slots(), {});
  firstShape.assign(world.bodies.slots(), kNone);
  lastShape.assign(world.bodies.slots(), kNone);
  isTouched.assign(world.bodies.slots(), 0);
  touched.clear();
  nextShape.assign(world.shapes.slots(), kNone);
  placed.assign(world.shapes.slots(), {});
  traits.assign(world.shapes.slots(), {});
  around.assign(world.shapes.slots(), {});
  surfaces.clear();
  surfacesKnown = false;
  planeOffset.assign(world.shapes.slots(), 0);
  planeRoom.assign(world.shapes.slots(), 0);
  planes.clear();
  localPlanes.clear();
  geometry.assign(world.shapes.slots(), kNone);
  staticTree.clear();
  dynamicTree.clear();
  forgetWhoMoves();
  world.shapes.each([&](ShapeId id, const Shape<S>& shape) {
    if (budget != nullptr && (id.index + 1) % Budget::kObjectsAtOnce == 0) {
      budget->pay(Budget::kPerObject * Budget::kObjectsAtOnce);
    }
    linkShape(shape.body().index, id.index);
    prepareShape(id.index, shape);
  });
  world.bodies.each([&](BodyId id, const Body<S>&) { touch(id.index); });
  cached = true;
}

template <Scalar S>
bool Derived<S>::movePlaced(const WorldState<S>& world, std::uint32_t bodyIndex) {
  const Body<S>& holder = world.bodies.valueAt(bodyIndex);
  const PlacedPose<S> pose = PlacedPose<S>::of(holder);
  if (poses[bodyIndex] == pose) return false;
  poses[bodyIndex] = pose;
  if (firstShape[bodyIndex] == kNone) return false;
  const Transform<S> transform = Transform<S>::rigid(pose.frame.origin, pose.frame.rotation);
  for (std::uint32_t i = firstShape[bodyIndex]; i != kNone; i = nextShape[i]) {
    place(transform, placed[i]);
  }
  return true;
}

template <Scalar S>
void Derived<S>::putBoxesOf(const WorldState<S>& world, std::uint32_t bodyIndex) {
  const Body<S>& holder = world.bodies.valueAt(bodyIndex);
  const bool isStatic = holder.type() == BodyType::staticBody || holder.activity() == Activity::asleep;
  for (std::uint32_t i = firstShape[bodyIndex]; i != kNone; i = nextShape[i]) {
    putBox(i, isStatic, placed[i].box, holder.velocity());
  }
}

template <Scalar S>
void Derived<S>::placeForSleepers(const WorldState<S>& world, std::uint32_t shape) {
  if (keepPlaced) return;
  for (const std::uint32_t body : touched) {
    if (world.bodies.aliveAt(body) && world.bodies.valueAt(body).isSleeping()) placeShapesOf(world, body);
  }
  const Body<S>& holder = world.bodies.valueAt(traits[shape].body);
  place(Transform<S>::rigid(holder.position(), holder.rotation()), placed[shape]);
}

template <Scalar S>
void Derived<S>::refresh(const WorldState<S>& world) {
  ensure(world);
  if (keepPlaced || touched.empty()) return;
  // Trees that are left midway are of no use.
  cached = false;
  std::uint32_t placedBodies = 0;
  for (const std::uint32_t body : touched) {
    if (++placedBodies % Budget::kObjectsAtOnce == 0 && budget != nullptr) {
      budget->pay(Budget::kPerObject * Budget::kObjectsAtOnce);
    }
    if (world.bodies.aliveAt(body)) placeShapesOf(world, body);
  }
  cached = true;
}

template <Scalar S>
void Derived<S>::findBodyPairs(const WorldState<S>& world, const std::vector<Pair<S>>& pairs, BodyPairs& to) {
  const std::uint32_t slots = world.bodies.slots();
  std::vector<std::uint32_t>& start = to.start;
  start.assign(slots + 1, 0);
  const auto eachEnd = [&](auto&& visit) {
    for (std::uint32_t i = 0; i < pairs.size(); ++i) {
      const Pair<S>& pair = pairs[i];
      visit(world.shapes.valueAt(pair.a.index).body().index, i);
      visit(world.shapes.valueAt(pair.b.index).body().index, i);
    }
  };
  eachEnd([&](std::uint32_t body, std::uint32_t) { ++start[body + 1]; });
  for (std::uint32_t body = 0; body < slots; ++body) start[body + 1] += start[body];
  to.pairs.resize(start[slots]);
  to.fill = start;
  eachEnd([&](std::uint32_t body, std::uint32_t pair) { to.pairs[to.fill[body]++] = pair; });
  to.known = true;
}

template <Scalar S>
std::span<const std::uint32_t> Derived<S>::pairsOf(const WorldState<S>& world, BodyId id,
                                                   const std::vector<Pair<S>>& pairs, BodyPairs& known) {
  world.bodies.template requireAlive<Fault::BodyNotFound>(id, "shapes or contacts of a body");
  if (!known.known) findBodyPairs(world, pairs, known);
  // A body added since then touches nothing yet.
  if (id.index + 1 >= known.start.size()) return {};
  return {known.pairs.data() + known.start[id.index], known.pairs.data() + known.start[id.index + 1]};
}

template <Scalar S>
void Derived<S>::findActive(const WorldState<S>& world) {
  if (activeKnown) return;
  const auto& bodies = world.bodies;
  active.clear();
  sleeps.assign(bodies.slots(), 0);
  mostSleepers = 0;
  bodies.each([&](BodyId id, const Body<S>& body) {
    if (body.type() == BodyType::staticBody) return;
    if (body.activity() == Activity::awake) {
      active.push_back(id.index);
    } else if (body.isDynamic()) {
      sleeps[id.index] = 1;
      ++mostSleepers;
    }
  });
  activeKnown = true;
}

template <Scalar S>
bool Derived<S>::hasCompound(const WorldState<S>& world) {
  if (!compoundKnown) {
    someCompound_ = false;
    for (std::uint32_t i = 0; i < firstShape.size() && !someCompound_; ++i) {
      someCompound_ = isCompound(i) && world.bodies.valueAt(i).type() != BodyType::staticBody;
    }
    compoundKnown = true;
  }
  return someCompound_;
}

#define SAMESTEP_EACH_SCALAR     \
  template class LocalPlanes<S>; \
  template struct Derived<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
