// SPDX-License-Identifier: MIT
#include <samestep/shape.h>

#include "geometry/shape_edges.h"

namespace samestep {
namespace {

/// The answer for a point at `away` from the nearest point of the core, which is grown by `radius`.
template <Scalar S>
PointQueryInfo<S> fromCore(const Vector<S>& core, const Vector<S>& away, S radius,
                           const Vector<S>& fallback) {
  const S apart = length(away);
  const Vector<S> direction = apart > kMagicEpsilon<S> ? normalize(away) : fallback;
  return {core + direction * radius, apart - radius, direction};
}

template <Scalar S>
PointQueryInfo<S> queryEdges(const PlacedShape<S>& shape, const Vector<S>& point) {
  const NearestEdge<S> nearest = nearestEdge(shape, point);
  const Plane<S>& edge = shape.planes[nearest.edge];
  if (nearest.vertex >= 0) {
    const Vector<S> corner = shape.planes[nearest.vertex].v0;
    return fromCore(corner, point - corner, shape.radius, edge.n);
  }
  const bool onSegment = shape.type == ShapeType::segment && nearest.distance <= kMagicEpsilon<S>;
  const Vector<S> gradient = onSegment ? shape.planes[1].n : edge.n;
  const Vector<S> core = point - edge.n * nearest.distance;
  return {core + gradient * shape.radius, nearest.distance - shape.radius, gradient};
}

/// A circle of `moving` metres going from a to b against a circle at rest: the first touch before `best`.
template <Scalar S>
void touchCircle(const Vector<S>& center, S radius, S moving, const Vector<S>& a, const Vector<S>& b,
                 SegmentQueryInfo<S>& best) {
  const Vector<S> way = normalize(b - a);
  const Vector<S> start = a - center;
  const S reach = radius + moving;
  const S aside = abs(cross(way, start));
  if (aside > reach) return;
  // The root of reach^2 - aside^2, as two roots: the squares may not fit.
  const S along = -dot(way, start) - sqrt(reach - aside) * sqrt(reach + aside);
  const S whole = length(b - a);
  if (along < S(0) || along > whole || whole == S(0)) return;
  const S alpha = along / whole;
  if (best.hit && alpha >= best.alpha) return;
  const Vector<S> touch = start + way * along;
  const Vector<S> normal = touch == Vector<S>() ? -way : normalize(touch);
  best = {true, alpha, center + normal * radius, normal};
}

/// The part of the way from `from` metres above a line to `to` metres above it at which it is met: 0 to 1.
template <Scalar S>
S meetingAt(S from, S to) {
  return from / (from - to);
}

/// The surface point of a face that the moving circle touches at `alpha`.
template <Scalar S>
SegmentQueryInfo<S> faceHit(const Vector<S>& a, const Vector<S>& b, S alpha, const Vector<S>& origin,
                            const Vector<S>& normal, S radius) {
  const Vector<S> center = a + (b - a) * alpha;
  // Onto the face, whatever alpha lost by rounding over a long way.
  const S above = dot(normal, center - origin) - radius;
  return {true, alpha, center - normal * above, normal};
}

/// A moving point against a segment without radius on whose line it goes: it meets the nearer end.
template <Scalar S>
void meetEndOn(const Vector<S>& ta, const Vector<S>& tb, const Vector<S>& a, const Vector<S>& b,
               SegmentQueryInfo<S>& best) {
  const Vector<S> way = normalize(b - a);
  const S whole = length(b - a), toA = dot(way, ta - a), toB = dot(way, tb - a);
  const S along = min(toA, toB);
  if (whole == S(0) || along < S(0) || along > whole) return;
  best = {true, along / whole, toA < toB ? ta : tb, -way};
}

template <Scalar S>
void touchSegment(const PlacedShape<S>& shape, S moving, const Vector<S>& a, const Vector<S>& b,
                  SegmentQueryInfo<S>& best) {
  const Vector<S> ta = shape.planes[0].v0, tb = shape.planes[1].v0, n = shape.planes[1].n;
  const S reach = shape.radius + moving;
  const Vector<S> facing = sign(exactCross(tb - ta, a - ta)) > 0 ? -n : n;
  const S from = dot(facing, a - ta) - reach, to = dot(facing, b - ta) - reach;
  const Vector<S> way = b - a;
  const Vector<S> line = tb - ta;
  if (reach == S(0) && sign(exactCross(line, a - ta)) == 0 && sign(exactCross(line, b - ta)) == 0) {
    return meetEndOn(ta, tb, a, b, best);
  }
  const Vector<S> shift = facing * reach;
  const int sideA = sign(exactCross(way, ta + shift - a)), sideB = sign(exactCross(way, tb + shift - a));
  if (sideA * sideB <= 0 && from >= S(0) && to <= S(0) && to < from) {
    best = faceHit(a, b, meetingAt(from, to), ta, facing, shape.radius);
  } else if (reach > S(0)) {
    touchCircle(ta, shape.radius, moving, a, b, best);
    touchCircle(tb, shape.radius, moving, a, b, best);
  }
}

/// A polygon and a moving point, both without radius: the way is cut off by one edge after the other, so that
/// it cannot slip through at a corner.
template <Scalar S>
void cutByPoly(const PlacedShape<S>& shape, const Vector<S>& a, const Vector<S>& b,
               SegmentQueryInfo<S>& best) {
  S enter(-1), leave(1);
  int face = -1;
  for (int i = 0; i < shape.count; ++i) {
    const Plane<S>& edge = shape.planes[i];
    const S from = dot(edge.n, a - edge.v0), to = dot(edge.n, b - edge.v0);
    // A point that goes along the line of the edge may still come to the edge, from the side.
    if (from == S(0) && to == S(0)) continue;
    if (from >= S(0)) {
      if (to > S(0) || to == from) return;
      const S at = meetingAt(from, to);
      if (at > enter) {
        enter = at;
        face = i;
      }
    } else if (to > S(0)) {
      leave = min(leave, meetingAt(from, to));
    }
  }
  if (face < 0 || enter > leave) return;
  best = faceHit(a, b, enter, shape.planes[face].v0, shape.planes[face].n, S(0));
}

template <Scalar S>
void touchPoly(const PlacedShape<S>& shape, S moving, const Vector<S>& a, const Vector<S>& b,
               SegmentQueryInfo<S>& best) {
  const S reach = shape.radius + moving;
  if (reach == S(0)) return cutByPoly(shape, a, b, best);
  Vector<S> previous = shape.planes[shape.count - 1].v0;
  for (int i = 0; i < shape.count; ++i) {
    const Plane<S>& edge = shape.planes[i];
    const S from = dot(edge.n, a - edge.v0) - reach, to = dot(edge.n, b - edge.v0) - reach;
    if (from >= S(0) && to <= S(0) && to < from) {
      const SegmentQueryInfo<S> found = faceHit(a, b, meetingAt(from, to), edge.v0, edge.n, shape.radius);
      const Vector<S> along = edge.v0 - previous;
      const bool onEdge = sign(exactDot(along, found.point - previous)) >= 0 &&
                          sign(exactDot(along, found.point - edge.v0)) <= 0;
      if (onEdge && (!best.hit || found.alpha < best.alpha)) best = found;
    }
    previous = edge.v0;
  }
  for (int i = 0; i < shape.count; ++i) touchCircle(shape.planes[i].v0, shape.radius, moving, a, b, best);
}

}  // namespace

template <Scalar S>
PointQueryInfo<S> pointQuery(const PlacedShape<S>& shape, const Vector<S>& point) {
  if (shape.type == ShapeType::circle) {
    return fromCore(shape.center(), point - shape.center(), shape.radius, Vector<S>(S(0), S(1)));
  }
  return queryEdges(shape, point);
}

template <Scalar S>
SegmentQueryInfo<S> segmentQuery(const PlacedShape<S>& shape, const Vector<S>& a, const Vector<S>& b,
                                 S radius) {
  const PointQueryInfo<S> start = pointQuery(shape, a);
  if (start.distance <= radius) return {true, S(0), start.point, start.gradient};
  SegmentQueryInfo<S> best{false, S(1), b, Vector<S>()};
  switch (shape.type) {
    case ShapeType::circle:
      touchCircle(shape.center(), shape.radius, radius, a, b, best);
      break;
    case ShapeType::segment:
      touchSegment(shape, radius, a, b, best);
      break;
    case ShapeType::poly:
      touchPoly(shape, radius, a, b, best);
      break;
  }
  // A circle that begins in touch hits, and so does one that ends in touch, by the same measure.
  if (!best.hit && contains(inflate(shape.box, radius), b)) {
    const PointQueryInfo<S> end = pointQuery(shape, b);
    if (end.distance <= radius) return {true, S(1), end.point, end.gradient};
  }
  return best;
}

#define SAMESTEP_EACH_SCALAR                                                         \
  template PointQueryInfo<S> pointQuery<S>(const PlacedShape<S>&, const Vector<S>&); \
  template SegmentQueryInfo<S> segmentQuery<S>(const PlacedShape<S>&, const Vector<S>&, const Vector<S>&, S);
#include <samestep/each_scalar.h>

}  // namespace samestep
