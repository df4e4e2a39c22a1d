// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/collision.h>

#include "support.h"

namespace samestep {

/// An edge that faces the other shape, without its radius. MIS: Edge
template <Scalar S>
struct SupportEdge {
  Vector<S> a, b;  ///< Counter-clockwise, from the reference point of the pair.
  int indexA, indexB;
};

/// The edge of a segment or polygon that faces n most: of the two at the vertex farthest along n, the one
/// whose normal is nearer to n. MIS: supportEdgeForPoly, supportEdgeForSegment
template <Scalar S>
SupportEdge<S> supportEdge(const SupportShape<S>& shape, const Vector<S>& n) {
  const int i1 = shape.farthest(n);
  const int i0 = (i1 == 0 ? shape.count : i1) - 1;
  const int i2 = i1 + 1 < shape.count ? i1 + 1 : 0;
  if (exactDot(n, shape.planes[i1].n) > exactDot(n, shape.planes[i2].n)) {
    return {shape.point(i0), shape.point(i1), i0, i1};
  }
  return {shape.point(i1), shape.point(i2), i1, i2};
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
  return lerp(edge.a, edge.b, part / whole);
}

/// Projects the ends of two facing edges on each other along the normal and keeps the places where the
/// rounded edges overlap: at most two. The surfaces may be `margin` apart. MIS: contactPoints
template <Scalar S>
void clip(const SupportPair<S>& pair, S radiusA, S radiusB, S margin, const Vector<S>& n,
          CollisionInfo<S>& info) {
  const SupportEdge<S> e1 = supportEdge(pair.a, n), e2 = supportEdge(pair.b, -n);
  const S a1 = cross(e1.a, n), b1 = cross(e1.b, n), a2 = cross(e2.a, n), b2 = cross(e2.b, n);
  const S whole1 = b1 - a1, whole2 = b2 - a2;
  info.normal = n;
  const auto meet = [&](S at1, S at2, int index1, int index2) {
    const Vector<S> p1 = mulAdd(n, radiusA, pointAlong(e1, at2 - a1, whole1));
    const Vector<S> p2 = mulAdd(n, -radiusB, pointAlong(e2, at1 - a2, whole2));
    if (dot(p2 - p1, n) > margin) return;
    const auto hash = static_cast<std::uint32_t>(index1) << 16 | static_cast<std::uint32_t>(index2);
    info.push(p1 + pair.a.reference, p2 + pair.b.reference, hash);
  };
  meet(a1, b2, e1.indexA, e2.indexB);
  meet(b1, a2, e1.indexB, e2.indexA);
}

}  // namespace samestep
