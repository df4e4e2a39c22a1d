// SPDX-License-Identifier: MIT
// Questions about the world as it stands, answered by rising shape id.
#include <algorithm>

#include "base/require_ieee.h"
#include "world/space_impl.h"

namespace samestep {

/// Keys of both trees in `impl.found`, sorted.
template <Scalar S>
template <class Collect>
void Space<S>::collectFound(Collect&& collect) {
  Impl& impl = *impl_;
  impl.found.clear();
  for (const BBTree<S>* tree : {&impl.dynamicTree, &impl.staticTree}) {
    collect(*tree, impl.foundInOne);
    impl.found.insert(impl.found.end(), impl.foundInOne.begin(), impl.foundInOne.end());
  }
  // total order: keys are unique
  std::sort(impl.found.begin(), impl.found.end());
}

template <Scalar S>
void Space<S>::pointQuery(const Vector<S>& point, S distance, const ShapeFilter& filter,
                          std::vector<PointHit<S>>& hits) {
  require<Fault::ValueOutOfRange>(within(point, kMaxWorldExtent<S>) && distance >= S(0) &&
                                  distance <= kMaxWorldExtent<S>);
  hits.clear();
  refreshTouched();
  const BB<S> box = BB<S>::forCircle(point, distance);
  collectFound([&](const BBTree<S>& tree, std::vector<IndexKey>& keys) { tree.collectIn(box, keys); });
  for (const std::uint32_t index : impl_->found) {
    if (!accepts(state_.shapes.valueAt(index).filter(), filter)) continue;
    const PointQueryInfo<S> info = samestep::pointQuery(impl_->placed[index], point);
    if (info.distance <= distance) {
      hits.push_back({state_.shapes.idAt(index), info.point, info.distance, info.gradient});
    }
  }
}

template <Scalar S>
void Space<S>::segmentQuery(const Vector<S>& start, const Vector<S>& end, S radius, const ShapeFilter& filter,
                            std::vector<SegmentHit<S>>& hits) {
  require<Fault::ValueOutOfRange>(within(start, kMaxWorldExtent<S>) && within(end, kMaxWorldExtent<S>) &&
                                  radius <= kMaxWorldExtent<S>);
  require<Fault::NegativeRadius>(radius >= S(0));
  hits.clear();
  refreshTouched();
  collectFound([&](const BBTree<S>& tree, std::vector<IndexKey>& keys) {
    tree.collectAlong(start, end, radius, keys);
  });
  for (const std::uint32_t index : impl_->found) {
    if (!accepts(state_.shapes.valueAt(index).filter(), filter)) continue;
    const SegmentQueryInfo<S> info = samestep::segmentQuery(impl_->placed[index], start, end, radius);
    if (info.hit) hits.push_back({state_.shapes.idAt(index), info.point, info.normal, info.alpha});
  }
}

template <Scalar S>
void Space<S>::boxQuery(const BB<S>& box, const ShapeFilter& filter, std::vector<ShapeId>& hits) {
  require<Fault::ValueOutOfRange>(within(Vector<S>(box.left, box.bottom), kMaxWorldExtent<S>) &&
                                  within(Vector<S>(box.right, box.top), kMaxWorldExtent<S>));
  require<Fault::NegativeHalfDimensions>(box.left <= box.right && box.bottom <= box.top);
  hits.clear();
  refreshTouched();
  collectFound([&](const BBTree<S>& tree, std::vector<IndexKey>& keys) { tree.collectIn(box, keys); });
  for (const std::uint32_t index : impl_->found) {
    if (accepts(state_.shapes.valueAt(index).filter(), filter) && intersects(impl_->placed[index].box, box)) {
      hits.push_back(state_.shapes.idAt(index));
    }
  }
}

#ifndef SAMESTEP_FIXED_ONLY
template class Space<double>;
#endif
template class Space<Fixed>;
template class Space<CheckedFixed>;
void file_of::spaceQuery() {}

}  // namespace samestep
