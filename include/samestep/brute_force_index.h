// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/spatial_index.h>

namespace samestep {

/// A spatial index that compares every box with every other: O(n) per query, O(n^2) for all pairs. Right for
/// a handful of objects, and what the tree is tested against. Its answers are exact.
template <Scalar S>
class BruteForceIndex final : public SpatialIndex<S> {
 public:
  explicit BruteForceIndex(BBFunc<S> boxFunc, void* context = nullptr,
                           SpatialIndex<S>* staticIndex = nullptr);

  std::uint32_t count() const override;
  void each(IteratorFunc visit, void* context) const override;
  bool contains(IndexKey object) const override;
  void insert(IndexKey object) override;
  void remove(IndexKey object) override;
  void reindex() override;
  void reindexObject(IndexKey object) override;
  /// Reports by rising key.
  void query(IndexKey object, const BB<S>& box, QueryFunc found, void* context) const override;
  void reindexQuery(QueryFunc found, void* context) override;

 private:
  struct Entry {
    IndexKey key;
    BB<S> box;
  };

  std::vector<Entry> entries_;  ///< Sorted by rising key.
};

#define SAMESTEP_EACH_SCALAR extern template class BruteForceIndex<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
