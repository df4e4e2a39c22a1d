// SPDX-License-Identifier: MIT
#include <samestep/poly_shape.h>

#include <utility>
#include <vector>

#include <samestep/segment_shape.h>

#include "geometry/shape_geometry.h"

namespace samestep {
namespace {

/// Integrals over a polygon, in coordinates relative to its first vertex: differences are exact, and no term
/// grows with the distance from the origin.
template <Scalar S>
struct PolyIntegrals {
  Scaled<S> doubleArea{};              // m^2, positive counter-clockwise.
  Scaled<S> centroidX{}, centroidY{};  // m, from the first vertex.
  Scaled<S> momentAtFirst{};           // m^2, per kilogram about the first vertex.
};

template <Scalar S>
Scaled<S> squared(Scaled<S> x) {
  return x * x;
}

template <Scalar S>
PolyIntegrals<S> integrate(std::span<const Vector<S>> vertices) {
  PolyIntegrals<S> sums;
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
    const Vector<S> p = vertices[i] - vertices[0], q = vertices[i + 1] - vertices[0];
    const Scaled<S> area = toScaled(exactCross(p, q));
    sums.doubleArea += area;
    sums.centroidX += area * toScaled(p.x + q.x);
    sums.centroidY += area * toScaled(p.y + q.y);
    sums.momentAtFirst += area * toScaled(exactDot(p, p) + exactDot(p, q) + exactDot(q, q));
  }
  if (sign(sums.doubleArea) == 0) return sums;
  const Scaled<S> third = sums.doubleArea * toScaled(S(3));
  sums.centroidX = sums.centroidX / third;
  sums.centroidY = sums.centroidY / third;
  sums.momentAtFirst = sums.momentAtFirst / (third + third);
  return sums;
}

/// Moment per kilogram about the centroid.
template <Scalar S>
Scaled<S> centralMoment(const PolyIntegrals<S>& sums) {
  return sums.momentAtFirst - squared<S>(sums.centroidX) - squared<S>(sums.centroidY);
}

template <Scalar S>
std::vector<Vector<S>> transformed(std::span<const Vector<S>> points, const Transform<S>& transform) {
  const S limit(2 * kMaxExtent);
  for (const S& x : {transform.a, transform.b, transform.c, transform.d, transform.tx, transform.ty}) {
    require<Fault::ValueOutOfRange>(isFinite(x), "a polygon: a factor of its transform is ", x,
                                    ", which is not finite");
  }
  std::vector<Vector<S>> result;
  result.reserve(points.size());
  for (const Vector<S>& v : points) {
    require<Fault::ValueOutOfRange>(finite(v), "a polygon: a point is ", v, ", which is not finite");
    // Scaled: a factor of the transform may carry a point beyond the range of S.
    const auto mapped = [&](S x, S y, S t) {
      return toScaled(x) * toScaled(v.x) + toScaled(y) * toScaled(v.y) + toScaled(t);
    };
    const Scaled<S> x = mapped(transform.a, transform.c, transform.tx);
    const Scaled<S> y = mapped(transform.b, transform.d, transform.ty);
    require<Fault::SizeOutOfRange>(abs(x) <= toScaled(limit) && abs(y) <= toScaled(limit),
                                   "a polygon: its transform carries the point ", v, " farther than ", limit,
                                   " m along an axis, the most allowed");
    result.push_back(transformPoint(transform, v));
  }
  return result;
}

/// @throws DegenerateShape, which says where
template <Scalar S>
void requireConvex(std::span<const Vector<S>> vertices) {
  if (strictlyConvex(vertices)) return;
  const std::vector<Vector<S>> turned(vertices.rbegin(), vertices.rend());
  require<Fault::DegenerateShape>(!strictlyConvex(std::span<const Vector<S>>(turned)),
                                  "a polygon: its corners go clockwise, counter-clockwise is wanted");
  const std::size_t count = vertices.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vector<S>&before = vertices[(i + count - 1) % count], &after = vertices[(i + 1) % count];
    require<Fault::DegenerateShape>(sign(exactCross(vertices[i] - before, after - vertices[i])) > 0,
                                    "a polygon: it does not turn left at corner ", i, ", ", vertices[i],
                                    "; it must go counter-clockwise and be convex, without a straight angle");
  }
  fail<Fault::DegenerateShape>("a polygon: its ", count, " corners go round more than once");
}

}  // namespace

