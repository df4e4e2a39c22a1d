// SPDX-License-Identifier: MIT
#include <samestep/bb_tree.h>

#include <algorithm>
#include <bit>

#include <samestep/make_room.h>

#include "base/budget.h"
#include "broad_phase/grid_box.h"

namespace samestep {

namespace {

/// Number of pairs found between two questions whether a search shall end.
constexpr std::size_t kFoundAtOnce = 1 << 16;

constexpr std::uint8_t kMovedHere = 1;
constexpr std::uint8_t kMovedInStatic = 2;

/// Holds no box.
template <Scalar S>
BB<S> noRoom() {
  return {S(1), S(1), S(-1), S(-1)};
}

std::uint64_t packed(IndexKey a, IndexKey b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

/// Stable counting sort by kBits of each value.
void sortByDigit(const std::vector<std::uint64_t>& from, std::vector<std::uint64_t>& to, int shift,
                 int bits) {
  constexpr int kMostBits = 11;
  std::uint32_t starts[1 << kMostBits] = {};
  const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  for (const std::uint64_t value : from) ++starts[(value >> shift) & mask];
  std::uint32_t next = 0;
  for (std::uint64_t digit = 0; digit <= mask; ++digit) {
    const std::uint32_t size = starts[digit];
    starts[digit] = next;
    next += size;
  }
  for (const std::uint64_t value : from) to[starts[(value >> shift) & mask]++] = value;
}

}  // namespace

template <Scalar S>
BBTree<S>::BBTree(BBFunc<S> boxFunc, void* context, SpatialIndex<S>* staticIndex)
    : SpatialIndex<S>(boxFunc, context, staticIndex) {}

template <Scalar S>
BBTree<S>* BBTree<S>::staticTree() const {
  return this->staticIndex() == nullptr ? nullptr : this->staticIndex()->asTree();
}

template <Scalar S>
void BBTree<S>::setMargin(S margin) {
  require<Fault::NegativeHalfDimensions>(margin >= S(0), "BBTree: margin is ", margin,
                                         " m, allowed are 0 and above");
  margin_ = margin;
  for (IndexKey key = 0; key < tree_.keyEnd(); ++key) {
    if (tree_.contains(key)) place(key, BB<S>(rooms_[key]));
  }
}

// The margins are those of Chipmunk's cpBBTree GetBB, a tenth of the size and a tenth of a second: with less
// the leaves of what moves are placed anew too often, with more there are too many candidates.
template <Scalar S>
void BBTree<S>::placeMoving(IndexKey key, const BB<S>& tight, const Vector<S>& velocity) {
  constexpr S kPartOfSize = ratio<S>(1, 7), kSeconds = ratio<S>(1, 5);
  const S x = (tight.right - tight.left) * kPartOfSize;
  const S y = (tight.top - tight.bottom) * kPartOfSize;
  const Vector<S> ahead = velocity * kSeconds;
  place(key, {tight.left + min(-x, ahead.x), tight.bottom + min(-y, ahead.y), tight.right + max(x, ahead.x),
              tight.top + max(y, ahead.y)});
}

template <Scalar S>
void BBTree<S>::place(IndexKey key, const BB<S>& room) {
  // Each key is noted once: removing it takes no memory.
  if (key >= changes_.size()) {
    changes_.resize(key + 1, 0);
    makeRoom(changed_, changes_.size());
  }
  const GridBox box = gridBox(inflate(room, margin_));
  if (tree_.contains(key)) {
    tree_.move(key, box);
  } else {
    tree_.insert(key, box);
  }
  if (key >= rooms_.size()) rooms_.resize(key + 1, noRoom<S>());
  rooms_[key] = room;
  markChanged(key);
}

template <Scalar S>
void BBTree<S>::markChanged(IndexKey key) {
  if (key >= changes_.size()) changes_.resize(key + 1, 0);
  if ((changes_[key] & kMovedHere) != 0) return;
  changes_[key] |= kMovedHere;
  changed_.push_back(key);
}

template <Scalar S>
void BBTree<S>::markAllChanged() {
  for (IndexKey key = 0; key < tree_.keyEnd(); ++key) {
    if (tree_.contains(key)) markChanged(key);
  }
}

template <Scalar S>
void BBTree<S>::remove(IndexKey object) {
  if (!tree_.contains(object)) return;
  tree_.remove(object);
  rooms_[object] = noRoom<S>();
  markChanged(object);
}

template <Scalar S>
void BBTree<S>::clear() {
  tree_.clear();
  rooms_.clear();
  pairs_.clear();
  std::fill(changes_.begin(), changes_.end(), std::uint8_t{0});
  changed_.clear();
  pairedWith_ = nullptr;
  if (BBTree* dynamic = this->dynamicIndex() == nullptr ? nullptr : this->dynamicIndex()->asTree()) {
    dynamic->pairedWith_ = nullptr;
  }
}

template <Scalar S>
void BBTree<S>::copyFrom(const BBTree& other) {
  tree_ = other.tree_;
  rooms_ = other.rooms_;
  changes_ = other.changes_;
  changed_ = other.changed_;
  makeRoom(changed_, changes_.size());
  pairs_ = other.pairs_;
  margin_ = other.margin_;
  const bool known = other.pairedWith_ != nullptr && other.pairedWith_ == other.staticIndex();
  pairedWith_ = known ? this->staticIndex() : nullptr;
}

template <Scalar S>
std::uint64_t BBTree<S>::bytes() const {
  return tree_.bytes() + rooms_.size() * sizeof(BB<S>) + changes_.size() +
         changed_.size() * sizeof(IndexKey) + pairs_.size() * sizeof(IndexKeyPair);
}

template <Scalar S>
bool BBTree<S>::updatePairs(std::uint64_t most, Budget* budget) {
  BBTree* resting = staticTree();
  if (pairedWith_ != resting) {
    pairs_.clear();
    markAllChanged();
    pairedWith_ = resting;
  }
  if (changed_.empty() && (resting == nullptr || resting->changed_.empty())) return pairs_.size() <= most;

  if (resting != nullptr) {
    if (changes_.size() < resting->changes_.size()) changes_.resize(resting->changes_.size(), 0);
    for (const IndexKey key : resting->changed_) changes_[key] |= kMovedInStatic;
  }
  dropChanged();
  if (!findChanged(resting, most, budget)) {
    found_ = {};
    return false;
  }
  sortFound();
  // Nearly all pairs are new when a world is built: such room is not needed again.
  const bool built = found_.size() > 4096 && pairs_.size() < found_.size() / 4;
  mergeFound();
  if (built) {
    found_ = {};
    sorting_ = {};
  }
  if (resting != nullptr) {
    for (const IndexKey key : resting->changed_) changes_[key] = 0;
    resting->clearChanged();
  }
  clearChanged();
  return true;
}

template <Scalar S>
void BBTree<S>::dropChanged() {
  std::size_t kept = 0;
  for (const IndexKeyPair pair : pairs_) {
    pairs_[kept] = pair;
    kept += (changes_[pair.a] | changes_[pair.b]) == 0 ? 1 : 0;
  }
  pairs_.resize(kept);
}

// Each pair once: of two changed leaves of this tree the lower key finds it, of a changed one here and one in
// the static tree the one here.
template <Scalar S>
bool BBTree<S>::findChanged(const BBTree* resting, std::uint64_t most, Budget* budget) {
  found_.clear();
  std::size_t asked = 0;
  const auto tooMany = [&] {
    if (budget != nullptr && found_.size() - asked >= kFoundAtOnce) {
      asked = found_.size();
      budget->pay(0);
    }
    return pairs_.size() + found_.size() > most;
  };
  for (const IndexKey key : changed_) {
    if (!tree_.contains(key)) continue;
    tree_.queryAround(key, [&](IndexKey other) {
      const bool othersTurn = other < key && (changes_[other] & kMovedHere) != 0;
      if (!othersTurn) found_.push_back(packed(key, other));
    });
    if (resting != nullptr) {
      resting->tree_.query(tree_.box(key), [&](IndexKey other) { found_.push_back(packed(key, other)); });
    }
    if (tooMany()) return false;
  }
  if (resting == nullptr) return !tooMany();
  for (const IndexKey key : resting->changed_) {
    if (!resting->tree_.contains(key)) continue;
    tree_.query(resting->tree_.box(key), [&](IndexKey other) {
      if ((changes_[other] & kMovedHere) == 0) found_.push_back(packed(key, other));
    });
    if (tooMany()) return false;
  }
  // The pairs that were known may be too many by themselves.
  return !tooMany();
}

// Radix sort: two keys of a few digits each.
template <Scalar S>
void BBTree<S>::sortFound() {
  constexpr std::size_t kFew = 48;
  if (found_.size() <= kFew) {
    // total order: integers
    std::sort(found_.begin(), found_.end());
    return;
  }
  const int keyBits = static_cast<int>(std::bit_width(changes_.size()));
  const int digits = (keyBits + 10) / 11;
  const int digitBits = (keyBits + digits - 1) / digits;
  sorting_.resize(found_.size());
  for (const int half : {0, 32}) {
    for (int digit = 0; digit < digits; ++digit) {
      sortByDigit(found_, sorting_, half + digit * digitBits, digitBits);
      found_.swap(sorting_);
    }
  }
}

// Merging from the back needs no second array for the old pairs.
template <Scalar S>
void BBTree<S>::mergeFound() {
  std::size_t old = pairs_.size();
  std::size_t fresh = found_.size();
  pairs_.resize(old + fresh);
  for (std::size_t to = pairs_.size(); fresh > 0; --to) {
    const std::uint64_t last = found_[fresh - 1];
    if (old > 0 && packed(pairs_[old - 1].a, pairs_[old - 1].b) > last) {
      pairs_[to - 1] = pairs_[--old];
    } else {
      pairs_[to - 1] = {static_cast<IndexKey>(last >> 32), static_cast<IndexKey>(last)};
      --fresh;
    }
  }
}

template <Scalar S>
void BBTree<S>::clearChanged() {
  for (const IndexKey key : changed_) changes_[key] = 0;
  changed_.clear();
}

template <Scalar S>
void BBTree<S>::collectAt(const Vector<S>& point, std::vector<IndexKey>& keys) const {
  collectIn({point.x, point.y, point.x, point.y}, keys);
}

template <Scalar S>
GridBox BBTree<S>::areaOf(const BB<S>& box) {
  return gridBox(box);
}

template <Scalar S>
GridSegment BBTree<S>::areaOf(const Vector<S>& a, const Vector<S>& b, S radius) {
  const BB<S> span(min(a.x, b.x), min(a.y, b.y), max(a.x, b.x), max(a.y, b.y));
  return {gridBox(inflate(span, radius)),
          {gridFloor(a.x), gridFloor(b.x)},
          {gridFloor(a.y), gridFloor(b.y)},
          gridCeil(radius),
          onGrid(a) && onGrid(b) && radius <= kGridEdge<S>};
}

template <Scalar S>
void BBTree<S>::collectIn(const BB<S>& box, std::vector<IndexKey>& keys) const {
  keys.clear();
  tree_.query(areaOf(box), [&keys](IndexKey key) { keys.push_back(key); });
  // total order: keys are unique
  std::sort(keys.begin(), keys.end());
}

template <Scalar S>
void BBTree<S>::collectAlong(const Vector<S>& a, const Vector<S>& b, S radius,
                             std::vector<IndexKey>& keys) const {
  keys.clear();
  tree_.query(areaOf(a, b, radius), [&keys](IndexKey key) { keys.push_back(key); });
  // total order: keys are unique
  std::sort(keys.begin(), keys.end());
}

template <Scalar S>
void BBTree<S>::each(IteratorFunc visit, void* context) const {
  for (IndexKey key = 0; key < tree_.keyEnd(); ++key) {
    if (tree_.contains(key)) visit(context, key);
  }
}

template <Scalar S>
void BBTree<S>::refresh(IndexKey object) {
  const BB<S> tight = this->boxOf(object);
  if (velocityOf_ != nullptr) {
    update(object, tight, velocityOf_(this->context(), object));
  } else {
    update(object, tight);
  }
}

template <Scalar S>
void BBTree<S>::insert(IndexKey object) {
  refresh(object);
}

template <Scalar S>
void BBTree<S>::reindexObject(IndexKey object) {
  if (tree_.contains(object)) refresh(object);
}

template <Scalar S>
void BBTree<S>::reindex() {
  for (IndexKey key = 0; key < tree_.keyEnd(); ++key) reindexObject(key);
}

template <Scalar S>
void BBTree<S>::query(IndexKey object, const BB<S>& box, QueryFunc found, void* context) const {
  tree_.query(gridBox(box), [=](IndexKey other) {
    if (other != object) found(context, object, other);
  });
}

template <Scalar S>
void BBTree<S>::setVelocityFunc(VelocityFunc<S> velocityOf, Remarks*) {
  velocityOf_ = velocityOf;
}

template <Scalar S>
void BBTree<S>::reindexQuery(QueryFunc found, void* context) {
  reindex();
  const SpatialIndex<S>* resting = this->staticIndex();
  const bool cached = this->dynamicIndex() == nullptr && (resting == nullptr || staticTree() != nullptr);
  if (cached) {
    updatePairs();
    for (const IndexKeyPair& pair : pairs_) found(context, pair.a, pair.b);
    return;
  }
  for (const IndexKeyPair& pair : pairsAfresh()) found(context, pair.a, pair.b);
}

// This serves a static tree, whose changes are its dynamic tree's to take up, and a static index that is no
// tree.
template <Scalar S>
std::vector<IndexKeyPair> BBTree<S>::pairsAfresh() const {
  std::vector<IndexKeyPair> all;
  for (IndexKey key = 0; key < tree_.keyEnd(); ++key) {
    if (!tree_.contains(key)) continue;
    tree_.queryAround(key, [&all, key](IndexKey other) {
      if (key < other) all.push_back({key, other});
    });
  }
  if (this->staticIndex() != nullptr) {
    const auto add = [](void* to, IndexKey a, IndexKey b) {
      static_cast<std::vector<IndexKeyPair>*>(to)->push_back({std::min(a, b), std::max(a, b)});
    };
    this->collideStatic(*this->staticIndex(), add, &all);
  }
  // total order: pairs of integers
  std::sort(all.begin(), all.end());
  return all;
}

#define SAMESTEP_EACH_SCALAR template class BBTree<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
