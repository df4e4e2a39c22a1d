// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/id.h>
#include <samestep/vector.h>

namespace samestep {

/// A point query's answer.
template <Scalar S>
struct PointHit {
  ShapeId shape{};
  Vector<S> point{};     ///< Nearest point of the shape's surface, m.
  S distance{};          ///< Distance from the surface, m; negative inside.
  Vector<S> gradient{};  ///< Unit vector in which the distance grows.
};

/// A segment query's answer.
template <Scalar S>
struct SegmentHit {
  ShapeId shape{};
  Vector<S> point{};   ///< Point of the hit, m.
  Vector<S> normal{};  ///< Normal of the surface hit, a unit vector.
  S alpha{};           ///< Fraction of the segment before the hit, in [0, 1].
};

}  // namespace samestep
