// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <samestep/error.h>
#include <samestep/expects.h>
#include <samestep/id.h>
#include <samestep/make_room.h>

namespace samestep {

/// Free ones among some slots, as bits, and the words of those that have any: the lowest is found in a few
/// operations.
class FreeSlots {
 public:
  /// Makes as many slots, none of them free.
  void reset(std::uint32_t slots);
  /// Makes room for so many.
  void reserve(std::uint32_t slots);
  /// New slots are not free.
  void grow(std::uint32_t slots);
  void add(std::uint32_t slot) {
    words_[slot / 64] |= bit(slot);
    summary_[slot / 4096] |= bit(slot / 64);
  }
  void remove(std::uint32_t slot) {
    words_[slot / 64] &= ~bit(slot);
    if (words_[slot / 64] == 0) summary_[slot / 4096] &= ~bit(slot / 64);
  }
  /// `none` if there is none.
  std::uint32_t lowest(std::uint32_t none) const {
    for (std::uint32_t i = 0; i < summary_.size(); ++i) {
      if (summary_[i] == 0) continue;
      const std::uint32_t word = 64 * i + lowestBit(summary_[i]);
      return 64 * word + lowestBit(words_[word]);
    }
    return none;
  }

 private:
  static constexpr std::uint32_t wordsFor(std::uint32_t bits) { return bits / 64 + (bits % 64 != 0 ? 1 : 0); }
  static constexpr std::uint64_t bit(std::uint32_t index) { return std::uint64_t{1} << (index % 64); }
  static constexpr std::uint32_t lowestBit(std::uint64_t word) {
    return static_cast<std::uint32_t>(std::countr_zero(word));
  }

  std::vector<std::uint64_t> words_;
  std::vector<std::uint64_t> summary_;
};

/// Values named by ids: a slot and its generation. Every id given out names one value as long as the map goes
/// forward: after erase it names nothing, whatever later uses the slot. Where restore, or an assignment,
/// brings back an earlier state, ids that were given out since are given out again.
///
/// A generation is odd while the slot is in use; insert and erase each raise it by one. A new value goes to
/// the lowest free slot, or a caller says where: which ids come next follows from which slots are free, not
/// from the order in which they became so. A free slot holds T(). References last until the next insert.
template <class T, class IdType>
class SlotMap {
 public:
  /// The last even generation: a slot that reaches it is never used again.
  static constexpr std::uint32_t kRetired = 0xfffffffeu;

  /// Number of the Space whose ids these are, see Id::space; 0 until it is set. It goes with a copy, and is
  /// no part of the state.
  std::uint32_t space() const { return space_; }
  void setSpace(std::uint32_t space) { space_ = space; }

  /// Values in use.
  std::uint32_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// Slots ever used: every index is below this.
  std::uint32_t slots() const { return static_cast<std::uint32_t>(generations_.size()); }

  /// Given indices are below this: a single one cannot take memory without end.
  static constexpr std::uint32_t kMaxGivenSlots = 1u << 16;

  /// The id that the next insert will give.
  IdType nextId() const {
    const std::uint32_t slot = free_.lowest(slots());
    return makeId(slot, slot == slots() ? 1 : generations_[slot] + 1);
  }

  /// Stores the value in the lowest free slot, or a new one.
  /// @throws IllegalSize when no index is left
  IdType insert(T value) {
    const IdType id = nextId();
    require<Fault::IllegalSize>(id.index < IdType::kNoIndex, "SlotMap::insert: all ", IdType::kNoIndex,
                                " slots are in use or used up");
    store(id, std::move(value));
    return id;
  }

  /// Stores the value under an id of the caller's choice. New slots below it are free.
  /// @throws as checkGiven
  void insertAt(IdType id, T value) {
    checkGiven(id);
    store(id, std::move(value));
  }
  /// Refuses an id under which insertAt can store nothing.
  /// @throws IndexOutOfBounds if its index is not below kMaxGivenSlots; IllegalId unless its generation is
  ///         odd, below kRetired and higher than any its slot has had, and the slot free
  void checkGiven(IdType id) const {
    require<Fault::IndexOutOfBounds>(id.index < kMaxGivenSlots, "given id ", id,
                                     ": allowed are slots from 0 to ", kMaxGivenSlots - 1);
    const std::uint32_t before = id.index < slots() ? generations_[id.index] : 0;
    require<Fault::IllegalId>((before & 1) == 0, "given id ", id, ": the slot is in use, by generation ",
                              before);
    require<Fault::IllegalId>(
        (id.generation & 1) != 0 && id.generation < kRetired && id.generation > before, "given id ", id,
        ": allowed are odd generations higher than any its slot has had, ", before, ", and below ", kRetired);
  }

  /// Makes room for a slot, so that storing there takes no memory.
  void reserve(std::uint32_t slot) {
    makeRoom(values_, slot + std::size_t{1});
    makeRoom(generations_, slot + std::size_t{1});
    free_.reserve(slot + 1);
  }
  /// Stores the value under an id that nextId gave or that checkGiven has let pass. Where there is no memory,
  /// nothing has changed.
  void store(IdType id, T value) {
    reserve(id.index);
    const std::uint32_t before = slots();
    if (id.index >= before) {
      values_.resize(id.index + std::size_t{1});
      generations_.resize(id.index + std::size_t{1}, 0);
      free_.grow(slots());
      for (std::uint32_t slot = before; slot < id.index; ++slot) free_.add(slot);
    } else {
      free_.remove(id.index);
    }
    values_[id.index] = std::move(value);
    generations_[id.index] = id.generation;
    ++size_;
  }

