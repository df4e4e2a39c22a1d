// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <samestep/box_tree.h>
#include <samestep/spatial_index.h>

namespace samestep {

class Budget;

/// The broad phase: a spatial index that keeps, between calls, a tree of boxes and the sorted list of pairs
/// that may touch. MIS section 15.
///
/// The tree stores fat boxes: the tight box with room to move (a seventh of its size, or a fifth of a second
/// of its velocity), plus a margin. Only a leaf that has left its room is put in again and paired anew.
/// Everything here is a cache: which candidates appear beyond those whose tight boxes plus margin overlap
/// depends on the history; those never do. Candidates come sorted, so the tree's shape never shows.
///
/// A dynamic tree pairs its objects with each other and with those of its static index.
template <Scalar S>
class BBTree final : public SpatialIndex<S> {
 public:
  /// An empty tree; see SpatialIndex for the parameters.
  /// MIS: BBTreeNew, BBTreeInit
  explicit BBTree(BBFunc<S> boxFunc = nullptr, void* context = nullptr,
                  SpatialIndex<S>* staticIndex = nullptr);

  // The interface of Space: no callbacks, nothing allocated once warm.

  /// Metres by which each tight box is grown on every side before boxes are compared; 0 unless set. All
  /// objects are paired anew.
  /// @param margin >= 0
  /// @throws NegativeHalfDimensions
  void setMargin(S margin);
  S margin() const { return margin_; }

  /// Tells where a moving object is, and inserts it if it is new. True if its leaf was placed anew, false,
  /// at the cost of one comparison, if it is still within its room.
  /// @throws IndexOutOfBounds if key >= 2^24
  [[gnu::always_inline]] bool update(IndexKey key, const BB<S>& tight, const Vector<S>& velocity) {
    if (key < rooms_.size() && samestep::contains(rooms_[key], tight)) return false;
    placeMoving(key, tight, velocity);
    return true;
  }
  /// Updates an object that rests: its room is the tight box.
  [[gnu::always_inline]] bool update(IndexKey key, const BB<S>& tight) {
    if (key < rooms_.size() && rooms_[key] == tight) return false;
    place(key, tight);
    return true;
  }

  /// Brings pairs() up to date with all changes of this tree and its static one. Costs O(pairs + changed log
  /// n), and nothing if nothing changed.
  /// @param most  how many there may be; beyond them the search ends at once, to begin anew next time
  /// @param budget  asked now and then; null for none
  /// @return false if there are more, and pairs() lacks some
  /// @throws Interrupted: the next call begins anew
  bool updatePairs(std::uint64_t most = std::numeric_limits<std::uint64_t>::max(), Budget* budget = nullptr);
  /// Candidates as of the last updatePairs, sorted: every pair whose tight boxes, both grown by the margin,
  /// overlap, and some more. An object removed since may still be named.
  const std::vector<IndexKeyPair>& pairs() const { return pairs_; }

  /// The areas that a search of boxes() looks into for a box, and for a segment of a half thickness.
  static GridBox areaOf(const BB<S>& box);
  static GridSegment areaOf(const Vector<S>& a, const Vector<S>& b, S radius);
  /// Replaces `keys` by the objects that may contain the point or touch the box or the segment of the given
  /// half thickness (metres, >= 0), by rising key.
  void collectAt(const Vector<S>& point, std::vector<IndexKey>& keys) const;
  void collectIn(const BB<S>& box, std::vector<IndexKey>& keys) const;
  void collectAlong(const Vector<S>& a, const Vector<S>& b, S radius, std::vector<IndexKey>& keys) const;

  /// Forgets all objects and pairs; keeps functions, margin and static index.
  void clear();
  /// Builds a balanced tree from the same leaves. No answer changes.
  void rebuild() { tree_.rebuild(); }
  /// Takes over objects, pairs and margin of another tree, for a saved world: not the functions, nor the
  /// static index, whose content must be taken over as well.
  void copyFrom(const BBTree& other);
  /// Bytes that copyFrom copies.
  std::uint64_t bytes() const;
  const BoxTree& boxes() const { return tree_; }

  // The interface of the MIS.

  std::uint32_t count() const override { return tree_.count(); }
  void each(IteratorFunc visit, void* context) const override;
  bool contains(IndexKey object) const override { return tree_.contains(object); }
  void insert(IndexKey object) override;
  void remove(IndexKey object) override;
  void reindex() override;
  void reindexObject(IndexKey object) override;
  /// Searches the fat boxes.
  void query(IndexKey object, const BB<S>& box, QueryFunc found, void* context) const override;
  /// A static tree's own pairs are not kept between calls.
  void reindexQuery(QueryFunc found, void* context) override;
  /// Null: boxes are not stretched. MIS: BBTreeSetVelocityFunc
  void setVelocityFunc(VelocityFunc<S> velocityOf, Remarks* remarks) override;
  BBTree* asTree() override { return this; }

 private:
  void placeMoving(IndexKey key, const BB<S>& tight, const Vector<S>& velocity);
  void place(IndexKey key, const BB<S>& room);
  void markChanged(IndexKey key);
  void markAllChanged();
  void refresh(IndexKey object);
  void dropChanged();
  bool findChanged(const BBTree* resting, std::uint64_t most, Budget* budget);
  void sortFound();
  void mergeFound();
  void clearChanged();
  std::vector<IndexKeyPair> pairsAfresh() const;
  BBTree* staticTree() const;

  BoxTree tree_;
  /// Room of each key: where the tight box may be without its leaf being placed anew; a box that holds
  /// nothing if the object is not here.
  std::vector<BB<S>> rooms_;
  /// Changes of each key: kMovedHere, kMovedInStatic.
  std::vector<std::uint8_t> changes_;
  std::vector<IndexKey> changed_;  ///< The keys with kMovedHere, each once.
  std::vector<IndexKeyPair> pairs_;
  std::vector<std::uint64_t> found_;    ///< Scratch: new pairs, packed.
  std::vector<std::uint64_t> sorting_;  ///< Scratch.
  VelocityFunc<S> velocityOf_ = nullptr;
  S margin_{};
  const SpatialIndex<S>* pairedWith_ = nullptr;  ///< The static index that pairs_ knows.
};

#define SAMESTEP_EACH_SCALAR extern template class BBTree<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
