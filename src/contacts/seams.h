// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <samestep/collision.h>

namespace samestep {

// Where two shapes that do not move against each other lie side by side, as the tiles of a floor, they have
// edges inside what is one surface for the game. A shape that moves over such a seam must not find them: it
// would stop at a face that no one can see, or roll over a corner that is none. They are found by asking what
// the other shapes cover, without being told of neighbours: shapes may be in any order, and come and go.

/// Of neighbours: steps of up to this, m, and gaps of up to the other count as flush.
template <Scalar S>
inline constexpr S kSeamStep = S(0x1p-9);
template <Scalar S>
inline constexpr S kSeamGap = S(0x1p-8);

/// A contact between a shape that moves and one that may be part of a surface.
template <Scalar S>
struct SeamContact {
  const PlacedShape<S>* moving = nullptr;
  const PlacedShape<S>* still = nullptr;
  /// Shapes of one number do not move against each other.
  std::uint32_t group = 0;
  /// From the still shape to the moving one, a unit vector.
  Vector<S> normal{};
  /// On the surface of the still shape, in the world.
  Vector<S> points[kMaxContactsPerPair]{};
  int count = 0;
};

enum class SeamVerdict : std::uint8_t {
  stays,    ///< The contact is one with the surface.
  changes,  ///< There is another contact with a part of the still shape that is open.
  goes,     ///< There is none.
};

/// Judges one of the contacts of a moving shape.
/// @param all     the contacts of that shape in this step, as they were found
/// @param margin  m: how far apart shapes may be for a contact
/// @param info    where it changes, the contact from the still shape to the moving one
template <Scalar S>
SeamVerdict judgeSeam(std::span<const SeamContact<S>> all, std::size_t which, S margin,
                      CollisionInfo<S>& info);

/// The same collision with the shapes exchanged.
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

}  // namespace samestep
