// SPDX-License-Identifier: MIT
// What a Space computes from its state and may forget at any time: lists of shapes, placed geometry, trees.
#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include "base/require_ieee.h"
#include "world/space_impl.h"

namespace samestep {

template <Scalar S>
void LocalPlanes<S>::clear() {
  planes_.clear();
  geometries_.clear();
  firstFree_.assign(kMaxPolyVertices + 1, kNone);
  last_ = kNone;
}

template <Scalar S>
std::uint32_t LocalPlanes<S>::use(const Plane<S>* planes, std::uint32_t count) {
  static_assert(std::is_trivially_copyable_v<Plane<S>>);
  // By bits: zeros of two signs are equal, and not the same.
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
void SpaceCache<S>::copyFrom(const SpaceCache& other) {
  cached = other.cached;
  shapesHashKnown = other.shapesHashKnown;
  shapesHash = other.shapesHash;
  if (!cached) return;
  poses = other.poses;
  firstShape = other.firstShape;
  lastShape = other.lastShape;
  nextShape = other.nextShape;
  placed = other.placed;
  traits = other.traits;
  around = other.around;
  surfaces = other.surfaces;
  surfacesKnown = other.surfacesKnown;
  leftMidway = other.leftMidway;
  planeOffset = other.planeOffset;
  planes = other.planes;
  localPlanes = other.localPlanes;
  geometry = other.geometry;
  touched = other.touched;
  isTouched = other.isTouched;
  planeRoom = other.planeRoom;
  staticTree.copyFrom(other.staticTree);
  dynamicTree.copyFrom(other.dynamicTree);
  usePlanes();
}

/// Points each placed shape to its planes.
template <Scalar S>
void SpaceCache<S>::usePlanes() {
  for (std::size_t i = 0; i < placed.size(); ++i) {
    placed[i].planes = planes.data() + planeOffset[i];
    placed[i].local = geometry[i] == LocalPlanes<S>::kNone ? nullptr : localPlanes.of(geometry[i]);
  }
}

template <Scalar S>
std::uint64_t SpaceCache<S>::bytes() const {
  const auto of = [](const auto&... list) {
    return (std::uint64_t{0} + ... + (list.size() * sizeof(list[0])));
  };
  if (!cached) return 0;
  return of(poses, firstShape, lastShape, nextShape, placed, traits, around, planeOffset, planes, touched,
            isTouched, planeRoom, geometry) +
         localPlanes.bytes() + surfaces.bytes() + staticTree.bytes() + dynamicTree.bytes();
}

template <Scalar S>
SavedSpace<S>::SavedSpace() : cache_(new SpaceCache<S>) {}

template <Scalar S>
SavedSpace<S>::SavedSpace(const SavedSpace& other) : SavedSpace() {
  *this = other;
}

template <Scalar S>
SavedSpace<S>::SavedSpace(SavedSpace&& other) noexcept
    : state_(std::move(other.state_)), cache_(std::exchange(other.cache_, nullptr)) {}

template <Scalar S>
SavedSpace<S>& SavedSpace<S>::operator=(const SavedSpace& other) {
  if (this == &other) return *this;
  state_ = other.state_;
  if (cache_ == nullptr) cache_ = new SpaceCache<S>;
  cache_->cached = false;
  if (other.cache_ != nullptr) cache_->copyFrom(*other.cache_);
  return *this;
}

template <Scalar S>
SavedSpace<S>& SavedSpace<S>::operator=(SavedSpace&& other) noexcept {
  std::swap(state_, other.state_);
  std::swap(cache_, other.cache_);
  return *this;
}

template <Scalar S>
SavedSpace<S>::~SavedSpace() {
  delete cache_;
}

template <Scalar S>
std::uint64_t SavedSpace<S>::bytes() const {
  const auto ofSlots = [](const auto& map) {
    return map.values().size() * (sizeof(map.values()[0]) + sizeof(std::uint32_t));
  };
  return ofSlots(state_.bodies) + ofSlots(state_.shapes) + state_.pairs.size() * sizeof(Pair<S>) +
         state_.handlers.size() * sizeof(HandlerBinding) + sizeof state_ +
         (cache_ == nullptr ? 0 : cache_->bytes());
}

template <Scalar S>
void Space<S>::Impl::growBodies(std::uint32_t slots) {
  poses.resize(slots);
  firstShape.resize(slots, kNone);
  lastShape.resize(slots, kNone);
  isTouched.resize(slots, 0);
}

template <Scalar S>
void Space<S>::Impl::growShapes(std::uint32_t slots) {
  nextShape.resize(slots, kNone);
  placed.resize(slots);
  traits.resize(slots);
  around.resize(slots);
  planeOffset.resize(slots, 0);
  planeRoom.resize(slots, 0);
  geometry.resize(slots, kNone);
}

template <Scalar S>
void Space<S>::Impl::touch(std::uint32_t body) {
  if (body >= isTouched.size() || isTouched[body] != 0) return;
  isTouched[body] = 1;
  touched.push_back(body);
}

template <Scalar S>
void Space<S>::Impl::forgetTouched() {
  for (const std::uint32_t body : touched) isTouched[body] = 0;
  touched.clear();
}

template <Scalar S>
void Space<S>::Impl::linkShape(std::uint32_t body, std::uint32_t shape) {
  // By rising slot. A new shape nearly always has the highest one.
  std::uint32_t before = lastShape[body];
  if (before != kNone && before > shape) {
    before = kNone;
    for (std::uint32_t i = firstShape[body]; i != kNone && i < shape; i = nextShape[i]) before = i;
  }
  std::uint32_t& link = before == kNone ? firstShape[body] : nextShape[before];
  nextShape[shape] = link;
  link = shape;
  if (nextShape[shape] == kNone) lastShape[body] = shape;
}

template <Scalar S>
void Space<S>::Impl::unlinkShape(std::uint32_t body, std::uint32_t shape) {
  std::uint32_t before = kNone;
  for (std::uint32_t i = firstShape[body]; i != shape; i = nextShape[i]) before = i;
  (before == kNone ? firstShape[body] : nextShape[before]) = nextShape[shape];
  if (lastShape[body] == shape) lastShape[body] = before;
  nextShape[shape] = kNone;
}

template <Scalar S>
void Space<S>::Impl::prepareShape(std::uint32_t index, const Shape<S>& shape) {
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
  if (planes.data() != before || localPlanes.data() != localBefore) this->usePlanes();
  placed[index].planes = planes.data() + planeOffset[index];
  placed[index].local = localPlanes.of(geometry[index]);
}

template <Scalar S>
void Space<S>::Impl::takeTraits(std::uint32_t index, const Shape<S>& shape) {
  traits[index] = ShapeTraits<S>::of(shape, surfaces.number(Surface<S>::of(shape)));
  around[index] = CircleAround<S>::of(shape);
  if (!surfaces.tooMany(traits.size())) return;
  // What shapes no longer have is forgotten.
  Surfaces<S> anew;
  for (ShapeTraits<S>& each : traits) each.surface = anew.number(surfaces[each.surface]);
  surfaces = std::move(anew);
}

template <Scalar S>
void Space<S>::Impl::putBox(std::uint32_t shape, bool isStatic, const BB<S>& box, const Vector<S>& velocity) {
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
void Space<S>::Impl::dropBox(std::uint32_t shape) {
  if (staticTree.contains(shape)) staticTree.remove(shape);
  if (dynamicTree.contains(shape)) dynamicTree.remove(shape);
}

template <Scalar S>
void Space<S>::Impl::clearBoxes() {
  staticTree.clear();
  dynamicTree.clear();
}

template <Scalar S>
void Space<S>::ensureCache() const {
  Impl& impl = *impl_;
  if (impl.cached) return;
  impl.poses.assign(state_.bodies.slots(), {});
  impl.firstShape.assign(state_.bodies.slots(), Impl::kNone);
  impl.lastShape.assign(state_.bodies.slots(), Impl::kNone);
  impl.isTouched.assign(state_.bodies.slots(), 0);
  impl.touched.clear();
  impl.nextShape.assign(state_.shapes.slots(), Impl::kNone);
  impl.placed.assign(state_.shapes.slots(), {});
  impl.traits.assign(state_.shapes.slots(), {});
  impl.around.assign(state_.shapes.slots(), {});
  impl.surfaces.clear();
  impl.surfacesKnown = false;
  impl.planeOffset.assign(state_.shapes.slots(), 0);
  impl.planeRoom.assign(state_.shapes.slots(), 0);
  impl.planes.clear();
  impl.localPlanes.clear();
  impl.geometry.assign(state_.shapes.slots(), Impl::kNone);
  impl.clearBoxes();
  state_.shapes.each([&](ShapeId id, const Shape<S>& shape) {
    impl.linkShape(shape.body().index, id.index);
    impl.prepareShape(id.index, shape);
  });
  state_.bodies.each([&](BodyId id, const Body<S>&) { impl.touch(id.index); });
  impl.cached = true;
}

template <Scalar S>
void Space<S>::placeShapesOf(std::uint32_t bodyIndex) const {
  if (movePlaced(bodyIndex)) putBoxesOf(bodyIndex);
}

/// Places the shapes of all bodies that moved. The trees are the stepping thread's.
template <Scalar S>
void Space<S>::placeAllShapes() {
  Impl& impl = *impl_;
  const std::uint32_t slots = state_.bodies.slots();
  if (!impl.crew.helpsWith(slots, Impl::kFewBodies)) {
    for (std::uint32_t i = 0; i < slots; ++i) {
      if (state_.bodies.aliveAt(i)) placeShapesOf(i);
    }
    return;
  }
  impl.placedAnew.resize(slots);
  impl.crew.during(true, [&] {
    impl.crew.each(slots, Impl::kPlacedGrain, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) {
        impl.placedAnew[i] = state_.bodies.aliveAt(i) && movePlaced(i) ? 1 : 0;
      }
    });
  });
  for (std::uint32_t i = 0; i < slots; ++i) {
    if (impl.placedAnew[i] != 0) putBoxesOf(i);
  }
}

/// Places the shapes of a body; false where they stand already. Writes to nothing but these.
template <Scalar S>
bool Space<S>::movePlaced(std::uint32_t bodyIndex) const {
  Impl& impl = *impl_;
  const Body<S>& holder = state_.bodies.valueAt(bodyIndex);
  const PlacedPose<S> pose = PlacedPose<S>::of(holder);
  if (impl.poses[bodyIndex] == pose) return false;
  impl.poses[bodyIndex] = pose;
  if (impl.firstShape[bodyIndex] == Impl::kNone) return false;
  const Transform<S> transform = Transform<S>::rigid(pose.frame.origin, pose.frame.rotation);
  for (std::uint32_t i = impl.firstShape[bodyIndex]; i != Impl::kNone; i = impl.nextShape[i]) {
    place(transform, impl.placed[i]);
  }
  return true;
}

template <Scalar S>
void Space<S>::putBoxesOf(std::uint32_t bodyIndex) const {
  Impl& impl = *impl_;
  const Body<S>& holder = state_.bodies.valueAt(bodyIndex);
  const bool isStatic = holder.type() == BodyType::staticBody;
  for (std::uint32_t i = impl.firstShape[bodyIndex]; i != Impl::kNone; i = impl.nextShape[i]) {
    impl.putBox(i, isStatic, impl.placed[i].box, holder.velocity());
  }
}

template <Scalar S>
void Space<S>::refreshTouched() {
  ensureCache();
  if (impl_->keepPlaced) return;
  for (const std::uint32_t body : impl_->touched) {
    if (state_.bodies.aliveAt(body)) placeShapesOf(body);
  }
}

template <Scalar S>
std::span<const std::uint32_t> Space<S>::threadOf(BodyId id) {
  require<Fault::BodyNotFound>(contains(id));
  Impl& impl = *impl_;
  if (!impl.threadsKnown) {
    const std::uint32_t slots = state_.bodies.slots();
    impl.threadStart.assign(slots + 1, 0);
    const auto eachEnd = [&](auto&& visit) {
      for (std::uint32_t i = 0; i < state_.pairs.size(); ++i) {
        const Pair<S>& pair = state_.pairs[i];
        visit(state_.shapes.valueAt(pair.a.index).body().index, i);
        visit(state_.shapes.valueAt(pair.b.index).body().index, i);
      }
    };
    eachEnd([&](std::uint32_t body, std::uint32_t) { ++impl.threadStart[body + 1]; });
    for (std::uint32_t body = 0; body < slots; ++body) impl.threadStart[body + 1] += impl.threadStart[body];
    impl.threadPairs.resize(impl.threadStart[slots]);
    impl.threadFill = impl.threadStart;
    eachEnd(
        [&](std::uint32_t body, std::uint32_t pair) { impl.threadPairs[impl.threadFill[body]++] = pair; });
    impl.threadsKnown = true;
  }
  // A body added since then touches nothing yet.
  if (id.index + 1 >= impl.threadStart.size()) return {};
  return {impl.threadPairs.data() + impl.threadStart[id.index],
          impl.threadPairs.data() + impl.threadStart[id.index + 1]};
}

#ifndef SAMESTEP_FIXED_ONLY
template class LocalPlanes<double>;
template struct SpaceCache<double>;
template class SavedSpace<double>;
template class Space<double>;
#endif
template class LocalPlanes<Fixed>;
template struct SpaceCache<Fixed>;
template class SavedSpace<Fixed>;
template class Space<Fixed>;
template class LocalPlanes<CheckedFixed>;
template struct SpaceCache<CheckedFixed>;
template class SavedSpace<CheckedFixed>;
template class Space<CheckedFixed>;
void file_of::spaceCache() {}

}  // namespace samestep
