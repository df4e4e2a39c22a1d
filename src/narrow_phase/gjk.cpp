// SPDX-License-Identifier: MIT
#include "narrow_phase/gjk.h"

#include <utility>

#include "narrow_phase/epa.h"

namespace samestep {
namespace {

/// Part of an edge that is nearest to the origin. MIS: closestT, without its number
enum class Part { from, inside, to };

template <Scalar S>
Part nearestPart(const Vector<S>& v0, const Vector<S>& v1) {
  // Each end by itself: in double a sum of both would lose an end that almost coincides with the origin.
  const Vector<S> delta = v1 - v0;
  if (sign(exactDot(delta, v0)) >= 0) return Part::from;
  return sign(exactDot(delta, v1)) <= 0 ? Part::to : Part::inside;
}

/// An edge of the difference with the origin on its left or on its line.
template <Scalar S>
struct Edge {
  MinkowskiPoint<S> v0, v1;
  Part part{};
  Vector<S> search;  // Direction from the nearest part towards the origin.
  S size{};          // Size of the difference as far as it was seen, m; only in double.

  // The end that is nearest, where one is.
  const MinkowskiPoint<S>& corner() const { return part == Part::from ? v0 : v1; }
};

/// The larger of two coordinates.
template <Scalar S>
S sizeOf(const Vector<S>& v) {
  return max(abs(v.x), abs(v.y));
}

template <Scalar S>
bool isZero(const Vector<S>& v) {
  return v == Vector<S>();
}

/// True if a vertex of the difference is the origin as far as signs of products with other vertices can tell.
/// In double that is so long before it is zero: what is added to a vertex so much farther away is lost, and a
/// search that took the rest for a direction would go in a ring.
/// @param size  of the difference as far as it was seen, m
template <Scalar S>
bool isOrigin(const Vector<S>& v, [[maybe_unused]] S size) {
  if constexpr (kIsFixed<S>) {
    return isZero(v);
  } else {
    return sizeOf(v) <= size * S(0x1p-48);
  }
}

template <Scalar S>
void see(Edge<S>& edge) {
  if constexpr (!kIsFixed<S>) edge.size = max(edge.size, max(sizeOf(edge.v0.ab), sizeOf(edge.v1.ab)));
}

/// Turns the edge round if need be, and finds its nearest part and the direction to search in.
template <Scalar S>
void look(Edge<S>& edge) {
  see(edge);
  if (leftOf(edge.v1.ab, edge.v0.ab, Vector<S>())) std::swap(edge.v0, edge.v1);
  edge.part = nearestPart(edge.v0.ab, edge.v1.ab);
  const Vector<S> across = perp(edge.v1.ab - edge.v0.ab);
  if (edge.part == Part::inside) {
    edge.search = across;
    return;
  }
  edge.search = -edge.corner().ab;
  if (!isOrigin(edge.search, edge.size)) return;
  // The origin is a vertex: turn round it, edge by edge, until all lies on one side.
  edge.search = isZero(across) ? Vector<S>(S(-1), S(0)) : across;
}

/// Distance of an edge from the origin, m, and what rounding may make of that.
template <Scalar S>
struct Reach {
  S distance{}, rounding{};