template <Scalar S>
Scaled<S> scaledMomentForPoly(Scaled<S> mass, std::span<const Vector<S>> vertices, const Vector<S>& offset) {
  require<Fault::IndexOutOfBounds>(!vertices.empty(), "scaledMomentForPoly: there are 0 vertices");
  const PolyIntegrals<S> sums = integrate(vertices);
  if (sign(sums.doubleArea) == 0) {
    const LoopIndices ends = loopIndices(vertices);
    return scaledMomentForSegment<S>(mass, vertices[static_cast<std::size_t>(ends.start)] + offset,
                                     vertices[static_cast<std::size_t>(ends.end)] + offset, S(0));
  }
  const Vector<S> first = vertices[0] + offset;
  const Scaled<S> away =
      squared<S>(toScaled(first.x) + sums.centroidX) + squared<S>(toScaled(first.y) + sums.centroidY);
  return mass * (centralMoment(sums) + away);
}

template <Scalar S>
S momentForPoly(S mass, std::span<const Vector<S>> vertices, const Vector<S>& offset, S) {
  return toScalar<S>(scaledMomentForPoly<S>(toScaled(mass), vertices, offset));
}

template <Scalar S>
Scaled<S> scaledMomentForBox(Scaled<S> mass, S width, S height) {
  return mass * toScaled(exactDot(width, width, height, height)) / toScaled(S(12));
}

template <Scalar S>
S momentForBox(S mass, S width, S height) {
  return toScalar<S>(scaledMomentForBox<S>(toScaled(mass), width, height));
}

template <Scalar S>
S momentForBox(S mass, const BB<S>& box) {
  const Vector<S> twice(box.left + box.right, box.bottom + box.top);
  const Scaled<S> m = toScaled(mass);
  return toScalar<S>(scaledMomentForBox<S>(m, box.right - box.left, box.top - box.bottom) +
                     m * scaledLengthSq(twice) * scaledRatio<S>(1, 4));
}

template <Scalar S>
Scaled<S> scaledAreaForPoly(std::span<const Vector<S>> vertices, S radius) {
  Scaled<S> perimeter{};
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    perimeter += toScaled(distance(vertices[i], vertices[i + 1 < vertices.size() ? i + 1 : 0]));
  }
  const Scaled<S> r = toScaled(radius);
  return r * (toScaled(kPi<S>) * abs(r) + perimeter) + integrate(vertices).doubleArea * scaledRatio<S>(1, 2);
}

template <Scalar S>
S areaForPoly(std::span<const Vector<S>> vertices, S radius) {
  return toScalar<S>(scaledAreaForPoly(vertices, radius));
}

template <Scalar S>
Vector<S> centroidForPoly(std::span<const Vector<S>> vertices) {
  require<Fault::IndexOutOfBounds>(!vertices.empty(), "centroidForPoly: there are 0 vertices");
  const PolyIntegrals<S> sums = integrate(vertices);
  if (sign(sums.doubleArea) == 0) {
    const LoopIndices ends = loopIndices(vertices);
    return lerp(vertices[static_cast<std::size_t>(ends.start)], vertices[static_cast<std::size_t>(ends.end)],
                ratio<S>(1, 2));
  }
  return vertices[0] + Vector<S>(toScalar<S>(sums.centroidX), toScalar<S>(sums.centroidY));
}

template <Scalar S>
ShapeMassInfo<S> polyMassInfo(S mass, std::span<const Vector<S>> vertices, S radius) {
  return {mass, centroidForPoly(vertices), centralMoment(integrate(vertices)),
          scaledAreaForPoly(vertices, radius)};
}

template <Scalar S>
Shape<S> polyShape(BodyId body, std::span<const Vector<S>> points, const Transform<S>& transform, S radius) {
  Shape<S> shape;
  shape.setBody(body);
  PolyShape<S>::assignHull(shape, points, transform, radius);
  return shape;
}

template <Scalar S>
Shape<S> polyShapeRaw(BodyId body, std::span<const Vector<S>> vertices, S radius) {
  Shape<S> shape;
  shape.setBody(body);
  PolyShape<S>::assign(shape, vertices, radius);
  return shape;
}