  /// Frees the slot. False, and nothing done, if the id names no value.
  bool erase(IdType id) {
    if (!contains(id)) return false;
    values_[id.index] = T();
    if (++generations_[id.index] != kRetired) free_.add(id.index);
    --size_;
    return true;
  }

  bool contains(IdType id) const {
    return id.index < slots() && generations_[id.index] == id.generation && aliveAt(id.index) && isOurs(id);
  }
  /// True if an id may be one of this map's.
  bool isOurs(IdType id) const { return id.space == space_ || id.space == 0 || space_ == 0; }
  bool aliveAt(std::uint32_t slot) const {
    expects(slot < slots());
    return (generations_[slot] & 1) != 0;
  }
  /// The id of the value in a slot that is in use.
  IdType idAt(std::uint32_t slot) const {
    expects(slot < slots() && aliveAt(slot));
    return makeId(slot, generations_[slot]);
  }

  /// @param asked  by what, for the error
  /// @throws the exception of fault F if the id names no value
  template <Fault F>
  T& at(IdType id, const char* asked) {
    requireAlive<F>(id, asked);
    return values_[id.index];
  }
  template <Fault F>
  const T& at(IdType id, const char* asked) const {
    requireAlive<F>(id, asked);
    return values_[id.index];
  }
  /// Requires that the object lives, and does not return it.
  template <Fault F>
  void requireAlive(IdType id, const char* asked) const {
    if (!contains(id)) [[unlikely]]
      refuse<F>(id, asked);
  }
  /// The value or null.
  T* find(IdType id) { return contains(id) ? &values_[id.index] : nullptr; }
  const T* find(IdType id) const { return contains(id) ? &values_[id.index] : nullptr; }

  /// Value in a slot below slots().
  T& valueAt(std::uint32_t slot) {
    expects(slot < slots());
    return values_[slot];
  }
  const T& valueAt(std::uint32_t slot) const {
    expects(slot < slots());
    return values_[slot];
  }
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
    free_.reset(0);
    size_ = 0;
  }

  /// The state for writing: both belong to it. One value per slot, T() where the slot is free.
  const std::vector<T>& values() const { return values_; }
  const std::vector<std::uint32_t>& generations() const { return generations_; }

  /// Takes over a state as the accessors gave it. False, and nothing changed, unless there is one generation
  /// per value, each below kRetired + 1. Values of free slots are set to T().
  [[nodiscard]] bool restore(std::vector<T> values, std::vector<std::uint32_t> generations) {
    if (values.size() != generations.size() || values.size() >= IdType::kNoIndex) return false;
    std::uint32_t used = 0;
    for (const std::uint32_t generation : generations) {
      if (generation > kRetired) return false;
      used += generation & 1;
    }
    values_ = std::move(values);
    generations_ = std::move(generations);
    free_.reset(slots());
    for (std::uint32_t slot = 0; slot < slots(); ++slot) {
      if (aliveAt(slot)) continue;
      values_[slot] = T();
      if (generations_[slot] != kRetired) free_.add(slot);
    }
    size_ = used;
    return true;
  }

  /// Takes over generations that another map had, in place: slots in use keep the values they have, or have
  /// T(), for the caller to set; values of free slots are set to T(). Takes no memory where the slots fit.
  /// @param generationOf  answers the generation of a slot
  template <class GenerationOf>
  void setSlots(std::uint32_t slots, GenerationOf&& generationOf) {
    values_.resize(slots);
    generations_.resize(slots);
    free_.reset(slots);
    size_ = 0;
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      const bool wasFree = (generations_[slot] & 1) == 0;
      generations_[slot] = generationOf(slot);
      if (aliveAt(slot)) {
        ++size_;
        continue;
      }
      if (!wasFree) values_[slot] = T();
      if (generations_[slot] != kRetired) free_.add(slot);
    }
  }

  friend bool operator==(const SlotMap& a, const SlotMap& b) {
    return a.generations_ == b.generations_ && a.values_ == b.values_;
  }

 private:
  IdType makeId(std::uint32_t index, std::uint32_t generation) const {
    IdType id;
    id.index = index;
    id.generation = generation;
    id.space = space_;
    return id;
  }
  /// Says why an id names no value.
  template <Fault F>
  [[noreturn, gnu::noinline, gnu::cold]] void refuse(IdType id, const char* asked) const {
    if (!id.valid()) fail<F>(asked, ": the id names nothing");
    if (!isOurs(id)) fail<F>(asked, ": id ", id, " is of another Space");
    if (id.index >= slots())
      fail<F>(asked, ": no id ", id, " was given out here, of slots there are ", slots());
    fail<F>(asked, ": id ", id, " names nothing any more: its slot is at generation ", generations_[id.index],
            aliveAt(id.index) ? ", in use" : ", free");
  }

  std::vector<T> values_;
  std::vector<std::uint32_t> generations_;
  FreeSlots free_;  // not state: follows from the generations
  std::uint32_t size_ = 0;
  std::uint32_t space_ = 0;
};

}  // namespace samestep
