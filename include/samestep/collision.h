// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/shape.h>

namespace samestep {

template <Scalar S>
class Body;

/// Iterations after which the search for the nearest features gives up with the best found so far, and from
/// which it is remarked on: MIS section 13, but that EPA is given the 64 that two polygons of 32 vertices may
/// need, the edges of their difference, so that only rounded products of double ever make it give up.
inline constexpr int kMaxGjkIterations = 30;
inline constexpr int kMaxEpaIterations = 64;
inline constexpr int kWarnGjkIterations = 20;
inline constexpr int kWarnEpaIterations = 20;

/// The most points a pair can touch in. MIS: MAX_CONTACTS_PER_ARBITER
inline constexpr int kMaxContactsPerPair = 2;

/// Remarks of the collision search: the MIS's HighIterWarning, counted instead of printed.
struct CollisionStats {
  std::uint64_t highGjkIterations = 0;       ///< Searches that ended apart after kWarnGjkIterations or more.
  std::uint64_t highGjkToEpaIterations = 0;  ///< Searches that took as long to find an overlap.
  std::uint64_t highEpaIterations = 0;       ///< Overlaps that took kWarnEpaIterations or more to measure.
};

/// One point of contact: the two surface points, in the world, and which features made it. The same features
/// in the next step mean the same point.
template <Scalar S>
struct CollisionPoint {
  Vector<S> pointA;
  Vector<S> pointB;
  std::uint32_t hash = 0;
};

/// Manifold: the points in which two shapes touch; count 0 where they do not, and the normal then says
/// nothing.
template <Scalar S>
struct CollisionInfo {
  Vector<S> normal;  ///< Unit, from the first shape to the second.
  CollisionPoint<S> points[kMaxContactsPerPair];
  std::int32_t count = 0;
  CollisionId id = 0;  ///< Start of the next search for the same pair in the same order.

  /// @throws CollisionContactOverflow
  void push(const Vector<S>& pointA, const Vector<S>& pointB, std::uint32_t hash) {
    require<Fault::CollisionContactOverflow>(count < kMaxContactsPerPair);
    points[count++] = {pointA, pointB, hash};
  }
};

/// Finds how two placed shapes touch. Circles touch when they overlap; whatever has edges, also when it just
/// meets. A pure function: same arguments, same answer.
///
/// Fixed: moving both shapes by the same vector moves the points by it and changes nothing else. Exchanging
/// the shapes turns the normal round and exchanges the points; two points then come in the other order. (But
/// where faces lie flat on each other, to 2^-19 m, the normal is that of the first polygon's, or of the
/// segment's.) The answer is the same for every start id unless several features are equally near.
///
/// The normal is a unit vector always. Where the geometry gives none: two centres in one place (1, 0); the
/// centre of a circle on a segment, the segment's normal; two vertices in one place, the normal of an edge.
/// An end of a segment with a neighbour does not touch what lies on the neighbour's side.
///
/// @param start  the id of the last answer for this pair in this order, or 0; any value is safe
/// @param stats  if not null, remarks are counted there
/// @param margin  m, >= 0: shapes this far apart also give their nearest points, with a positive distance
/// MIS: collide
template <Scalar S>
CollisionInfo<S> collide(const PlacedShape<S>& a, const PlacedShape<S>& b, CollisionId start = 0,
                         CollisionStats* stats = nullptr, S margin = S(0));

/// One point of a ContactPointSet.
template <Scalar S>
struct ContactPoint {
  Vector<S> pointA;  ///< Point on the surface of the first shape, in the world.
  Vector<S> pointB;
  S distance{};  ///< Metres along the normal; negative where they overlap.
};

/// Manifold of two shapes, as the user sees it. MIS section 7, ContactPointSet.
template <Scalar S>
struct ContactPointSet {
  std::int32_t count = 0;
  Vector<S> normal;  ///< Unit, from the first shape to the second; zero without contact.
  ContactPoint<S> points[kMaxContactsPerPair];
};

/// Collides two shapes under two rigid poses, outside of any Space. Filters do not count.
/// MIS: shapesCollide
template <Scalar S>
ContactPointSet<S> shapesCollide(const Shape<S>& a, const Transform<S>& poseA, const Shape<S>& b,
                                 const Transform<S>& poseB);

/// The velocity of B's material at a place relative to A's there, m/s; the arms lead from the centres of mass
/// to that place, in world axes. MIS: relative_velocity
template <Scalar S>
Vector<S> relativeVelocity(const Body<S>& a, const Body<S>& b, const Vector<S>& armA, const Vector<S>& armB);
/// Its component along a unit vector. MIS: normal_relative_velocity
template <Scalar S>
S normalRelativeVelocity(const Body<S>& a, const Body<S>& b, const Vector<S>& armA, const Vector<S>& armB,
                         const Vector<S>& normal);

/// An impulse in N s at the end of an arm; see Body::applyImpulse.
/// @throws IllegalBody for an impulse that is not finite
/// MIS: apply_impulse
template <Scalar S>
void applyImpulse(Body<S>& body, const Vector<S>& impulse, const Vector<S>& arm);
/// The impulse on B and its reaction on A.
/// @throws IllegalBody, as applyImpulse
/// MIS: apply_impulses
template <Scalar S>
void applyImpulses(Body<S>& a, Body<S>& b, const Vector<S>& armA, const Vector<S>& armB,
                   const Vector<S>& impulse);
/// Applies an impulse to the velocities that only push overlapping shapes apart.
/// @throws IllegalBody, as applyImpulse
/// MIS: apply_bias_impulse
template <Scalar S>
void applyBiasImpulse(Body<S>& body, const Vector<S>& impulse, const Vector<S>& arm);
/// @throws IllegalBody, as applyImpulse
/// MIS: apply_bias_impulses
template <Scalar S>
void applyBiasImpulses(Body<S>& a, Body<S>& b, const Vector<S>& armA, const Vector<S>& armB,
                       const Vector<S>& impulse);

/// Inverse mass along an axis: the speed, in m/s, that an impulse of 1 N s along a unit vector gives the end
/// of an arm along it, 1/kg.
/// MIS: k_scalar_body
template <Scalar S>
Scaled<S> inverseMassAlong(const Body<S>& body, const Vector<S>& arm, const Vector<S>& axis);
/// The sum for two bodies. The solver has its own form, relative to the lighter body.
/// @throws UnsolvableCollision where neither can be moved
/// MIS: k_scalar
template <Scalar S>
Scaled<S> inverseMassAlong(const Body<S>& a, const Body<S>& b, const Vector<S>& armA, const Vector<S>& armB,
                           const Vector<S>& axis);

}  // namespace samestep
