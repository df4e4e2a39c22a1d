// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/collision.h>

#include "narrow_phase/support.h"

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

/// Edge at the vertex farthest along n whose normal is nearer to n: the one on whose side of the line between
/// the two normals n lies. Of nearly parallel edges rounded cosines would tell nothing.
/// MIS: supportEdgeForPoly, supportEdgeForSegment
template <Scalar S>
SupportEdge<S> edgeAt(const PlacedShape<S>& shape, int vertex, const Vector<S>& n) {
  const int after = vertex + 1 < shape.count ? vertex + 1 : 0;
  const Vector<S>&first = shape.planes[vertex].n, &second = shape.planes[after].n;
  const Vector<S> between = first + second;
  // Normals that are all but opposite, as a segment's, have no line between them worth asking.
  const bool blunt = max(abs(between.x), abs(between.y)) > ratio<S>(1, 2);
  const bool before = blunt ? sign(exactCross(between, n)) < 0 : sign(exactDot(first - second, n)) > 0;
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
/// @return whether the edges face each other and some of one lies opposite some of the other; if not, the
/// places need not be opposite each other
/// MIS: contactPoints
template <Scalar S>
bool clip(const SupportEdge<S>& e1, S radius1, const SupportEdge<S>& e2, S radius2, const Vector<S>& n,
          S margin, CollisionInfo<S>& info) {
  const S whole1 = cross(e1.b - e1.a, n), whole2 = cross(e2.b - e2.a, n);
  const S starts = cross(e2.a - e1.a, n), last = cross(e2.b - e1.a, n), first = cross(e2.a - e1.b, n);
  const bool back = whole1 < S(0);
  const bool overlap = back ? starts < S(0) && last > whole1 : starts > S(0) && last < whole1;
  const bool rounded = radius1 != S(0) || radius2 != S(0);
  info.normal = n;
  const auto meet = [&](S part1, S part2, const Vector<S>& end1, const Vector<S>& end2, bool inside1,
                        int index1, int index2) {
    Vector<S> points[2];
    if (overlap) [[likely]] {
      // One edge ends first: its end, and the place on the other that faces it. Which one that is, is as good
      // as random, so it chooses places in arrays rather than a way to go.
      const SupportEdge<S>* const edges[] = {&e2, &e1};
      const S parts[] = {part2, part1}, wholes[] = {whole2, whole1};
      const Vector<S>* const ends[] = {&end1, &end2};
      const std::size_t on = inside1 ? 1 : 0;
      points[on] = pointAlong(*edges[on], parts[on], wholes[on]);
      points[1 - on] = *ends[on];
    } else {
      points[1] = pointAlong(e1, part1, whole1);
      points[0] = pointAlong(e2, part2, whole2);
    }
    Vector<S> p1 = points[1], p2 = points[0];
    if (rounded) {
      p1 += n * radius1;
      p2 -= n * radius2;
    }
    if (dot(p2 - p1, n) > margin) return;
    info.push(p1, p2, static_cast<std::uint32_t>(index1) << 16 | static_cast<std::uint32_t>(index2));
  };
  meet(last, -starts, e1.a, e2.b, back ? last < S(0) : last > S(0), e1.indexA, e2.indexB);
  meet(starts, -first, e1.b, e2.a, back ? first > S(0) : first < S(0), e1.indexB, e2.indexA);
  return back ? whole2 >= S(0) && starts <= S(0) && last >= whole1
              : whole2 <= S(0) && starts >= S(0) && last <= whole1;
}

}  // namespace samestep
