// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/shape.h>

namespace samestep {

/// The vertices of a placed shape. Only differences of places are multiplied: in Fixed they are exact, so
/// that nothing depends on where in the world a pair is.
template <Scalar S>
struct SupportShape {
  const Plane<S>* planes;
  int count;

  explicit SupportShape(const PlacedShape<S>& shape) : planes(shape.planes), count(shape.count) {}

  /// The vertex farthest along n; of equals the first. MIS: polySupportPointIndex
  int farthest(const Vector<S>& n) const {
    int best = 0;
    Wide<S> most{};
    for (int i = 1; i < count; ++i) {
      const Wide<S> along = exactDot(planes[i].v0 - planes[0].v0, n);
      if (along > most) {
        most = along;
        best = i;
      }
    }
    return best;
  }
};

/// A vertex of the Minkowski difference B - A, and which vertices made it. MIS: MinkowskiPoint
template <Scalar S>
struct MinkowskiPoint {
  Vector<S> ab;
  std::int32_t a = 0;
  std::int32_t b = 0;

  bool sameFeatures(const MinkowskiPoint& other) const { return a == other.a && b == other.b; }
  std::uint32_t id() const { return static_cast<std::uint32_t>(a) << 8 | static_cast<std::uint32_t>(b); }
};

/// Two shapes whose difference is searched. MIS: SupportContext
template <Scalar S>
struct SupportPair {
  SupportShape<S> a;
  SupportShape<S> b;

  MinkowskiPoint<S> vertex(int ia, int ib) const { return {b.planes[ib].v0 - a.planes[ia].v0, ia, ib}; }
  /// The point of the difference farthest along n. MIS: support
  MinkowskiPoint<S> farthest(const Vector<S>& n) const { return vertex(a.farthest(-n), b.farthest(n)); }
};

/// True if c lies to the left of the way from a to b, strictly. In double the form that treats a and b alike.
template <Scalar S>
bool leftOf(const Vector<S>& a, const Vector<S>& b, const Vector<S>& c) {
  return sign(exactCross(b - a, (a - c) + (b - c))) < 0;
}

/// Closest points of two shapes, or those of least overlap. MIS: ClosestPoints
template <Scalar S>
struct ClosestPoints {
  Vector<S> normal;  ///< Unit, from A to B.
  S distance{};      ///< Metres, negative where they overlap.
  std::uint32_t id = 0;
  int vertexA = -1;  ///< The vertex of A that is nearest to B, or -1 where it is no vertex.
  int vertexB = -1;
};

}  // namespace samestep
