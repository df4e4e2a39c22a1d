// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <samestep/error.h>

namespace samestep {

using HashValue = std::uint64_t;

/// MIS: HASH_COEF
inline constexpr HashValue kHashCoef = 3344921057u;

/// One bucket hash for two, the same for (a, b) and (b, a), 64 bits wide on every machine. Different pairs
/// may share it (all (x, x) do), so it only ever stands beside an equality test. MIS: HASH_PAIR
constexpr HashValue hashPair(HashValue a, HashValue b) { return (a * kHashCoef) ^ (b * kHashCoef); }

/// A set of elements found by a hash from the caller and an equality test.
///
/// Order: `each` and `filter` visit in order of insertion. An erased element leaves the others in their
/// order, and inserted again it goes to the end. Nothing depends on std::hash or on addresses, so the order
/// is the same on every machine; a copy has the order of its original.
///
/// `Equal` is a function object: bool operator()(const Key& key, const T& element) const, for whatever Key
/// the calls use. Inserting moves elements: references last until the next insert.
/// The functions passed to insert, each and filter must not change the set. MIS section 16.
template <class T, class Equal>
class HashSet {
 public:
  /// The MIS's limit on the number of buckets.
  static constexpr std::size_t kMaxSize = 1610612741;
  /// The MIS's BUFFER_BYTES: no element may be larger.
  static constexpr std::size_t kBufferBytes = 32 * 1024;

  /// Empty, with room for `size` elements before it grows.
  /// @throws IllegalSize if size > kMaxSize
  /// MIS: hashSetNew
  explicit HashSet(std::size_t size = 0, Equal equal = {}) : equal_(std::move(equal)) {
    require<Fault::IllegalSize>(size <= kMaxSize);
    if (size > 0) reindex(bucketsFor(size));
  }

  /// Value that find and remove return for an element that is not there; T() unless set.
  /// MIS: hashSetSetDefaultValue
  void setDefaultValue(T value) { default_ = std::move(value); }
  const T& defaultValue() const { return default_; }

  /// MIS: hashSetCount
  std::size_t count() const { return count_; }

  /// The element equal to key; if there is none, the new element transform(key). O(1) on average.
  /// @throws InsufficientBufferSize, IllegalSize
  /// MIS: hashSetInsert
  template <class Key, class Transform>
  T& insert(HashValue hash, const Key& key, Transform&& transform) {
    require<Fault::InsufficientBufferSize>(sizeof(Bin) <= kBufferBytes);
    if (const Index found = locate(hash, key); found != kNone) return bins_[found].element;
    makeRoom();
    Index& head = heads_[bucket(hash)];
    bins_.push_back({transform(key), hash, head, true});
    head = static_cast<Index>(bins_.size() - 1);
    ++count_;
    return bins_.back().element;
  }
  /// Inserts the key itself as the new element.
  T& insert(HashValue hash, const T& key) {
    return insert(hash, key, [](const T& element) { return element; });
  }

  /// Takes the element equal to key out and returns it; nothing if there is none. O(1) on average.
  /// MIS: hashSetRemove
  template <class Key>
  std::optional<T> remove(HashValue hash, const Key& key) {
    if (heads_.empty()) return std::nullopt;
    for (Index* link = &heads_[bucket(hash)]; *link != kNone; link = &bins_[*link].next) {
      Bin& bin = bins_[*link];
      if (!matches(bin, hash, key)) continue;
      std::optional<T> removed(std::move(bin.element));
      *link = bin.next;
      bury(bin);
      return removed;
    }
    return std::nullopt;
  }

  /// The element equal to key, or the default value. O(1) on average. MIS: hashSetFind
  template <class Key>
  const T& find(HashValue hash, const Key& key) const {
    const Index found = locate(hash, key);
    return found == kNone ? default_ : bins_[found].element;
  }

