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

/// Part of an edge that is nearest to a point: -1 where it begins, 1 where it ends, 0 between. A polygon's
/// edge may be so short that rounding turned it; its normal was turned with the shape.
template <Scalar S>
int partOfEdge(const PlacedShape<S>& shape, int edge, const Vector<S>& point) {
  const Vector<S> from = shape.planes[(edge == 0 ? shape.count : edge) - 1].v0, to = shape.planes[edge].v0;
  const Vector<S> along = shape.type == ShapeType::segment ? to - from : perp(shape.planes[edge].n);
  if (sign(exactDot(along, point - from)) <= 0) return -1;
  return sign(exactDot(along, point - to)) >= 0 ? 1 : 0;
}

/// True if a point lies on the outer side of an edge of a polygon, or on its line. Exact.
template <Scalar S>
bool outsideOfEdge(const PlacedShape<S>& shape, int edge, const Vector<S>& point) {
  const Vector<S> from = shape.planes[(edge == 0 ? shape.count : edge) - 1].v0, to = shape.planes[edge].v0;
  return sign(exactCross(to - from, point - from)) <= 0;
}

/// The nearest point of a convex core lies on the edge whose line is farthest below the point, since of all
/// unit normals around a corner one of its two edges is the closest to any direction between them. Which part
/// of that edge is nearest is decided exactly. A point inside a polygon has no nearest vertex: above or below
/// the inside of an edge the sign of the distance may be rounded, before a blunt corner it may not. What lies
/// beyond both edges of a sharp corner is outside of it, even where rounding has turned a sliver inside out.
template <Scalar S>
NearestEdge<S> nearestEdge(const PlacedShape<S>& shape, const Vector<S>& point) {
  const Plane<S>* planes = shape.planes;
  // More than the distances below are off by: two roundings of a unit over the largest shape.
  const S noise(0x1p-16);
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
    // Inside a vertex is never nearest.
    if (found.distance < -noise) return found;
  }

  for (int step = 0; step < shape.count; ++step) {
    const int part = partOfEdge(shape, found.edge, point);
    if (part == 0) return found;
    const int previous = (found.edge == 0 ? shape.count : found.edge) - 1;
    const int next = found.edge + 1 < shape.count ? found.edge + 1 : 0;
    const int beyond = part < 0 ? previous : next;
    // Rounding may have preferred the wrong one of two nearly parallel edges: the vertex between them is
    // nearest only if both say so.
    if (shape.type == ShapeType::segment || partOfEdge(shape, beyond, point) == -part) {
      const bool outside = shape.type == ShapeType::segment || found.distance > noise ||
                           dot(planes[found.edge].n, planes[beyond].n) < S(0) ||
                           outsideOfEdge(shape, found.edge, point) || outsideOfEdge(shape, beyond, point);
      if (outside) found.vertex = part < 0 ? previous : found.edge;
      return found;
    }
    found.edge = beyond;
    found.distance = dot(planes[beyond].n, point - planes[beyond].v0);
  }
  return found;
}

}  // namespace samestep
