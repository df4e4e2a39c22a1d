// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/shape.h>

namespace samestep::fuzz {

/// Puts the corners of the hull of some points first, counter-clockwise: exact, and without what the library
/// does for it. @return how many there are
/// @pre count <= kMaxPolyVertices + 1
int makeConvex(Vector<Fixed>* points, int count);

/// The vertices of two placed shapes relative to A's first: differences, as collide takes them. In Fixed, of
/// a polygon that rounding has turned inside out, or put a dent in, the hull.
template <Scalar S>
struct Cores {
  int countA = 0, countB = 0;
  Vector<S> a[kMaxPolyVertices], b[kMaxPolyVertices];
  Vector<S> origin;  ///< A's first vertex in the world.
  double size = 0;   ///< Size of both cores and the way between them, m: worth of an error of a direction.
  double shortest = 1e300;        ///< Edge of either core that has a length, m.
  bool doubled = false;           ///< True if rounding has left an edge no length.
  bool dented = false;            ///< True if a core is the hull of a polygon that is none itself.
  double reach = 0;               ///< Distance of the farthest vertex from the world's origin, m.
  mutable double narrowest = -1;  ///< Width that leastWidth found; negative: not asked yet.

  Cores(const PlacedShape<S>& first, const PlacedShape<S>& second);
};

/// Answer of trying every edge and vertex of two convex cores.
struct BruteAnswer {
  double distance = 0;       ///< Metres, negative where they overlap; a lower bound beyond the limit.
  double bestFace = -1e300;  ///< Distance from the other core of the face that has most.
  double lead = 1e300;       ///< Lead of that face over all others.
  bool corners = false;      ///< Apart, and two vertices are nearest.
};

/// Signs are exact in Fixed (products of 128 bits); only lengths are rounded, to double.
/// @param limit  cores farther apart than this are of no interest
template <Scalar S>
BruteAnswer bruteDistance(const Cores<S>& cores, double limit);

/// Metres by which a direction separates the cores; negative: by how much they overlap along it.
template <Scalar S>
double separationAlong(const Cores<S>& cores, const Vector<S>& normal);

/// The sine of the angle between a direction and the edge of a core that is most across it, of the two at the
/// vertex farthest along it; 0 also where that edge is dust. Near 0 the core is a needle that points there.
template <Scalar S>
double widthTowards(const Vector<S>* points, int count, const Vector<S>& direction);

/// The least width of the cores' Minkowski difference along the normals of their faces, metres: of two
/// parallel segments 0.
template <Scalar S>
double thickness(const Cores<S>& cores);

/// The least width of the two cores that are polygons, metres: below some units rounding may have turned one
/// inside out.
template <Scalar S>
double leastWidth(const Cores<S>& cores);

/// Distance of a point, relative to the same origin, outside of a convex core.
template <Scalar S>
double distanceToCore(const Vector<S>* points, int count, const Vector<S>& p);

/// True if a distance is that of the cores to within a tolerance, decided in rational numbers.
template <Scalar S>
bool nearExactDistance(const Cores<S>& cores, double distance, double tolerance);

}  // namespace samestep::fuzz
