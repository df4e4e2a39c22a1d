// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/bb.h>
#include <samestep/error.h>
#include <samestep/remark.h>
#include <samestep/vector.h>

namespace samestep {

template <Scalar S>
class BBTree;

/// Names an object of an index: a small number, such as the slot of a shape. Below 2^24.
using IndexKey = std::uint32_t;
/// No object.
inline constexpr IndexKey kNoKey = 0xffffffffu;

/// Two objects whose boxes may overlap, lower key first; ordered by lower, then higher key.
struct IndexKeyPair {
  IndexKey a;
  IndexKey b;

  friend constexpr bool operator==(const IndexKeyPair&, const IndexKeyPair&) = default;
  friend constexpr auto operator<=>(const IndexKeyPair&, const IndexKeyPair&) = default;
};

/// The tight box of an object, world coordinates, metres.
template <Scalar S>
using BBFunc = BB<S> (*)(void* context, IndexKey object);
/// The velocity of an object, m/s. MIS: BBTreeVelocityFunc
template <Scalar S>
using VelocityFunc = Vector<S> (*)(void* context, IndexKey object);
using IteratorFunc = void (*)(void* context, IndexKey object);
/// One object found for another. Warm-start ids live in the pair's own record, not here.
using QueryFunc = void (*)(void* context, IndexKey object, IndexKey found);

/// A set of objects, each with a box, that answers which boxes overlap. MIS section 12.
///
/// An answer holds every object whose tight box, at the last insert or reindex, overlaps the question; an
/// index that stores larger boxes may give some more, so the caller compares tight boxes to get the same
/// answer from every kind of index. The functions passed in must not change the index.
///
/// A dynamic index may have one static index. Both share one range of keys, and an object is in one of them.
template <Scalar S>
class SpatialIndex {
 public:
  /// @param boxFunc     asked at insert and reindex; may be null if those are never called
  /// @param context     passed to boxFunc and to the velocity function
  /// @param staticIndex paired with this dynamic index by reindexQuery; may be null
  /// @throws AttachedStaticIndex if it already has a dynamic index
  /// MIS: spatialIndexInit
  SpatialIndex(BBFunc<S> boxFunc, void* context, SpatialIndex* staticIndex);
  SpatialIndex(const SpatialIndex&) = delete;
  SpatialIndex& operator=(const SpatialIndex&) = delete;
  /// Parts the association with the static or dynamic index. MIS: spatialIndexDestroy
  virtual ~SpatialIndex();

  SpatialIndex* staticIndex() const { return staticIndex_; }
  SpatialIndex* dynamicIndex() const { return dynamicIndex_; }

  /// MIS: spatialIndexCount
  virtual std::uint32_t count() const = 0;
  /// Visits by rising key. MIS: spatialIndexEach
  virtual void each(IteratorFunc visit, void* context) const = 0;
  /// MIS: spatialIndexContains
  virtual bool contains(IndexKey object) const = 0;
  /// An object that is already there is reindexed.
  /// @throws IndexOutOfBounds if the key is 2^24 or more
  /// MIS: spatialIndexInsert
  virtual void insert(IndexKey object) = 0;
  /// Does nothing if the object is not there. MIS: spatialIndexRemove
  virtual void remove(IndexKey object) = 0;
  /// Asks for the boxes of all objects anew. MIS: spatialIndexReindex
  virtual void reindex() = 0;
  /// Asks for one box anew; does nothing if the object is not there. MIS: spatialIndexReindexObject
  virtual void reindexObject(IndexKey object) = 0;
  /// Calls found(context, object, other) for each other object that may overlap the box, in an order that
  /// is not promised; see collect(). `object` itself is left out; kNoKey leaves out none.
  /// MIS: spatialIndexQuery
  virtual void query(IndexKey object, const BB<S>& box, QueryFunc found, void* context) const = 0;
  /// reindex(), then found(context, a, b) for each pair a < b of objects that may overlap, by rising a,
  /// then b. Pairs of an object with one of the static index are among them, those within the static index
  /// are not. MIS: spatialIndexReindexQuery
  virtual void reindexQuery(QueryFunc found, void* context) = 0;
  /// Sets the function that lets a tree stretch boxes along the motion. An index that is no tree ignores it
  /// and raises the remark NotBBTreeWarn, if given where. MIS: BBTreeSetVelocityFunc
  virtual void setVelocityFunc(VelocityFunc<S> velocityOf, Remarks* remarks);
  /// This index as a tree, or null.
  virtual BBTree<S>* asTree() { return nullptr; }

  /// Replaces `keys` by what a query gives, by rising key.
  void collect(const BB<S>& box, std::vector<IndexKey>& keys, IndexKey object = kNoKey) const;

  /// Calls found(context, object, other) for each object of this index and each of `other` that may overlap
  /// its box; by rising key of object, then of other. MIS: spatialIndexCollideStatic
  void collideStatic(const SpatialIndex& other, QueryFunc found, void* context) const;

 protected:
  /// @throws MissingCallback without a box function
  BB<S> boxOf(IndexKey object) const;
  void* context() const { return context_; }

 private:
  BBFunc<S> boxFunc_;
  void* context_;
  SpatialIndex* staticIndex_;
  SpatialIndex* dynamicIndex_ = nullptr;
};

#define SAMESTEP_EACH_SCALAR extern template class SpatialIndex<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
