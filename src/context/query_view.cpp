// SPDX-License-Identifier: MIT
#include <samestep/query_view.h>

#include <algorithm>

#include <samestep/bb_tree.h>
#include <samestep/error.h>
#include <samestep/limits.h>

#include "base/require_ieee.h"
#include "narrow_phase/moving_shape.h"

namespace samestep {
namespace {

template <Scalar S>
void requirePlace(const Vector<S>& place, const char* is) {
  require<Fault::ValueOutOfRange>(within(place, kMaxWorldExtent<S>), is, place, " m, allowed are up to ",
                                  kMaxWorldExtent<S>, " m along each axis");
}

/// The first hits of all, in the room of a caller.
template <class Hit, class Before>
class FirstHits {
 public:
  FirstHits(std::span<Hit> room, Before before) : room_(room), before_(before) {}

  void add(const Hit& hit) {
    ++count_;
    std::size_t at = kept_;
    while (at > 0 && before_(hit, room_[at - 1])) --at;
    if (at == room_.size()) return;
    if (kept_ < room_.size()) ++kept_;
    for (std::size_t i = kept_ - 1; i > at; --i) room_[i] = room_[i - 1];
    room_[at] = hit;
  }
  std::size_t count() const { return count_; }

 private:
  std::span<Hit> room_;
  Before before_;
  std::size_t kept_ = 0, count_ = 0;
};

template <Scalar S>
bool hitsBefore(const SegmentHit<S>& a, const SegmentHit<S>& b) {
  return a.alpha != b.alpha ? a.alpha < b.alpha : a.shape < b.shape;
}
template <Scalar S>
bool isNearer(const NearHit<S>& a, const NearHit<S>& b) {
  if (a.there.distance != b.there.distance) return a.there.distance < b.there.distance;
  return a.shape < b.shape;
}

/// A shape that is asked about, with its own room.
template <Scalar S>
struct AskedShape {
  explicit AskedShape(const Shape<S>& shape) { prepare(shape, local, placed); }
  AskedShape(const AskedShape&) = delete;
  AskedShape& operator=(const AskedShape&) = delete;

