// SPDX-License-Identifier: MIT
#include "narrow_phase/epa.h"

#include <utility>

namespace samestep {
namespace {

/// A vertex of the growing polygon and the edge that begins there. Clockwise: outside is to the left.
template <Scalar S>
struct HullEdge {
  MinkowskiPoint<S> from;
  Vector<S> inward;  // Unit normal.
  S distance{};      // It is from the origin along `inward`: at most 0 round an origin inside.
};

/// The polygon grows by at most one vertex in each iteration.
constexpr int kMaxHull = 3 + kMaxEpaIterations;

/// Room for the edges without the work of clearing it.
template <Scalar S>
union HullRoom {
  HullEdge<S> edges[kMaxHull];
  HullRoom() {}
};

template <Scalar S>
void measure(HullEdge<S>& edge, const MinkowskiPoint<S>& to) {
  require<Fault::SameVertices>(edge.from.ab != to.ab);
  edge.inward = rperp(normalize(to.ab - edge.from.ab));
  edge.distance = dot(edge.inward, edge.from.ab);
}

/// Side of the place of an edge's line that is nearest to the origin: -1 before the edge, 1 behind it, 0 on
/// it.
template <Scalar S>
int sideOfFoot(const Vector<S>& from, const Vector<S>& to) {
  if (sign(exactDot(to - from, from)) > 0) return -1;
  return sign(exactDot(to - from, to)) < 0 ? 1 : 0;
}

/// The edge nearest to the origin; of equals the last, then the first: Chipmunk's order. Of edges all but in
/// one line rounded distances may prefer one that ends elsewhere: from there it is downhill, by exact signs,
/// to the one that the nearest place lies on.
template <Scalar S>
int nearest(const HullEdge<S>* hull, int count) {
  int best = count - 1;
  for (int i = 0; i + 1 < count; ++i) {
    if (hull[i].distance > hull[best].distance) best = i;
  }
  for (int step = 0; step < count; ++step) {
    const int next = best + 1 < count ? best + 1 : 0;
    const int side = sideOfFoot(hull[best].from.ab, hull[next].from.ab);
    if (side == 0) break;
    best = side > 0 ? next : (best == 0 ? count : best) - 1;
  }
  return best;
}

/// True if a point is a vertex of the polygon already. In double, where a vertex may seem to lie outside of
/// an edge that is not its own, it need not be an end of that edge.
template <Scalar S>
bool isVertex(const HullEdge<S>* hull, int count, const Vector<S>& point) {
  for (int i = 0; i < count; ++i) {
    if (hull[i].from.ab == point) return true;
  }
  return false;
}

/// True if c lies outside of the edge from a to b; in double only where rounding cannot have moved it there.
/// Points in line with the edge would else be put in between its ends, wherever they are, and the polygon
/// turned inside out.
template <Scalar S>
bool isOutside(const Vector<S>& a, const Vector<S>& b, const Vector<S>& c) {
  if constexpr (kIsFixed<S>) {
    return leftOf(a, b, c);
  } else {
    const auto size = [](const Vector<S>& v) { return max(abs(v.x), abs(v.y)); };
    const Vector<S> edge = b - a, twice = (a - c) + (b - c);
    const S rounding = max(max(size(a), size(b)), size(c)) * S(0x1p-51);
    return exactCross(edge, twice) < -rounding * (size(edge) + size(twice));
  }
}

/// Puts p between the ends of edge `at` and leaves out what is then no corner any more.
/// @return how many vertices `grown` has; less than two, in double, where all others are within rounding of
/// one line through p: then no edge is left
template <Scalar S>
int insert(const HullEdge<S>* hull, int count, int at, const MinkowskiPoint<S>& p, HullEdge<S>* grown) {
  grown[0].from = p;
  int kept = 1;
  bool adjacent = false;  // True if the last vertex kept is followed by this one in the old polygon too.
  for (int i = 0; i < count; ++i) {
    const int index = at + 1 + i < count ? at + 1 + i : at + 1 + i - count;
    const int after = index + 1 < count ? index + 1 : 0;
    const MinkowskiPoint<S>& next = i + 1 < count ? hull[after].from : p;
    if (isOutside(grown[kept - 1].from.ab, next.ab, hull[index].from.ab)) {
      grown[kept] = hull[index];
      if (!adjacent) measure(grown[kept - 1], grown[kept].from);
      ++kept;
      adjacent = true;
    } else {
      adjacent = false;
    }
  }
  if (kept > 1) measure(grown[kept - 1], p);
  return kept;
}

template <Scalar S>
ClosestPoints<S> closestPoints(const HullEdge<S>& edge, const MinkowskiPoint<S>& to) {
  const MinkowskiPoint<S>& from = edge.from;
  return {edge.inward, edge.distance, from.id() << 16 | to.id(), from.a == to.a ? from.a : -1,
          from.b == to.b ? from.b : -1};
}

}  // namespace

template <Scalar S>
ClosestPoints<S> epa(const SupportPair<S>& pair, const MinkowskiPoint<S>& v0, const MinkowskiPoint<S>& v1,
                     const MinkowskiPoint<S>& v2, CollisionStats* stats) {
  HullRoom<S> rooms[2];
  HullEdge<S>* hull = rooms[0].edges;
  HullEdge<S>* grown = rooms[1].edges;
  hull[0].from = v0;
  hull[1].from = v1;
  hull[2].from = v2;
  int count = 3;
  for (int i = 0; i < count; ++i) measure(hull[i], hull[i + 1 < count ? i + 1 : 0].from);

  for (int iteration = 1;; ++iteration) {
    const int at = nearest(hull, count);
    const MinkowskiPoint<S>& from = hull[at].from;
    const MinkowskiPoint<S>& to = hull[at + 1 < count ? at + 1 : 0].from;
    const MinkowskiPoint<S> p = pair.farthest(perp(to.ab - from.ab));

    const bool ends =
        isVertex(hull, count, p.ab) || iteration >= kMaxEpaIterations || !isOutside(from.ab, to.ab, p.ab);
    const int corners = ends ? 0 : insert(hull, count, at, p, grown);
    if (corners < 2) {
      if (stats != nullptr && iteration >= kWarnEpaIterations) ++stats->highEpaIterations;
      return closestPoints(hull[at], to);
    }
    count = corners;
    std::swap(hull, grown);
  }
}

#define SAMESTEP_EACH_SCALAR                                                        \
  template ClosestPoints<S> epa<S>(const SupportPair<S>&, const MinkowskiPoint<S>&, \
                                   const MinkowskiPoint<S>&, const MinkowskiPoint<S>&, CollisionStats*);
#include <samestep/each_scalar.h>

}  // namespace samestep
