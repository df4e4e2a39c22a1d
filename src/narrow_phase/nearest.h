// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/collision.h>

#include "narrow_phase/clip.h"
#include "narrow_phase/gjk.h"

namespace samestep {

/// Distance of two shapes, and the normal along which it is, from A to B.
template <Scalar S>
struct Gap {
  S distance{};  ///< m; negative where they overlap.
  Vector<S> normal{};
};

/// The search for the nearest features of two shapes with edges.
template <Scalar S>
ClosestPoints<S> closestOf(const PlacedShape<S>& a, const PlacedShape<S>& b, CollisionId start,
                           CollisionStats* stats) {
  // The axis lies across the line between the middles of the boxes, twice as long.
  const Vector<S> axis = perp(Vector<S>((a.box.left - b.box.left) + (a.box.right - b.box.right),
                                        (a.box.bottom - b.box.bottom) + (a.box.top - b.box.top)));
  return gjk(SupportPair<S>{SupportShape<S>(a), SupportShape<S>(b)}, start, axis, stats);
}

template <Scalar S>
Gap<S> gapBetween(const PlacedShape<S>& a, const PlacedShape<S>& b) {
  if (a.type == ShapeType::circle) {
    const PointQueryInfo<S> nearest = pointQuery(b, a.center());
    return {nearest.distance - a.radius, -nearest.gradient};
  }
  if (b.type == ShapeType::circle) {
    const PointQueryInfo<S> nearest = pointQuery(a, b.center());
    return {nearest.distance - b.radius, nearest.gradient};
  }
  const ClosestPoints<S> closest = closestOf(a, b, 0, nullptr);
  return {closest.distance - (a.radius + b.radius), closest.normal};
}

/// The edge of a shape that the search named, or the vertex as one without length, counter-clockwise.
/// @param shift  of the shape's number in the second half of the id: 8 for A, 0 for B
template <Scalar S>
SupportEdge<S> namedEdge(const PlacedShape<S>& shape, const ClosestPoints<S>& closest, int shift) {
  // The search goes round clockwise.
  const int from = static_cast<int>(closest.id >> shift & 0xff),
            to = static_cast<int>(closest.id >> (shift + 16) & 0xff);
  return {shape.planes[from].v0, shape.planes[to].v0, from, to};
}

/// The places of two shapes, without their radii, where the search found them nearest, or the overlap least.
/// Each is a vertex or lies between two of one shape, so that it is on the shape, whatever is rounded.
template <Scalar S>
struct NearestPlaces {
  Vector<S> onA, onB;

  NearestPlaces(const PlacedShape<S>& a, const PlacedShape<S>& b, const ClosestPoints<S>& closest) {
    const SupportEdge<S> edgeA = namedEdge(a, closest, 8), edgeB = namedEdge(b, closest, 0);
    // Ends of an edge of the Minkowski difference, along which the place nearest to the origin is looked for.
    const Vector<S> n = closest.normal, from = edgeB.a - edgeA.a, to = edgeB.b - edgeA.b;
    const S part = cross(from, n), whole = cross(from - to, n);
    const auto place = [&](const PlacedShape<S>& shape, int vertex, const SupportEdge<S>& on) {
      return vertex >= 0 ? shape.planes[vertex].v0 : pointAlong(on, part, whole);
    };
    onA = place(a, closest.vertexA, edgeA);
    onB = place(b, closest.vertexB, edgeB);
  }
};

}  // namespace samestep
