// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <samestep/collision.h>

namespace samestep {

// Where two shapes that do not move against each other lie side by side, as the tiles of a floor, they have
// edges inside what is one surface for the game. A shape that moves over such a seam must not find them: it
// would stop at a face that no one can see, or roll over a corner that is none. They are found by asking what
// the other shapes cover, without being told of neighbours: shapes may be in any order, and come and go.

/// Tolerances of neighbours: steps of up to this, m, and gaps of up to the other count as flush.
template <Scalar S>
inline constexpr S kSeamStep = S(0x1p-9);
template <Scalar S>
inline constexpr S kSeamGap = S(0x1p-8);

/// A contact of a shape with one of several that do not move against each other.
template <Scalar S>
struct SeamContact {
  const PlacedShape<S>* moving = nullptr;
  const PlacedShape<S>* still = nullptr;
  /// Normal from the still shape to the moving one, a unit vector.
  Vector<S> normal{};
  /// Points on the surface of the still shape, in the world.
  Vector<S> points[kMaxContactsPerPair]{};
  int count = 0;
};

/// The contacts of one shape with those of one group, so that those near a place are found without asking
/// all.
template <Scalar S>
class SeamContacts {
 public:
  void clear() { entries_.clear(); }
  /// @param number  any, each once
  void add(const SeamContact<S>& contact, std::uint32_t number) {
    entries_.push_back({contact, number, {}, {}, {}});
  }
  void sort();
  std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }
  const SeamContact<S>& operator[](std::uint32_t i) const { return entries_[i].contact; }
  std::uint32_t numberOf(std::uint32_t i) const { return entries_[i].number; }

  /// Visits those whose still shape has its box around a place, within kSeamStep. Of thousands that lie over
  /// each other some are left out.
  template <class Visit>
  void around(const Vector<S>& point, Visit&& visit) const {
    const S place = byX_ ? point.x : point.y;
    const auto after = std::upper_bound(entries_.begin(), entries_.end(), place + kSeamStep<S>,
                                        [](S x, const Entry& entry) { return x < entry.low; });
    int looked = 0;
    for (auto entry = after; entry != entries_.begin() && looked < kMostLooks; ++looked) {
      --entry;
      if (entry->highest < place - kSeamStep<S>) break;
      if (contains(inflate(entry->contact.still->box, kSeamStep<S>), point)) {
        visit(static_cast<std::uint32_t>(entry - entries_.begin()));
      }
    }
  }

 private:
  static constexpr int kMostLooks = 1024;
  struct Entry {
    SeamContact<S> contact;
    std::uint32_t number;
    S low, high;  ///< Range of the still shape's box along the axis.
    S highest;    ///< Highest end of those up to here.
  };

  std::vector<Entry> entries_;
  bool byX_ = true;
};

enum class SeamVerdict : std::uint8_t {
  stays,    ///< The contact is one with the surface.
  changes,  ///< There is another contact with a part of the still shape that is open.
  goes,     ///< There is none.
};

/// Judges one of the contacts of a moving shape.
/// @param all     the contacts of that shape with the group in this step, as they were found
/// @param margin  m: how far apart shapes may be for a contact
/// @param info    where it changes, the contact from the still shape to the moving one
template <Scalar S>
SeamVerdict judgeSeam(const SeamContacts<S>& all, std::uint32_t which, S margin, CollisionInfo<S>& info);

/// Collision with the shapes exchanged.
template <Scalar S>
CollisionInfo<S> exchanged(const CollisionInfo<S>& info) {
  CollisionInfo<S> other = info;
  other.normal = -info.normal;
  for (int i = 0; i < info.count; ++i) {
    const CollisionPoint<S>& p = info.points[i];
    other.points[i] = {p.pointB, p.pointA, p.hash << 16 | p.hash >> 16};
  }
  return other;
}

/// Separation of the shapes of a collision that has points, where it is least.
template <Scalar S>
S leastSeparation(const CollisionInfo<S>& info) {
  const auto apart = [&](int i) { return dot(info.points[i].pointB - info.points[i].pointA, info.normal); };
  return info.count < 2 ? apart(0) : min(apart(0), apart(1));
}

}  // namespace samestep