template <Scalar S>
Shape<S> boxShape(BodyId body, S width, S height, S radius) {
  require<Fault::ValueOutOfRange>(isFinite(width) && isFinite(height), "a box: width is ", width,
                                  " m and height ", height, " m, not both finite");
  require<Fault::NegativeHalfDimensions>(width >= S(0) && height >= S(0), "a box: width is ", width,
                                         " m and height ", height, " m, allowed are 0 and above");
  const S half = ratio<S>(1, 2);
  return boxShape(body, BB<S>::forExtents(Vector<S>(), width * half, height * half), radius);
}

template <Scalar S>
Shape<S> boxShape(BodyId body, const BB<S>& box, S radius) {
  const Vector<S> corners[] = {
      {box.right, box.bottom}, {box.right, box.top}, {box.left, box.top}, {box.left, box.bottom}};
  for (const Vector<S>& v : corners)
    require<Fault::ValueOutOfRange>(finite(v), "a box: a corner is ", v, ", which is not finite");
  require<Fault::NegativeHalfDimensions>(box.left <= box.right && box.bottom <= box.top,
                                         "a box: it goes from ", corners[3], " to ", corners[1],
                                         ", left to right and up is allowed");
  return polyShapeRaw<S>(body, corners, radius);
}

template <Scalar S>
void PolyShape<S>::assign(Shape<S>& shape, std::span<const Vector<S>> vertices, S radius) {
  require<Fault::DegenerateShape>(vertices.size() >= 3, "a polygon: there are ", vertices.size(),
                                  " corners, allowed are 3 to ", kMaxPolyVertices);
  require<Fault::TooManyVertices>(vertices.size() <= kMaxPolyVertices, "a polygon: there are ",
                                  vertices.size(), " corners, allowed are 3 to ", kMaxPolyVertices);
  requireSupported(vertices, radius, "a polygon");
  requireConvex(vertices);
  shape.setGeometry(ShapeType::poly, vertices, radius, polyMassInfo(shape.mass(), vertices, radius));
}

template <Scalar S>
void PolyShape<S>::assignHull(Shape<S>& shape, std::span<const Vector<S>> points,
                              const Transform<S>& transform, S radius) {
  require<Fault::DegenerateShape>(points.size() >= 3, "a polygon: there are ", points.size(),
                                  " points, at least 3 are wanted");
  // The points are moved first: a mirroring transform turns the direction round.
  std::vector<Vector<S>> hull = transformed(points, transform);
  const int count = convexHull<S>(std::span<const Vector<S>>(hull), std::span(hull));
  assign(shape, std::span<const Vector<S>>(hull).first(static_cast<std::size_t>(count)), radius);
}

template <Scalar S>
void PolyShape<S>::setVertices(std::span<const Vector<S>> points, const Transform<S>& transform) {
  assignHull(shape_, points, transform, this->radius());
}

template <Scalar S>
void PolyShape<S>::setVerticesRaw(std::span<const Vector<S>> vertices) {
  assign(shape_, vertices, this->radius());
}

template <Scalar S>
void PolyShape<S>::setRadius(S radius) {
  assign(shape_, std::as_const(shape_).vertices(), radius);
}

#define SAMESTEP_EACH_SCALAR                                                                          \
  template class PolyShape<S>;                                                                        \
  template Shape<S> polyShape<S>(BodyId, std::span<const Vector<S>>, const Transform<S>&, S);         \
  template Shape<S> polyShapeRaw<S>(BodyId, std::span<const Vector<S>>, S);                           \
  template Shape<S> boxShape<S>(BodyId, S, S, S);                                                     \
  template Shape<S> boxShape<S>(BodyId, const BB<S>&, S);                                             \
  template Scaled<S> scaledMomentForPoly<S>(Scaled<S>, std::span<const Vector<S>>, const Vector<S>&); \
  template S momentForPoly<S>(S, std::span<const Vector<S>>, const Vector<S>&, S);                    \
  template Scaled<S> scaledMomentForBox<S>(Scaled<S>, S, S);                                          \
  template S momentForBox<S>(S, S, S);                                                                \
  template S momentForBox<S>(S, const BB<S>&);                                                        \
  template Scaled<S> scaledAreaForPoly<S>(std::span<const Vector<S>>, S);                             \
  template S areaForPoly<S>(std::span<const Vector<S>>, S);                                           \
  template Vector<S> centroidForPoly<S>(std::span<const Vector<S>>);                                  \
  template ShapeMassInfo<S> polyMassInfo<S>(S, std::span<const Vector<S>>, S);
#include <samestep/each_scalar.h>

}  // namespace samestep
