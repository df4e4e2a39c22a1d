// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <samestep/error.h>
#include <samestep/id.h>

namespace samestep {

/// Values named by ids: a slot and its generation. Every id given out names one value for ever: after erase
/// it names nothing, whatever later uses the slot.
///
/// A generation is odd while the slot is in use; insert and erase each raise it by one. Freed slots are used
/// again last-in first-out, and the list of them is part of the state: a copy, or one restored from
/// generations(), freeList() and the values, gives out the same ids as the original. A free slot holds T().
/// References last until the next insert.
template <class T, class IdType>
class SlotMap {
 public:
  /// The last even generation: a slot that reaches it is never used again.
  static constexpr std::uint32_t kRetired = 0xfffffffeu;

  /// Values in use.
  std::uint32_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// Slots ever used: every index is below this.
  std::uint32_t slots() const { return static_cast<std::uint32_t>(generations_.size()); }

  /// The id that the next insert will give.
  IdType nextId() const {
    const std::uint32_t slot = free_.empty() ? slots() : free_.back();
    return makeId(slot, free_.empty() ? 1 : generations_[slot] + 1);
  }

  /// Stores the value in the slot freed last, or a new one.
  /// @throws IllegalSize when no index is left
  IdType insert(T value) {
    const IdType id = nextId();
    if (free_.empty()) {
      require<Fault::IllegalSize>(slots() < IdType::kNoIndex);
      values_.push_back(std::move(value));
      generations_.push_back(id.generation);
      // So that erase never allocates.
      free_.reserve(values_.capacity());
    } else {
      free_.pop_back();
      values_[id.index] = std::move(value);
      generations_[id.index] = id.generation;
    }
    ++size_;
    return id;
  }

  /// Frees the slot. False, and nothing done, if the id names no value.
  bool erase(IdType id) {
    if (!contains(id)) return false;
    values_[id.index] = T();
    if (++generations_[id.index] != kRetired) free_.push_back(id.index);
    --size_;
    return true;
  }

  bool contains(IdType id) const {
    return id.index < slots() && generations_[id.index] == id.generation && aliveAt(id.index);
  }
  /// @pre slot < slots()
  bool aliveAt(std::uint32_t slot) const { return (generations_[slot] & 1) != 0; }
  /// The id of the value in a slot. @pre slot < slots() and aliveAt(slot)
  IdType idAt(std::uint32_t slot) const { return makeId(slot, generations_[slot]); }

  /// @throws the exception of fault F if the id names no value
  template <Fault F>
  T& at(IdType id) {
    require<F>(contains(id));
    return values_[id.index];
  }
  template <Fault F>
  const T& at(IdType id) const {
    require<F>(contains(id));
    return values_[id.index];
  }
  /// The value or null.
  T* find(IdType id) { return contains(id) ? &values_[id.index] : nullptr; }
  const T* find(IdType id) const { return contains(id) ? &values_[id.index] : nullptr; }

  /// What is in a slot, without a check. @pre slot < slots()
  T& valueAt(std::uint32_t slot) { return values_[slot]; }
  const T& valueAt(std::uint32_t slot) const { return values_[slot]; }
  std::uint32_t generationAt(std::uint32_t slot) const { return generations_[slot]; }

  /// Calls visit(id, value) for each value, by rising index. visit may erase the value it is given.
  template <class Visit>
  void each(Visit&& visit) {
    for (std::uint32_t slot = 0; slot < slots(); ++slot) {
      if (aliveAt(slot)) visit(idAt(slot), values_[slot]);
    }
  }
  template <class Visit>
  void each(Visit&& visit) const {
    for (std::uint32_t slot = 0; slot < slots(); ++slot) {
      if (aliveAt(slot)) visit(idAt(slot), values_[slot]);
    }
  }

  /// Empties the map and forgets all ids: it gives out the same ones again.
  void clear() {
    values_.clear();
    generations_.clear();
    free_.clear();
    size_ = 0;
  }

  /// The state for writing: all three belong to it. One value per slot, T() where the slot is free.
  const std::vector<T>& values() const { return values_; }
  const std::vector<std::uint32_t>& generations() const { return generations_; }
  /// Free slots, the next one to be used last.
  const std::vector<std::uint32_t>& freeList() const { return free_; }

  /// Takes over a state as the accessors gave it. False, and nothing changed, unless there is one generation
  /// per value and the free list names each free slot that is not retired exactly once. Values of free slots
  /// are set to T().
  [[nodiscard]] bool restore(std::vector<T> values, std::vector<std::uint32_t> generations,
                             std::vector<std::uint32_t> freeList) {
    if (values.size() != generations.size() || values.size() >= IdType::kNoIndex) return false;
    std::vector<bool> listed(values.size(), false);
    for (const std::uint32_t slot : freeList) {
      if (slot >= values.size() || listed[slot]) return false;
      listed[slot] = true;
    }
    std::uint32_t used = 0;
    for (std::size_t slot = 0; slot < values.size(); ++slot) {
      const bool live = (generations[slot] & 1) != 0;
      const bool reusable = !live && generations[slot] != kRetired;
      if (listed[slot] != reusable) return false;
      if (live) ++used;
      if (!live) values[slot] = T();
    }
    values_ = std::move(values);
    generations_ = std::move(generations);
    free_ = std::move(freeList);
    free_.reserve(values_.capacity());
    size_ = used;
    return true;
  }

  friend bool operator==(const SlotMap&, const SlotMap&) = default;

 private:
  static IdType makeId(std::uint32_t index, std::uint32_t generation) {
    IdType id;
    id.index = index;
    id.generation = generation;
    return id;
  }

  std::vector<T> values_;
  std::vector<std::uint32_t> generations_;
  std::vector<std::uint32_t> free_;
  std::uint32_t size_ = 0;
};

}  // namespace samestep
