// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>

namespace samestep {

/// Names one object of one Space: a slot and how often the slot has been used. A removed object's id never
/// names a later one, as long as the world goes forward. Where an earlier world is brought back
/// (Space::restore, adopt, loadSnapshot), what was made after it has never been: its ids are given out again,
/// to other objects. A game that keeps ids across a restore keeps them with the world, as part of what it
/// saves itself, or compares Space::worldsBroughtIn. Ordered by slot. The default id names nothing.
template <class Tag>
struct Id {
  static constexpr std::uint32_t kNoIndex = 0xffffffffu;

  std::uint32_t index = kNoIndex;
  std::uint32_t generation = 0;
  /// Number of the Space whose id it is, so that a Space can refuse that of another: a Space takes it when it
  /// is made, and it goes with its world where that is restored, also in another Space. 0: anybody's. It
  /// differs from run to run, and so it is no part of what is compared, hashed, saved or sent.
  std::uint32_t space = 0;

  /// True if this is some object's id; whether the object still exists only its Space knows.
  constexpr bool valid() const { return index != kNoIndex; }
  /// Id of the same object in any Space: for who does the same in several Spaces, as a game whose inputs are
  /// also applied while a recording of it is replayed. The caller answers for it naming the right object.
  constexpr Id anywhere() const { return fromBits(bits()); }
  /// Slot and generation in one number, for keeping and sending.
  constexpr std::uint64_t bits() const { return std::uint64_t{generation} << 32 | index; }
  /// The id of which bits() were kept. Any Space takes it: the caller answers for it naming the right object.
  static constexpr Id fromBits(std::uint64_t bits) {
    Id id;
    id.index = static_cast<std::uint32_t>(bits);
    id.generation = static_cast<std::uint32_t>(bits >> 32);
    return id;
  }

  friend constexpr bool operator==(const Id& a, const Id& b) {
    return a.index == b.index && a.generation == b.generation;
  }
  friend constexpr std::strong_ordering operator<=>(const Id& a, const Id& b) {
    const std::strong_ordering bySlot = a.index <=> b.index;
    return bySlot != 0 ? bySlot : a.generation <=> b.generation;
  }
};

struct BodyTag;
struct ShapeTag;
struct JointTag;
using BodyId = Id<BodyTag>;
using ShapeId = Id<ShapeTag>;
using JointId = Id<JointTag>;

/// An id within the records of one world, which need not say whose.
template <class Tag>
struct LocalId {
  std::uint32_t index = Id<Tag>::kNoIndex;
  std::uint32_t generation = 0;

  constexpr LocalId() = default;
  constexpr LocalId(std::uint32_t slot, std::uint32_t uses) : index(slot), generation(uses) {}
  constexpr LocalId(const Id<Tag>& id) : index(id.index), generation(id.generation) {}
  constexpr operator Id<Tag>() const {
    Id<Tag> id;
    id.index = index;
    id.generation = generation;
    return id;
  }
  constexpr bool valid() const { return index != Id<Tag>::kNoIndex; }

  friend constexpr bool operator==(const LocalId& a, const LocalId& b) = default;
  friend constexpr auto operator<=>(const LocalId& a, const LocalId& b) = default;
  friend constexpr bool operator==(const LocalId& a, const Id<Tag>& b) { return Id<Tag>(a) == b; }
};

}  // namespace samestep