  /// The element equal to key, or null. What the equality test reads of it must not be changed.
  template <class Key>
  T* lookup(HashValue hash, const Key& key) {
    const Index found = locate(hash, key);
    return found == kNone ? nullptr : &bins_[found].element;
  }
  template <class Key>
  const T* lookup(HashValue hash, const Key& key) const {
    const Index found = locate(hash, key);
    return found == kNone ? nullptr : &bins_[found].element;
  }

  /// Calls visit(element) in order of insertion. MIS: hashSetEach
  template <class Visit>
  void each(Visit&& visit) {
    for (Bin& bin : bins_) {
      if (bin.alive) visit(bin.element);
    }
  }
  template <class Visit>
  void each(Visit&& visit) const {
    for (const Bin& bin : bins_) {
      if (bin.alive) visit(bin.element);
    }
  }

  /// Keeps the elements for which keep(element) is true; asked in order of insertion. O(all).
  /// MIS: hashSetFilter
  template <class Keep>
  void filter(Keep&& keep) {
    for (Bin& bin : bins_) {
      if (bin.alive && !keep(bin.element)) bury(bin);
    }
    compact();
  }

  /// Empties the set; its room stays.
  void clear() {
    bins_.clear();
    count_ = 0;
    for (Index& head : heads_) head = kNone;
  }

 private:
  using Index = std::uint32_t;
  static constexpr Index kNone = 0xffffffffu;
  static constexpr std::size_t kFewestBuckets = 8;

  struct Bin {
    T element;
    HashValue hash;
    Index next;
    bool alive;
  };

  static std::size_t bucketsFor(std::size_t size) {
    return std::bit_ceil(size < kFewestBuckets ? kFewestBuckets : size);
  }

  std::size_t bucket(HashValue hash) const {
    // The high half of the product depends on every bit of the hash.
    const HashValue mixed = (hash ^ (hash >> 32)) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(mixed >> 32) & (heads_.size() - 1);
  }

  template <class Key>
  Index locate(HashValue hash, const Key& key) const {
    if (heads_.empty()) return kNone;
    for (Index i = heads_[bucket(hash)]; i != kNone; i = bins_[i].next) {
      if (matches(bins_[i], hash, key)) return i;
    }
    return kNone;
  }

  template <class Key>
  bool matches(const Bin& bin, HashValue hash, const Key& key) const {
    return bin.alive && bin.hash == hash && equal_(key, bin.element);
  }

  /// The gap stays in bins_ until compact(), so that erasing costs O(1) and keeps the order.
  void bury(Bin& bin) {
    bin.element = T();
    bin.alive = false;
    --count_;
  }

  void compact() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
      if (!bins_[i].alive) continue;
      if (kept != i) bins_[kept] = std::move(bins_[i]);
      ++kept;
    }
    bins_.erase(bins_.begin() + static_cast<std::ptrdiff_t>(kept), bins_.end());
    relink();
  }

  void reindex(std::size_t buckets) {
    heads_.resize(buckets);
    bins_.reserve(buckets);
    relink();
  }

  void relink() {
    for (Index& head : heads_) head = kNone;
    for (Index i = 0; i < bins_.size(); ++i) {
      if (!bins_[i].alive) continue;
      Index& head = heads_[bucket(bins_[i].hash)];
      bins_[i].next = head;
      head = i;
    }
  }

  /// One free bin at the end. Growing only when three quarters are alive keeps a set of steady size from
  /// allocating, and pays for each compaction with at least a quarter of the bins erased since the last.
  void makeRoom() {
    if (bins_.size() < heads_.size()) return;
    const bool grow = 4 * count_ >= 3 * heads_.size();
    require<Fault::IllegalSize>(!grow || 2 * heads_.size() <= std::bit_ceil(kMaxSize));
    compact();
    if (grow) reindex(bucketsFor(2 * heads_.size()));
  }

  std::vector<Index> heads_;  ///< A power of two of bucket heads, as many as bins_ may hold.
  std::vector<Bin> bins_;     ///< Bins in order of insertion, with gaps.
  // not state: follows from the elements
  std::size_t count_ = 0;
  T default_{};
  Equal equal_;
};

}  // namespace samestep
