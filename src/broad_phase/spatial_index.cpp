// SPDX-License-Identifier: MIT
#include <samestep/spatial_index.h>

#include <algorithm>

namespace samestep {

template <Scalar S>
SpatialIndex<S>::SpatialIndex(BBFunc<S> boxFunc, void* context, SpatialIndex* staticIndex)
    : boxFunc_(boxFunc), context_(context), staticIndex_(staticIndex) {
  if (staticIndex == nullptr) return;
  require<Fault::AttachedStaticIndex>(staticIndex->dynamicIndex_ == nullptr);
  staticIndex->dynamicIndex_ = this;
}

template <Scalar S>
SpatialIndex<S>::~SpatialIndex() {
  if (staticIndex_ != nullptr) staticIndex_->dynamicIndex_ = nullptr;
  if (dynamicIndex_ != nullptr) dynamicIndex_->staticIndex_ = nullptr;
}

template <Scalar S>
void SpatialIndex<S>::setVelocityFunc(VelocityFunc<S>, Remarks* remarks) {
  if (remarks == nullptr) return;
  remarks->raise(Remark::NotBBTreeWarn, "Ignoring BBTreeSetVelocityFunc() call to non-tree spatial index.");
}

template <Scalar S>
BB<S> SpatialIndex<S>::boxOf(IndexKey object) const {
  require<Fault::MissingCallback>(boxFunc_ != nullptr);
  return boxFunc_(context_, object);
}

template <Scalar S>
void SpatialIndex<S>::collect(const BB<S>& box, std::vector<IndexKey>& keys, IndexKey object) const {
  keys.clear();
  const auto add = [](void* to, IndexKey, IndexKey found) {
    static_cast<std::vector<IndexKey>*>(to)->push_back(found);
  };
  query(object, box, add, &keys);
  // total order: keys are unique
  std::sort(keys.begin(), keys.end());
}

template <Scalar S>
void SpatialIndex<S>::collideStatic(const SpatialIndex& other, QueryFunc found, void* context) const {
  if (other.count() == 0) return;
  struct Call {
    const SpatialIndex& self;
    const SpatialIndex& other;
    QueryFunc found;
    void* context;
    std::vector<IndexKey> keys;
  };
  Call call{*this, other, found, context, {}};
  const auto collideOne = [](void* data, IndexKey object) {
    Call& c = *static_cast<Call*>(data);
    c.other.collect(c.self.boxOf(object), c.keys, object);
    for (const IndexKey key : c.keys) c.found(c.context, object, key);
  };
  each(collideOne, &call);
}

#define SAMESTEP_EACH_SCALAR template class SpatialIndex<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