  Reach() = default;
  explicit Reach(const Edge<S>& edge) {
    const Vector<S> way = edge.v1.ab - edge.v0.ab;
    distance =
        edge.part != Part::inside ? length(edge.corner().ab) : abs(cross(way, edge.v0.ab)) / length(way);
    rounding = edge.size * S(0x1p-44);
  }
  bool isFartherThan(const Reach& before) const {
    return distance > before.distance + max(rounding, before.rounding);
  }
};

/// MIS: closestPointsNew, for an edge found nearest.
template <Scalar S>
ClosestPoints<S> closestPoints(const Edge<S>& edge) {
  const MinkowskiPoint<S>&v0 = edge.v0, &v1 = edge.v1;
  ClosestPoints<S> result;
  result.id = v0.id() << 16 | v1.id();
  if (edge.part == Part::inside) {
    result.normal = rperp(normalize(v1.ab - v0.ab));
    result.distance = dot(result.normal, v0.ab);
    result.vertexA = v0.a == v1.a ? v0.a : -1;
    result.vertexB = v0.b == v1.b ? v0.b : -1;
    return result;
  }
  const MinkowskiPoint<S>& corner = edge.corner();
  result.vertexA = corner.a;
  result.vertexB = corner.b;
  // Two vertices in one place: all of B lies against the direction searched last.
  result.normal = normalize(isOrigin(corner.ab, edge.size) ? -edge.search : corner.ab);
  result.distance = length(corner.ab);
  return result;
}

/// Distance by which a direction separates the shapes, m.
template <Scalar S>
S separationAlong(const SupportPair<S>& pair, const Vector<S>& n) {
  return dot(pair.farthest(-n).ab, n);
}

/// Answer in double when rounding leads the search away again or in a ring: of two edges the one whose normal
/// separates more. A corner that seems nearer may lie on an edge that is all but in line with it.
template <Scalar S>
ClosestPoints<S> betterOf(const SupportPair<S>& pair, const Edge<S>& before, const Edge<S>& now) {
  const ClosestPoints<S> first = closestPoints(before), second = closestPoints(now);
  return separationAlong(pair, second.normal) > separationAlong(pair, first.normal) ? second : first;
}

/// True if the edge from v0 to p, and not the one from p to v1, holds the point of the triangle nearest to
/// the origin, which lies outside of the triangle or on its rim. Decided by signs alone: a point outside of
/// one edge only is nearest to that edge; one outside of both is nearest to the edge that leads towards it.
template <Scalar S>
bool nearerToFirst(const Edge<S>& edge, const MinkowskiPoint<S>& p) {
  const Vector<S>&v0 = edge.v0.ab, &v1 = edge.v1.ab;
  const int turn = sign(exactCross(v1 - v0, p.ab - v0));
  if (turn == 0) return edge.part == Part::from;
  const bool outsideFirst = turn * sign(exactCross(v0 - p.ab, v0 + p.ab)) >= 0;
  const bool outsideSecond = turn * sign(exactCross(p.ab - v1, p.ab + v1)) >= 0;
  if (outsideFirst != outsideSecond) return outsideFirst;
  return sign(exactDot(p.ab, v0 - p.ab)) < 0;
}

template <Scalar S>
bool startFrom(const SupportPair<S>& pair, std::uint32_t id, Edge<S>& edge) {
  const auto part = [&](int shift) { return static_cast<int>(id >> shift & 0xff); };
  const int a0 = part(24), b0 = part(16), a1 = part(8), b1 = part(0);
  if (id == 0 || max(a0, a1) >= pair.a.count || max(b0, b1) >= pair.b.count) return false;
  edge.v0 = pair.vertex(a0, b0);
  edge.v1 = pair.vertex(a1, b1);
  // Two old vertices may lie inside the difference now, which is no harm but on the origin itself.
  see(edge);
  return !isOrigin(edge.v0.ab, edge.size) && !isOrigin(edge.v1.ab, edge.size);
}

}  // namespace

template <Scalar S>
ClosestPoints<S> gjk(const SupportPair<S>& pair, std::uint32_t start, const Vector<S>& axis,
                     CollisionStats* stats) {
  Edge<S> edge;
  const bool warm = startFrom(pair, start, edge);
  if (!warm) {
    const Vector<S> across = isZero(axis) ? Vector<S>(S(0), S(1)) : axis;
    edge.v0 = pair.farthest(across);
    edge.v1 = pair.farthest(-across);
  }

  // In double, where rounding may send the search back to where it was: the edge before, and how near it is.
  [[maybe_unused]] Edge<S> before;
  [[maybe_unused]] Reach<S> least;
  for (int iteration = 1;; ++iteration) {
    look(edge);
    if constexpr (!kIsFixed<S>) {
      const Reach<S> reach(edge);
      if (iteration > 1 && reach.isFartherThan(least)) {
        return warm ? gjk(pair, 0, axis, stats) : betterOf(pair, before, edge);
      }
      least = reach;
    }
    const bool late = stats != nullptr && iteration >= kWarnGjkIterations;
    const Vector<S>& n = edge.search;
    const MinkowskiPoint<S> p = pair.farthest(n);
    const bool nothingNearer = exactDot(p.ab, n) <= max(exactDot(edge.v0.ab, n), exactDot(edge.v1.ab, n));
    if (nothingNearer || iteration > kMaxGjkIterations) {
      // In double a search from two old vertices of which one all but coincides with the origin may go in a
      // ring.
      if (warm && !nothingNearer) return gjk(pair, 0, axis, stats);
      if (late) ++stats->highGjkIterations;
      if constexpr (!kIsFixed<S>) {
        if (!nothingNearer) return betterOf(pair, before, edge);
      }
      return closestPoints(edge);
    }
    if (leftOf(p.ab, edge.v0.ab, Vector<S>()) && leftOf(edge.v1.ab, p.ab, Vector<S>())) {
      // Vertices of an old answer may lie inside the difference by now, where no polygon may begin.
      if (warm) return gjk(pair, 0, axis, stats);
      if (late) ++stats->highGjkToEpaIterations;
      return epa(pair, edge.v0, p, edge.v1, stats);
    }
    if constexpr (!kIsFixed<S>) before = edge;
    (nearerToFirst(edge, p) ? edge.v1 : edge.v0) = p;
  }
}

#define SAMESTEP_EACH_SCALAR \
  template ClosestPoints<S> gjk<S>(const SupportPair<S>&, std::uint32_t, const Vector<S>&, CollisionStats*);
#include <samestep/each_scalar.h>

}  // namespace samestep
