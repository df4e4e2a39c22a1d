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
  S distance{};          ///< From the surface, m; negative inside.
  Vector<S> gradient{};  ///< Unit vector in which the distance grows.
};

/// A segment query's answer.
template <Scalar S>
struct SegmentHit {
  ShapeId shape{};
  Vector<S> point{};   ///< Where it hits, m.
  Vector<S> normal{};  ///< Of the surface hit, a unit vector.
  S alpha{};           ///< How far along the segment, in [0, 1].
};

}  // namespace samestep
