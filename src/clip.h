// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/collision.h>

#include "support.h"

namespace samestep {

/// An edge that faces the other shape, in the world, without its radius. MIS: Edge
template <Scalar S>
struct SupportEdge {
  Vector<S> a, b;  ///< Counter-clockwise.
  int indexA, indexB;
};

/// The edge that ends at a vertex.
template <Scalar S>
SupportEdge<S> edgeTo(const PlacedShape<S>& shape, int vertex) {
  const int before = (vertex == 0 ? shape.count : vertex) - 1;
  return {shape.planes[before].v0, shape.planes[vertex].v0, before, vertex};
}

/// Of the two edges at the vertex farthest along n, the one whose normal is nearer to n.
/// MIS: supportEdgeForPoly, supportEdgeForSegment
template <Scalar S>
SupportEdge<S> edgeAt(const PlacedShape<S>& shape, int vertex, const Vector<S>& n) {
  const int after = vertex + 1 < shape.count ? vertex + 1 : 0;
  const bool before = exactDot(n, shape.planes[vertex].n) > exactDot(n, shape.planes[after].n);
  return edgeTo(shape, before ? vertex : after);
}

/// The point of an edge at part / whole of the way, held within the edge; its ends exactly.
template <Scalar S>
Vector<S> pointAlong(const SupportEdge<S>& edge, S part, S whole) {
  if (whole < S(0)) {
    part = -part;
    whole = -whole;
  }
  if (part <= S(0)) return edge.a;
  if (part >= whole) return edge.b;
  return edge.a + (edge.b - edge.a) * (part / whole);
}

/// Projects the ends of two facing edges on each other along the normal and keeps the places where the
/// rounded edges are at most `margin` apart: at most two. Only differences of points count.
/// MIS: contactPoints
template <Scalar S>
void clip(const SupportEdge<S>& e1, S radius1, const SupportEdge<S>& e2, S radius2, const Vector<S>& n,
          S margin, CollisionInfo<S>& info) {
  const S whole1 = cross(e1.b - e1.a, n), whole2 = cross(e2.b - e2.a, n), starts = cross(e2.a - e1.a, n);
  info.normal = n;
  const auto meet = [&](S part1, S part2, int index1, int index2) {
    const Vector<S> p1 = pointAlong(e1, part1, whole1) + n * radius1;
    const Vector<S> p2 = pointAlong(e2, part2, whole2) - n * radius2;
    if (dot(p2 - p1, n) > margin) return;
    info.push(p1, p2, static_cast<std::uint32_t>(index1) << 16 | static_cast<std::uint32_t>(index2));
  };
  meet(cross(e2.b - e1.a, n), -starts, e1.indexA, e2.indexB);
  meet(starts, cross(e1.b - e2.a, n), e1.indexB, e2.indexA);
}

}  // namespace samestep
