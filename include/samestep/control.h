// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <samestep/vector.h>

namespace samestep {

/// Kind of thing a shape is to the collision handlers; the user's own numbering. MIS section 8.
using CollisionType = std::uint32_t;
/// Type that stands for any in a collision handler. It is also the type a new shape has.
inline constexpr CollisionType kWildcardCollisionType = 0;

/// The features a pair touched with last time, so that the next search starts there; 0 starts afresh.
using CollisionId = std::uint32_t;

/// The circle number, to the nearest S.
template <Scalar S>
inline constexpr S kPi = S(3.14159265358979323846);

/// x held within [0, 1]; for other limits there is clamp in math.h. MIS: fclamp01
template <Scalar S>
[[gnu::always_inline]] inline constexpr S clamp01(S x) {
  return clamp(x, S(0), S(1));
}

/// Interpolates from a (t = 0) to b (t = 1), both ends exact; t may lie outside [0, 1]. MIS: flerp
template <Scalar S>
[[gnu::always_inline]] inline constexpr S lerp(S a, S b, S t) {
  return dot(a, S(1) - t, b, t);
}

/// Moves from a towards b by no more than `step` >= 0. MIS: flerpconst
template <Scalar S>
[[gnu::always_inline]] inline constexpr S lerpConst(S a, S b, S step) {
  return a + clamp(b - a, -step, step);
}

/// Two places in a list of points.
struct LoopIndices {
  int start = 0;  ///< The leftmost point, the lowest of those.
  int end = 0;    ///< The rightmost point, the highest of those.
  friend constexpr bool operator==(const LoopIndices&, const LoopIndices&) = default;
};

/// The extreme points of a list; of equal points the first. Both 0 when all are equal.
/// @throws IndexOutOfBounds without points
/// MIS: loopIndices
template <Scalar S>
LoopIndices loopIndices(std::span<const Vector<S>> points);

/// The convex hull of the points, counter-clockwise, beginning at the leftmost (lowest) point. Points on an
/// edge are left out. Which side of a line a point lies on is decided exactly.
/// @param points     at least one; any order, repeats allowed, coordinates within 2^20 m
/// @param result     as long as `points`, which it may be itself; the hull comes first, the rest is scratch
/// @param first      if not null: where in `points` the first point of the hull stood
/// @param tolerance  0 to 2^20 m; points less than this outside an edge are left out too
/// @return how many points the hull has: 1 when all points are equal, 2 when they lie on a line
/// @throws IndexOutOfBounds without points or where `result` is shorter than `points`; ValueOutOfRange where
///         a coordinate or the tolerance is outside its range
/// Quick hull: O(n log n) for scattered points, O(n^2) at worst.
/// MIS: convexHull
template <Scalar S>
int convexHull(std::span<const Vector<S>> points, std::span<Vector<S>> result, int* first = nullptr,
               S tolerance = S(0));

}  // namespace samestep
