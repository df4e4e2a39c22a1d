// SPDX-License-Identifier: MIT
#include <samestep/collision.h>

#include "geometry/shape_edges.h"
#include "narrow_phase/clip.h"
#include "narrow_phase/collision_functions.h"
#include "narrow_phase/nearest.h"
#include "narrow_phase/support_faces.h"

namespace samestep {
namespace {

template <Scalar S>
void circleToCircle(const PlacedShape<S>& a, const PlacedShape<S>& b, S margin, CollisionInfo<S>& info) {
  const Vector<S> delta = b.center() - a.center();
  const S reach = a.radius + b.radius + margin;
  if (exactDot(delta, delta) >= exactProduct(reach, reach)) return;
  info.normal = delta == Vector<S>() ? Vector<S>(S(1), S(0)) : normalize(delta);
  info.push(a.center() + info.normal * a.radius, b.center() - info.normal * b.radius, 0);
}

/// The tangents of a segment towards its neighbours, in the world; zero without one.
template <Scalar S>
Vector<S> tangent(const PlacedShape<S>& segment, int end) {
  return end == 0 ? segment.planes[2].v0 : segment.planes[2].n;
}

/// True if the end of a segment may touch what lies in the direction `away`: not on its neighbour's side.
/// @param vertex  the end, or -1: no end touches
template <Scalar S>
bool endMayTouch(const PlacedShape<S>& shape, int vertex, const Vector<S>& away) {
  if (shape.type != ShapeType::segment || vertex < 0) return true;
  return sign(exactDot(away, tangent(shape, vertex))) <= 0;
}

template <Scalar S>
void circleToCorner(const PlacedShape<S>& circle, const PlacedShape<S>& other, const NearestEdge<S>& nearest,
                    S reach, CollisionInfo<S>& info) {
  const Vector<S> corner = other.planes[nearest.vertex].v0;
  const Vector<S> delta = corner - circle.center();
  const Wide<S> apart = exactDot(delta, delta), limit = exactProduct(reach, reach);
  // A segment that is only just met is not touched, a polygon is, as in Chipmunk.
  if (apart > limit || (apart == limit && other.type == ShapeType::segment)) return;
  const Vector<S> fallback =
      other.type == ShapeType::segment ? other.planes[1].n : -other.planes[nearest.edge].n;
  const Vector<S> n = delta == Vector<S>() ? fallback : normalize(delta);
  if (!endMayTouch(other, nearest.vertex, -n)) return;
  info.normal = n;
  info.push(circle.center() + n * circle.radius, corner - n * other.radius, 0);
}

/// A circle and a segment or polygon. One look at the edges finds what GJK and EPA would.
template <Scalar S>
void circleToEdges(const PlacedShape<S>& circle, const PlacedShape<S>& other, S margin,
                   CollisionInfo<S>& info) {
  const Vector<S> c = circle.center();
  const NearestEdge<S> nearest = nearestEdge(other, c);
  const S reach = circle.radius + other.radius + margin;
  if (nearest.distance > reach) return;
  if (nearest.vertex >= 0) return circleToCorner(circle, other, nearest, reach, info);
  if (nearest.distance == reach && other.type == ShapeType::segment) return;
  const Vector<S> n = -other.planes[nearest.edge].n;
  info.normal = n;
  info.push(c + n * circle.radius, c + n * (nearest.distance - other.radius), 0);
}

/// True if the ends of segments allow shapes with edges to touch there.
template <Scalar S>
bool endsMayTouch(const PlacedShape<S>& a, const PlacedShape<S>& b, const ClosestPoints<S>& closest) {
  return endMayTouch(a, closest.vertexA, closest.normal) && endMayTouch(b, closest.vertexB, -closest.normal);
}

/// Two shapes of which a face is nearest to a vertex.
/// @return false where rounding has left no point, or of faces all but in one line has preferred one that
/// ends elsewhere
template <Scalar S>
bool touchFace(const PlacedShape<S>& a, const PlacedShape<S>& b, const FaceAxis<S>& axis, S margin,
               CollisionInfo<S>& info) {
  const PlacedShape<S>&reference = axis.onB ? b : a, &other = axis.onB ? a : b;
  const Vector<S> outward = reference.planes[axis.face].n;
  if (!endMayTouch(other, axis.vertex, -outward)) return true;
  const SupportEdge<S> face = edgeTo(reference, axis.face), edge = edgeAt(other, axis.vertex, -outward);
  const bool opposite = axis.onB ? clip(edge, a.radius, face, b.radius, -outward, margin, info)
                                 : clip(face, a.radius, edge, b.radius, outward, margin, info);
  if (opposite && info.count > 0) return true;
  info.count = 0;
  return false;
}

/// True if the places of each point lie opposite each other.
template <Scalar S>
bool areOpposite(const CollisionInfo<S>& info) {
  bool all = true;
  for (int i = 0; i < info.count; ++i) {
    all = all && abs(cross(info.points[i].pointB - info.points[i].pointA, info.normal)) <= kFlat<S>;
  }
  return all;
}

/// One point, at the places where the search found the shapes nearest, or the overlap least.
template <Scalar S>
void touchWhereNearest(const PlacedShape<S>& a, const PlacedShape<S>& b, const ClosestPoints<S>& closest,
                       CollisionInfo<S>& info) {
  const NearestPlaces<S> places(a, b, closest);
  const Vector<S> n = closest.normal;
  const auto name = [](int vertex, const SupportEdge<S>& on) {
    return static_cast<std::uint32_t>(vertex >= 0 ? vertex : on.indexA);
  };
  info.push(places.onA + n * a.radius, places.onB - n * b.radius,
            name(closest.vertexA, namedEdge(a, closest, 8)) << 16 |
                name(closest.vertexB, namedEdge(b, closest, 0)));
}

/// Two shapes with edges, by the search for their nearest features.
template <Scalar S>
void touchNearest(const PlacedShape<S>& a, const PlacedShape<S>& b, CollisionId start, S margin,
                  CollisionInfo<S>& info, CollisionStats* stats) {
  const ClosestPoints<S> closest = closestOf(a, b, start, stats);
  info.id = closest.id;
  if (closest.distance > a.radius + b.radius + margin || !endsMayTouch(a, b, closest)) return;
  const Vector<S> n = closest.normal;
  const SupportEdge<S> onA = closest.vertexA >= 0 ? edgeAt(a, closest.vertexA, n) : namedEdge(a, closest, 8);
  const SupportEdge<S> onB = closest.vertexB >= 0 ? edgeAt(b, closest.vertexB, -n) : namedEdge(b, closest, 0);
  const bool facing = clip(onA, a.radius, onB, b.radius, n, margin, info);
  // The edges of two corners need not lie opposite each other, only their ends.
  const bool corners = closest.vertexA >= 0 && closest.vertexB >= 0;
  if (info.count > 0 && (facing || (corners && areOpposite(info)))) [[likely]]
    return;
  // A tip that points at the other shape may lie between the places that were looked at.
  info.count = 0;
  touchWhereNearest(a, b, closest, info);
}

/// Segments and polygons, but for two segments, which have no face towards each other's ends.
template <Scalar S>
void edgesToPoly(const PlacedShape<S>& a, const PlacedShape<S>& b, S margin, CollisionInfo<S>& info,
                 CollisionStats* stats) {
  const CollisionId start = info.id;
  if (a.count * b.count <= kMaxFacePairs) {
    const S reach = a.radius + b.radius + margin;
    const FaceAxis<S> axis = bestFace(a, b, reach, start);
    info.id = axis.id();
    if (axis.separation > reach) return;
    const bool byFace = axis.separation <= S(0) || facesVertex(a, b, axis);
    if (byFace && touchFace(a, b, axis, margin, info)) return;
    // Corners near each other; thin ones may be far apart where all faces are within rounding of touching.
  }
  touchNearest(a, b, start, margin, info, stats);
}

/// Exchanges the shapes of a contact.
template <Scalar S>
void exchange(CollisionInfo<S>& info) {
  info.normal = -info.normal;
  for (int i = 0; i < info.count; ++i) {
    const CollisionPoint<S> p = info.points[i];
    info.points[i] = {p.pointB, p.pointA, p.hash << 16 | p.hash >> 16};
  }
}

}  // namespace

template <Scalar S>
void collideSorted(const PlacedShape<S>& a, const PlacedShape<S>& b, CollisionInfo<S>& info,
                   CollisionStats* stats, S margin) {
  require<Fault::CollisionError>(a.type <= b.type);
  if (b.type == ShapeType::segment && a.type == ShapeType::segment) {
    touchNearest(a, b, info.id, margin, info, stats);
  } else if (a.type != ShapeType::circle) {
    edgesToPoly(a, b, margin, info, stats);
  } else if (b.type == ShapeType::circle) {
    circleToCircle(a, b, margin, info);
  } else {
    circleToEdges(a, b, margin, info);
  }
}

template <Scalar S>
CollisionInfo<S> collide(const PlacedShape<S>& a, const PlacedShape<S>& b, CollisionId start,
                         CollisionStats* stats, S margin) {
  CollisionInfo<S> info;
  info.id = start;
  if (a.type <= b.type) {
    collideSorted(a, b, info, stats, margin);
  } else {
    collideSorted(b, a, info, stats, margin);
    exchange(info);
  }
  return info;
}

template <Scalar S>
ContactPointSet<S> shapesCollide(const Shape<S>& a, const Transform<S>& poseA, const Shape<S>& b,
                                 const Transform<S>& poseB) {
  const Placement<S> placedA(a, poseA), placedB(b, poseB);
  const CollisionInfo<S> info = collide(*placedA, *placedB);
  ContactPointSet<S> set;
  set.count = info.count;
  if (info.count == 0) return set;
  set.normal = info.normal;
  for (int i = 0; i < info.count; ++i) {
    const CollisionPoint<S>& p = info.points[i];
    set.points[i] = {p.pointA, p.pointB, dot(p.pointB - p.pointA, info.normal)};
  }
  return set;
}

#define SAMESTEP_EACH_SCALAR                                                                          \
  template CollisionInfo<S> collide<S>(const PlacedShape<S>&, const PlacedShape<S>&, CollisionId,     \
                                       CollisionStats*, S);                                           \
  template ContactPointSet<S> shapesCollide<S>(const Shape<S>&, const Transform<S>&, const Shape<S>&, \
                                               const Transform<S>&);                                  \
  template void collideSorted<S>(const PlacedShape<S>&, const PlacedShape<S>&, CollisionInfo<S>&,     \
                                 CollisionStats*, S);
#include <samestep/each_scalar.h>

}  // namespace samestep
