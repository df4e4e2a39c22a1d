// SPDX-License-Identifier: MIT
#include <samestep/brute_force_index.h>

#include <algorithm>

#include <samestep/box_tree.h>

namespace samestep {

namespace {

template <class Entries>
auto firstFrom(Entries& entries, IndexKey key) {
  return std::lower_bound(entries.begin(), entries.end(), key,
                          [](const auto& entry, IndexKey k) { return entry.key < k; });
}

}  // namespace

template <Scalar S>
BruteForceIndex<S>::BruteForceIndex(BBFunc<S> boxFunc, void* context, SpatialIndex<S>* staticIndex)
    : SpatialIndex<S>(boxFunc, context, staticIndex) {}

template <Scalar S>
std::uint32_t BruteForceIndex<S>::count() const {
  return static_cast<std::uint32_t>(entries_.size());
}

template <Scalar S>
void BruteForceIndex<S>::each(IteratorFunc visit, void* context) const {
  for (const Entry& entry : entries_) visit(context, entry.key);
}

template <Scalar S>
bool BruteForceIndex<S>::contains(IndexKey object) const {
  const auto at = firstFrom(entries_, object);
  return at != entries_.end() && at->key == object;
}

template <Scalar S>
void BruteForceIndex<S>::insert(IndexKey object) {
  require<Fault::IndexOutOfBounds>(object < BoxTree::kMaxKeys, "an index: key is ", object,
                                   ", allowed are 0 to ", BoxTree::kMaxKeys - 1);
  const BB<S> box = this->boxOf(object);
  const auto at = firstFrom(entries_, object);
  if (at != entries_.end() && at->key == object) {
    at->box = box;
  } else {
    entries_.insert(at, {object, box});
  }
}

template <Scalar S>
void BruteForceIndex<S>::remove(IndexKey object) {
  const auto at = firstFrom(entries_, object);
  if (at != entries_.end() && at->key == object) entries_.erase(at);
}

template <Scalar S>
void BruteForceIndex<S>::reindex() {
  for (Entry& entry : entries_) entry.box = this->boxOf(entry.key);
}

template <Scalar S>
void BruteForceIndex<S>::reindexObject(IndexKey object) {
  if (contains(object)) insert(object);
}

template <Scalar S>
void BruteForceIndex<S>::query(IndexKey object, const BB<S>& box, QueryFunc found, void* context) const {
  for (const Entry& entry : entries_) {
    if (entry.key != object && intersects(box, entry.box)) found(context, object, entry.key);
  }
}

template <Scalar S>
void BruteForceIndex<S>::reindexQuery(QueryFunc found, void* context) {
  reindex();
  std::vector<IndexKeyPair> pairs;
  const auto add = [](void* to, IndexKey a, IndexKey b) {
    static_cast<std::vector<IndexKeyPair>*>(to)->push_back({std::min(a, b), std::max(a, b)});
  };
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    for (std::size_t j = i + 1; j < entries_.size(); ++j) {
      if (intersects(entries_[i].box, entries_[j].box)) add(&pairs, entries_[i].key, entries_[j].key);
    }
  }
  if (this->staticIndex() != nullptr) this->collideStatic(*this->staticIndex(), add, &pairs);
  // total order: pairs of integers
  std::sort(pairs.begin(), pairs.end());
  for (const IndexKeyPair& pair : pairs) found(context, pair.a, pair.b);
}

#define SAMESTEP_EACH_SCALAR template class BruteForceIndex<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
