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

/// The edge of a segment or polygon that faces n most: of the two at the vertex farthest along n, the one
/// whose normal is nearer to n. MIS: supportEdgeForPoly, supportEdgeForSegment
template <Scalar S>
SupportEdge<S> supportEdge(const SupportShape<S>& shape, const Vector<S>& n) {
  const Plane<S>* planes = shape.planes;
  const int i1 = shape.farthest(n);
  const int i0 = (i1 == 0 ? shape.count : i1) - 1;
  const int i2 = i1 + 1 < shape.count ? i1 + 1 : 0;
  if (exactDot(n, planes[i1].n) > exactDot(n, planes[i2].n)) return {planes[i0].v0, planes[i1].v0, i0, i1};
  return {planes[i1].v0, planes[i2].v0, i1, i2};
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
/// rounded edges overlap: at most two. Only differences of points count. MIS: contactPoints
template <Scalar S>
void clip(const SupportEdge<S>& e1, S radius1, const SupportEdge<S>& e2, S radius2, const Vector<S>& n,
          CollisionInfo<S>& info) {
  const S whole1 = cross(e1.b - e1.a, n), whole2 = cross(e2.b - e2.a, n), starts = cross(e2.a - e1.a, n);
  info.normal = n;
  const auto meet = [&](S part1, S part2, int index1, int index2) {
    const Vector<S> p1 = pointAlong(e1, part1, whole1) + n * radius1;
    const Vector<S> p2 = pointAlong(e2, part2, whole2) - n * radius2;
    if (dot(p2 - p1, n) > S(0)) return;
    info.push(p1, p2, static_cast<std::uint32_t>(index1) << 16 | static_cast<std::uint32_t>(index2));
  };
  meet(cross(e2.b - e1.a, n), -starts, e1.indexA, e2.indexB);
  meet(starts, cross(e1.b - e2.a, n), e1.indexB, e2.indexA);
}

}  // namespace samestep
