// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <type_traits>

#include "narrow_phase/support.h"

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
  bool onB = false;  ///< True if it is B's face.

  /// A start for the next search; no id of gjk.
  std::uint32_t id() const { return kTag | (onB ? kOnB : 0u) | static_cast<std::uint32_t>(face); }
  static constexpr std::uint32_t kTag = 0x80000000u, kOnB = 0x100u, kFace = 0xffu;
};

/// Faces whose separations differ by no more than this, in metres, count as equal.
template <Scalar S>
inline constexpr S kFlat = S(0x1p-20);

/// Two numbers that say how far along: the plain one for shapes near each other, the exact one for all.
template <Scalar S>
struct LocalWay {
  using Number = Local<S>;
  struct Place {
    Number x, y;
  };
  static Place place(const Vector<S>& difference) {
    return {localPlace(difference.x), localPlace(difference.y)};
  }
  static Place unit(const Vector<S>& n) { return {localUnit(n.x), localUnit(n.y)}; }
  static Number along(const Place& place, const Place& n) { return localDot(place.x, place.y, n.x, n.y); }
  static Number length(S length) { return localLength(length); }
};
template <Scalar S>
struct ExactWay {
  using Number = Wide<S>;
  using Place = Vector<S>;
  static Place place(const Vector<S>& difference) { return difference; }
  static Place unit(const Vector<S>& n) { return n; }
  static Number along(const Place& place, const Place& n) { return exactDot(place, n); }
  static Number length(S length) { return exactProduct(length, S(1)); }
};

/// -1, all bits, if a < b, and 0 if not, for numbers that are finite. Compilers would make a branch of it
/// where a and b are double; and which of some vertices is nearest cannot be guessed.
template <class Number>
[[gnu::always_inline]] inline int lessMask(Number a, Number b) {
  if constexpr (std::is_floating_point_v<Number>) {
    // A difference is 0 only of equals. Emscripten's library has no std::bit_cast.
    return -static_cast<int>(__builtin_bit_cast(std::uint64_t, a - b) >> 63);
  } else {
    return -static_cast<int>(a < b);
  }
}

/// Separation of a face from the nearest vertex of another shape.
template <class Way, Scalar S>
FaceAxis<S> separationAt(const PlacedShape<S>& shape, int face, const PlacedShape<S>& other, bool onB) {
  const Plane<S>& plane = shape.planes[face];
  const auto n = Way::unit(plane.n);
  const auto along = [&](int i) { return Way::along(Way::place(other.planes[i].v0 - plane.v0), n); };
  typename Way::Number least = along(0);
  int nearest = 0;
  for (int i = 1; i < other.count; ++i) {
    const typename Way::Number next = along(i);
    nearest += (i - nearest) & lessMask(next, least);
    least = min(least, next);
  }
  return {toScalar(exactDot(other.planes[nearest].v0 - plane.v0, plane.n)), face, nearest, onB};
}

/// The face of a shape that is farthest from the nearest vertex of another, of equals the first.
template <class Way>
struct FarthestFace {
  typename Way::Number separation{};
  int face = 0;

  template <class Place, class S>
  FarthestFace(const PlacedShape<S>& shape, const Place* own, const Place* others, int otherCount) {
    const auto apart = [&](int i) {
      const auto n = Way::unit(shape.planes[i].n);
      // The loop has no branches: which vertex it is, is seldom asked.
      typename Way::Number least = Way::along(others[0], n);
      for (int j = 1; j < otherCount; ++j) least = min(least, Way::along(others[j], n));
      return least - Way::along(own[i], n);
    };
    separation = apart(0);
    for (int i = 1; i < shape.count; ++i) {
      const typename Way::Number next = apart(i);
      face += (i - face) & lessMask(separation, next);
      separation = max(separation, next);
    }
  }
};

/// Number of pairs up to which looking at every vertex for every face is faster than searching.
inline constexpr int kMaxFacePairs = 64;

template <class Way, Scalar S>
FaceAxis<S> searchFaces(const PlacedShape<S>& a, const PlacedShape<S>& b, S reach, std::uint32_t start) {
  using Axis = FaceAxis<S>;
  const auto axisOf = [&](int face, bool onB) {
    return onB ? separationAt<Way>(b, face, a, true) : separationAt<Way>(a, face, b, false);
  };
  Axis old;
  old.face = -1;
  if ((start & Axis::kTag) != 0) {
    const bool onB = (start & Axis::kOnB) != 0;
    const int face = static_cast<int>(start & Axis::kFace);
    if (face < (onB ? b : a).count) {
      old = axisOf(face, onB);
      if (old.separation > reach) return old;
    }
  }

  const Vector<S> origin = a.planes[0].v0;
  typename Way::Place ofA[kMaxPolyVertices], ofB[kMaxPolyVertices];
  for (int i = 0; i < a.count; ++i) ofA[i] = Way::place(a.planes[i].v0 - origin);
  for (int i = 0; i < b.count; ++i) ofB[i] = Way::place(b.planes[i].v0 - origin);
  const FarthestFace<Way> faceOfA(a, ofA, ofB, b.count), faceOfB(b, ofB, ofA, a.count);
  // The reference face of two that lie flat on each other is A's, whatever rounding makes of it: the answer
  // stays the same from step to step, and a segment is touched in its face, not at its end.
  const bool onB = faceOfB.separation > faceOfA.separation + Way::length(kFlat<S>);
  const int face = onB ? faceOfB.face : faceOfA.face;
  return face == old.face && onB == old.onB ? old : axisOf(face, onB);
}

/// The extent of two shapes together, m.
template <Scalar S>
S extentOf(const PlacedShape<S>& a, const PlacedShape<S>& b) {
  const BB<S> around = merge(a.box, b.box);
  return max(around.right - around.left, around.top - around.bottom);
}

/// The best of all faces, or the one looked at first if that one separates the shapes by more than `reach`.
/// @param a, b   meant for shapes of few vertices, see kMaxFacePairs: every face is looked at
/// @param start  the id of an earlier answer: that face is looked at first
template <Scalar S>
FaceAxis<S> bestFace(const PlacedShape<S>& a, const PlacedShape<S>& b, S reach, std::uint32_t start) {
  return extentOf(a, b) < S(kLocalReach) ? searchFaces<LocalWay<S>>(a, b, reach, start)
                                         : searchFaces<ExactWay<S>>(a, b, reach, start);
}

/// Faces shorter than this, in metres, are turned against their normals where vertices are rounded: by 2^-16
/// rad and more.
template <Scalar S>
inline constexpr S kShortFace = S(0x1p-16);

/// True if the nearest vertex lies above the inside of the face, or below it: then, apart, nothing of the
/// shapes is nearer. No claim is made for a short face.
template <Scalar S>
bool facesVertex(const PlacedShape<S>& a, const PlacedShape<S>& b, const FaceAxis<S>& axis) {
  const PlacedShape<S>& shape = axis.onB ? b : a;
  const Vector<S> v = (axis.onB ? a : b).planes[axis.vertex].v0;
  const Vector<S> to = shape.planes[axis.face].v0;
  const Vector<S> from = shape.planes[(axis.face == 0 ? shape.count : axis.face) - 1].v0;
  const Vector<S> along = to - from;
  if (max(abs(along.x), abs(along.y)) < kShortFace<S>) return false;
  return sign(exactDot(along, v - from)) >= 0 && sign(exactDot(along, v - to)) <= 0;
}

}  // namespace samestep
