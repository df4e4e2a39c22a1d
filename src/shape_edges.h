// SPDX-License-Identifier: MIT
#pragma once

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
  if (shape.type == ShapeType::segment) {
    // Both sides measured from the same end, so that mirror images agree to the last bit.
    found.edge = found.distance < S(0) ? 1 : 0;
    found.distance = abs(found.distance);
  } else {
    for (int i = 1; i < shape.count; ++i) {
      const S distance = dot(planes[i].n, point - planes[i].v0);
      if (distance > found.distance) {
        found.distance = distance;
        found.edge = i;
      }
    }
    if (found.distance <= S(0)) return found;
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

}  // namespace samestep
