// SPDX-License-Identifier: MIT
#include "world/queries.h"

#include <algorithm>

#include "base/require_ieee.h"

namespace samestep {
namespace {

template <Scalar S>
void requirePlace(const Vector<S>& place, const char* is) {
  require<Fault::ValueOutOfRange>(within(place, kMaxWorldExtent<S>), is, place, " m, allowed are up to ",
                                  kMaxWorldExtent<S>, " m along each axis");
}

}  // namespace

template <Scalar S>
template <class Collect>
void Queries<S>::collectFound(Collect&& collect) {
  parts.found.clear();
  for (const BBTree<S>* tree : {&parts.derived.dynamicTree, &parts.derived.staticTree}) {
    collect(*tree, parts.foundInOne);
    parts.found.insert(parts.found.end(), parts.foundInOne.begin(), parts.foundInOne.end());
  }
  // total order: keys are unique
  std::sort(parts.found.begin(), parts.found.end());
}

template <Scalar S>
void Queries<S>::point(const Vector<S>& point, S distance, const ShapeFilter& filter,
                       std::vector<PointHit<S>>& hits) {
  requirePlace(point, "Space::pointQuery: point is ");
  require<Fault::ValueOutOfRange>(distance >= S(0) && distance <= kMaxWorldExtent<S>,
                                  "Space::pointQuery: distance is ", distance, " m, allowed are 0 to ",
                                  kMaxWorldExtent<S>, " m");
  hits.clear();
  parts.derived.refresh(state);
  const BB<S> box = BB<S>::forCircle(point, distance);
  collectFound([&](const BBTree<S>& tree, std::vector<IndexKey>& keys) { tree.collectIn(box, keys); });
  for (const std::uint32_t index : parts.found) {
    if (!accepts(state.shapes.valueAt(index).filter(), filter)) continue;
    const PointQueryInfo<S> info = samestep::pointQuery(parts.derived.placed[index], point);
    if (info.distance <= distance) {
      hits.push_back({state.shapes.idAt(index), info.point, info.distance, info.gradient});
    }
  }
}

template <Scalar S>
void Queries<S>::segment(const Vector<S>& start, const Vector<S>& end, S radius, const ShapeFilter& filter,
                         std::vector<SegmentHit<S>>& hits) {
  requirePlace(start, "Space::segmentQuery: start is ");
  requirePlace(end, "Space::segmentQuery: end is ");
  const char* const is = "Space::segmentQuery: radius is ";
  require<Fault::ValueOutOfRange>(radius <= kMaxWorldExtent<S>, is, radius, " m, allowed are 0 to ",
                                  kMaxWorldExtent<S>, " m");
  require<Fault::NegativeRadius>(radius >= S(0), is, radius, " m, allowed are 0 to ", kMaxWorldExtent<S>,
                                 " m");
  hits.clear();
  parts.derived.refresh(state);
  collectFound([&](const BBTree<S>& tree, std::vector<IndexKey>& keys) {
    tree.collectAlong(start, end, radius, keys);
  });
  for (const std::uint32_t index : parts.found) {
    if (!accepts(state.shapes.valueAt(index).filter(), filter)) continue;
    const SegmentQueryInfo<S> info = samestep::segmentQuery(parts.derived.placed[index], start, end, radius);
    if (info.hit) hits.push_back({state.shapes.idAt(index), info.point, info.normal, info.alpha});
  }
}

template <Scalar S>
void Queries<S>::box(const BB<S>& box, const ShapeFilter& filter, std::vector<ShapeId>& hits) {
  const Vector<S> low(box.left, box.bottom), high(box.right, box.top);
  requirePlace(low, "Space::boxQuery: the lower left corner is ");
  requirePlace(high, "Space::boxQuery: the upper right corner is ");
  require<Fault::NegativeHalfDimensions>(low.x <= high.x && low.y <= high.y, "Space::boxQuery: from ", low,
                                         " to ", high, " goes left or down");
  hits.clear();
  parts.derived.refresh(state);
  collectFound([&](const BBTree<S>& tree, std::vector<IndexKey>& keys) { tree.collectIn(box, keys); });
  for (const std::uint32_t index : parts.found) {
    if (accepts(state.shapes.valueAt(index).filter(), filter) &&
        intersects(parts.derived.placed[index].box, box)) {
      hits.push_back(state.shapes.idAt(index));
    }
  }
}

#define SAMESTEP_EACH_SCALAR template struct Queries<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
