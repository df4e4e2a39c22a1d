// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "support.h"

namespace samestep {

/// The face of one of two shapes that separates them most, or that they overlap least along. The edges of the
/// Minkowski difference of two polygons are their faces, so this is what EPA would find, without normalising
/// anything: the normals are known. It takes a look at every vertex for every face, so it is for shapes of
/// few vertices.
template <Scalar S>
struct FaceAxis {
  S separation{};    ///< Metres from the face to the nearest vertex of the other shape; negative: overlap.
  int face = 0;      ///< The number of the vertex the face ends at.
  int vertex = 0;    ///< The other shape's vertex that is nearest, of equals the first.
  bool onB = false;  ///< Whether it is B's face.

  /// A start for the next search; no id of gjk.
  std::uint32_t id() const { return kTag | (onB ? kOnB : 0u) | static_cast<std::uint32_t>(face); }
  static constexpr std::uint32_t kTag = 0x80000000u, kOnB = 0x100u, kFace = 0xffu;
};

/// Faces whose separations differ by no more than this, in metres, count as equal.
template <Scalar S>
inline constexpr S kFlat = S(0x1p-24);

/// How far a face is from the nearest vertex of another shape.
template <Scalar S>
FaceAxis<S> separationAt(const PlacedShape<S>& shape, int face, const PlacedShape<S>& other, bool onB) {
  const Plane<S>& plane = shape.planes[face];
  Wide<S> least = exactDot(other.planes[0].v0 - plane.v0, plane.n);
  int nearest = 0;
  for (int i = 1; i < other.count; ++i) {
    const Wide<S> along = exactDot(other.planes[i].v0 - plane.v0, plane.n);
    if (along < least) {
      least = along;
      nearest = i;
    }
  }
  return {toScalar(least), face, nearest, onB};
}

/// Searches all faces until one separates the shapes by more than `reach`.
/// @param start  the id of an earlier answer: that face is looked at first
template <Scalar S>
FaceAxis<S> bestFace(const PlacedShape<S>& a, const PlacedShape<S>& b, S reach, std::uint32_t start) {
  using Axis = FaceAxis<S>;
  if ((start & Axis::kTag) != 0) {
    const bool onB = (start & Axis::kOnB) != 0;
    const int face = static_cast<int>(start & Axis::kFace);
    if (face < (onB ? b : a).count) {
      const Axis old = onB ? separationAt(b, face, a, true) : separationAt(a, face, b, false);
      if (old.separation > reach) return old;
    }
  }

  Axis best = separationAt(a, 0, b, false);
  for (int i = 1; i < a.count && best.separation <= reach; ++i) {
    const Axis axis = separationAt(a, i, b, false);
    if (axis.separation > best.separation) best = axis;
  }
  // Of two faces that lie flat on each other it is A's, whatever rounding makes of it: the answer stays the
  // same from step to step, and a segment is touched in its face, not at its end.
  S bound = best.separation + kFlat<S>;
  for (int i = 0; i < b.count && best.separation <= reach; ++i) {
    const Axis axis = separationAt(b, i, a, true);
    if (axis.separation > bound) {
      best = axis;
      bound = axis.separation;
    }
  }
  return best;
}

/// Whether the nearest vertex lies above the inside of the face, or below it: then, apart, nothing of the
/// shapes is nearer.
template <Scalar S>
bool facesVertex(const PlacedShape<S>& a, const PlacedShape<S>& b, const FaceAxis<S>& axis) {
  const PlacedShape<S>& shape = axis.onB ? b : a;
  const Vector<S> v = (axis.onB ? a : b).planes[axis.vertex].v0;
  const Vector<S> to = shape.planes[axis.face].v0;
  const Vector<S> from = shape.planes[(axis.face == 0 ? shape.count : axis.face) - 1].v0;
  return sign(exactDot(to - from, v - from)) >= 0 && sign(exactDot(to - from, v - to)) <= 0;
}

}  // namespace samestep