  PlacedShape<S> placed;
  Plane<S> local[kMaxPolyVertices];
};

}  // namespace

template <Scalar S>
bool QueryView<S>::considers(std::uint32_t index, const QueryFilter& filter) const {
  const Shape<S>& shape = shapes_->valueAt(index);
  return samestep::accepts(shape.filter(), filter.filter) && (filter.sensors || !shape.sensor());
}

template <Scalar S>
template <class Visit>
void QueryView<S>::eachOnRay(const Vector<S>& start, const Vector<S>& end, S radius,
                             const QueryFilter& filter, Visit&& visit) const {
  requirePlace(start, "a ray: its start is ");
  requirePlace(end, "a ray: its end is ");
  const char* const is = "a ray: its radius is ";
  require<Fault::ValueOutOfRange>(radius <= kMaxWorldExtent<S>, is, radius, " m, allowed are 0 to ",
                                  kMaxWorldExtent<S>, " m");
  require<Fault::NegativeRadius>(radius >= S(0), is, radius, " m, allowed are 0 to ", kMaxWorldExtent<S>,
                                 " m");
  const GridSegment area = BBTree<S>::areaOf(start, end, radius);
  for (const BBTree<S>* tree : trees_) {
    tree->boxes().query(area, [&](BoxTree::Key index) {
      if (!considers(index, filter)) return;
      const SegmentQueryInfo<S> info = segmentQuery(placed_[index], start, end, radius);
      if (!info.hit || !accepts(index, filter)) return;
      visit(SegmentHit<S>{shapes_->idAt(index), info.point, info.normal, info.alpha});
    });
  }
}

template <Scalar S>
bool QueryView<S>::castRay(const Vector<S>& start, const Vector<S>& end, const QueryFilter& filter,
                           SegmentHit<S>& hit, S radius) const {
  return castRay(start, end, filter, std::span<SegmentHit<S>>(&hit, 1), radius) != 0;
}

template <Scalar S>
bool QueryView<S>::meetsAny(const Vector<S>& start, const Vector<S>& end, const QueryFilter& filter,
                            S radius) const {
  bool any = false;
  eachOnRay(start, end, radius, filter, [&](const SegmentHit<S>&) { any = true; });
  return any;
}

template <Scalar S>
std::size_t QueryView<S>::castRay(const Vector<S>& start, const Vector<S>& end, const QueryFilter& filter,
                                  std::span<SegmentHit<S>> hits, S radius) const {
  FirstHits first(hits, hitsBefore<S>);
  eachOnRay(start, end, radius, filter, [&](const SegmentHit<S>& hit) { first.add(hit); });
  return first.count();
}

template <Scalar S>
template <class Visit>
void QueryView<S>::eachOnWay(const Shape<S>& shape, const RigidMotion<S>& motion, const QueryFilter& filter,
                             Visit&& visit) const {
  requireMotion(motion);
  const AskedShape<S> asked(shape);
  MovingShape<S> moving(asked.placed, motion);
  S reach(0);
  for (int i = 0; i < asked.placed.count; ++i) {
    reach = max(reach, length(asked.placed.local[i].v0 - motion.pivot));
  }
  const S around = reach + shape.radius() + S(2) * kImpactDistance<S>;
  const GridSegment area = BBTree<S>::areaOf(motion.start, motion.start + motion.way, around);
  for (const BBTree<S>* tree : trees_) {
    tree->boxes().query(area, [&](BoxTree::Key index) {
      if (!considers(index, filter)) return;
      MovingShape<S> other(placed_[index]);
      const Impact<S> impact = timeOfImpact(moving, other, kImpactDistance<S>);
      if (!impact.hit || !accepts(index, filter)) return;
      visit(SegmentHit<S>{shapes_->idAt(index), impact.there.pointB, -impact.there.normal, impact.part});
    });
  }
}

template <Scalar S>
bool QueryView<S>::castShape(const Shape<S>& shape, const RigidMotion<S>& motion, const QueryFilter& filter,
                             SegmentHit<S>& hit) const {
  return castShape(shape, motion, filter, std::span<SegmentHit<S>>(&hit, 1)) != 0;
}

template <Scalar S>
std::size_t QueryView<S>::castShape(const Shape<S>& shape, const RigidMotion<S>& motion,
                                    const QueryFilter& filter, std::span<SegmentHit<S>> hits) const {
  FirstHits first(hits, hitsBefore<S>);
  eachOnWay(shape, motion, filter, [&](const SegmentHit<S>& hit) { first.add(hit); });
  return first.count();
}

template <Scalar S>
template <class Visit>
void QueryView<S>::eachNear(const Shape<S>& shape, const Transform<S>& pose, S reach,
                            const QueryFilter& filter, Visit&& visit) const {
  requirePlace(Vector<S>(pose.tx, pose.ty), "a shape that is asked about: its position is ");
  require<Fault::ValueOutOfRange>(reach >= S(0) && reach <= kMaxWorldExtent<S>,
                                  "a shape that is asked about: the reach is ", reach,
                                  " m, allowed are 0 to ", kMaxWorldExtent<S>, " m");
  const Placement<S> asked(shape, pose);
  const GridBox area = BBTree<S>::areaOf(inflate(asked->box, reach));
  for (const BBTree<S>* tree : trees_) {
    tree->boxes().query(area, [&](BoxTree::Key index) {
      if (!considers(index, filter)) return;
      const ShapeDistance<S> there = distanceBetween(*asked, placed_[index]);
      if (there.distance <= reach && accepts(index, filter)) visit(NearHit<S>{shapes_->idAt(index), there});
    });
  }
}

template <Scalar S>
std::size_t QueryView<S>::overlapping(const Shape<S>& shape, const Transform<S>& pose,
                                      const QueryFilter& filter, std::span<ShapeId> hits) const {
  FirstHits first(hits, [](ShapeId a, ShapeId b) { return a < b; });
  eachNear(shape, pose, S(0), filter, [&](const NearHit<S>& hit) { first.add(hit.shape); });
  return first.count();
}

template <Scalar S>
std::size_t QueryView<S>::nearest(const Shape<S>& shape, const Transform<S>& pose, S reach,
                                  const QueryFilter& filter, std::span<NearHit<S>> hits) const {
  FirstHits first(hits, isNearer<S>);
  eachNear(shape, pose, reach, filter, [&](const NearHit<S>& hit) { first.add(hit); });
  return first.count();
}

template <Scalar S>
bool QueryView<S>::nearest(const Shape<S>& shape, const Transform<S>& pose, S reach,
                           const QueryFilter& filter, NearHit<S>& hit) const {
  return nearest(shape, pose, reach, filter, std::span<NearHit<S>>(&hit, 1)) != 0;
}

template <Scalar S>
ShapeDistance<S> QueryView<S>::distance(ShapeId a, ShapeId b) const {
  shapes_->template requireAlive<Fault::ShapeNotFound>(a, "QueryView::distance");
  shapes_->template requireAlive<Fault::ShapeNotFound>(b, "QueryView::distance");
  return distanceBetween(placed_[a.index], placed_[b.index]);
}

#define SAMESTEP_EACH_SCALAR template class QueryView<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
