// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/shape.h>

namespace samestep {

/// The edge of a segment or polygon that a point faces.
template <Scalar S>
struct NearestEdge {
  int edge = 0;     ///< Ends at the vertex of this number; of a segment 1 is a -> b, 0 the way back.
  int vertex = -1;  ///< The end of the edge that is nearest, or -1 where its inside is.
  S distance{};     ///< Metres from the line through the edge, positive outside.
};

/// The nearest point of a convex core lies on the edge whose line is farthest below the point, since of all
/// unit normals around a corner one of its two edges is the closest to any direction between them. Which part
/// of that edge is nearest is decided exactly. A point inside a polygon has no nearest vertex.
template <Scalar S>
NearestEdge<S> nearestEdge(const PlacedShape<S>& shape, const Vector<S>& point) {
  const Plane<S>* planes = shape.planes;
  NearestEdge<S> found;
  found.distance = dot(planes[0].n, point - planes[0].v0);
  for (int i = 1; i < shape.count; ++i) {
    const S distance = dot(planes[i].n, point - planes[i].v0);
    if (distance > found.distance) {
      found.distance = distance;
      found.edge = i;
    }
  }
  if (shape.type == ShapeType::segment) {
    found.distance = abs(found.distance);
  } else if (found.distance <= S(0)) {
    return found;
  }

  const int previous = (found.edge == 0 ? shape.count : found.edge) - 1;
  const Vector<S> from = planes[previous].v0, to = planes[found.edge].v0;
  const Vector<S> along = to - from;
  if (sign(exactDot(along, point - from)) <= 0) {
    found.vertex = previous;
  } else if (sign(exactDot(along, point - to)) >= 0) {
    found.vertex = found.edge;
  }
  return found;
}

/// The vertices of a placed shape, seen from one reference point that both shapes of a pair share. In Fixed
/// these differences are exact, so nothing that follows depends on where in the world the pair is.
template <Scalar S>
struct SupportShape {
  const Plane<S>* planes;
  int count;
  Vector<S> reference;

  SupportShape(const PlacedShape<S>& shape, const Vector<S>& origin)
      : planes(shape.type == ShapeType::circle ? &shape.center : shape.planes),
        count(shape.count),
        reference(origin) {}

  Vector<S> point(int i) const { return planes[i].v0 - reference; }

  /// The vertex farthest along n; of equals the first. MIS: polySupportPointIndex
  int farthest(const Vector<S>& n) const {
    int best = 0;
    Wide<S> most = exactDot(point(0), n);
    for (int i = 1; i < count; ++i) {
      const Wide<S> along = exactDot(point(i), n);
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

  MinkowskiPoint<S> vertex(int ia, int ib) const { return {b.point(ib) - a.point(ia), ia, ib}; }
  /// The point of the difference farthest along n. MIS: support
  MinkowskiPoint<S> farthest(const Vector<S>& n) const { return vertex(a.farthest(-n), b.farthest(n)); }
};

/// Whether c lies to the left of the way from a to b, strictly. In double the form that treats a and b alike.
template <Scalar S>
bool leftOf(const Vector<S>& a, const Vector<S>& b, const Vector<S>& c) {
  return sign(exactCross(b - a, (a - c) + (b - c))) < 0;
}

/// Where two shapes are nearest, or overlap least. MIS: ClosestPoints
template <Scalar S>
struct ClosestPoints {
  Vector<S> normal;  ///< Unit, from A to B.
  S distance{};      ///< Metres, negative where they overlap.
  std::uint32_t id = 0;
  int vertexA = -1;  ///< The vertex of A that is nearest to B, or -1 where it is no vertex.
  int vertexB = -1;
};

}  // namespace samestep
