// SPDX-License-Identifier: MIT
#include "world/queries.h"

#include <algorithm>

#include "base/require_ieee.h"

namespace samestep {

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
  require<Fault::ValueOutOfRange>(within(point, kMaxWorldExtent<S>) && distance >= S(0) &&
                                  distance <= kMaxWorldExtent<S>);
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
  require<Fault::ValueOutOfRange>(within(start, kMaxWorldExtent<S>) && within(end, kMaxWorldExtent<S>) &&
                                  radius <= kMaxWorldExtent<S>);
  require<Fault::NegativeRadius>(radius >= S(0));
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
  require<Fault::ValueOutOfRange>(within(Vector<S>(box.left, box.bottom), kMaxWorldExtent<S>) &&
                                  within(Vector<S>(box.right, box.top), kMaxWorldExtent<S>));
  require<Fault::NegativeHalfDimensions>(box.left <= box.right && box.bottom <= box.top);
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
