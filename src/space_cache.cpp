// SPDX-License-Identifier: MIT
// What a Space computes from its state and may forget at any time: lists of shapes, placed geometry, trees.
#include "require_ieee.h"
#include "space_impl.h"

namespace samestep {

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
  planeOffset.resize(slots, 0);
  planeRoom.resize(slots, 0);
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
  const std::uint32_t room = static_cast<std::uint32_t>(planeCount(shape));
  if (room > planeRoom[index]) {
    const Plane<S>* before = planes.data();
    planeOffset[index] = static_cast<std::uint32_t>(planes.size());
    planeRoom[index] = room;
    planes.resize(planes.size() + room);
    if (planes.data() != before) {
      for (std::uint32_t i = 0; i < placed.size(); ++i) placed[i].planes = planes.data() + planeOffset[i];
    }
  }
  placed[index].planes = planes.data() + planeOffset[index];
  traits[index] = ShapeTraits<S>::of(shape);
  prepare(shape, placed[index]);
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
  impl.surfacesKnown = false;
  impl.planeOffset.assign(state_.shapes.slots(), 0);
  impl.planeRoom.assign(state_.shapes.slots(), 0);
  impl.planes.clear();
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
  return {impl.threadPairs.data() + impl.threadStart[id.index],
          impl.threadPairs.data() + impl.threadStart[id.index + 1]};
}

#ifndef SAMESTEP_FIXED_ONLY
template class Space<double>;
#endif
template class Space<Fixed>;
template class Space<CheckedFixed>;
void file_of::spaceCache() {}

}  // namespace samestep
