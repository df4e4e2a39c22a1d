// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/shape.h>

namespace samestep {

/// The convex hull of the points under a transform, in the body's frame, grown by `radius` on all sides,
/// metres; without mass.
/// @throws ValueOutOfRange (not finite), NegativeRadius, SizeOutOfRange (extent over kMaxExtent),
///         DegenerateShape (the hull has no area), TooManyVertices (it has more than kMaxPolyVertices)
/// MIS: polyShapeNew, polyShapeInit
template <Scalar S>
Shape<S> polyShape(BodyId body, std::span<const Vector<S>> points,
                   const Transform<S>& transform = Transform<S>(), S radius = S(0));

/// The polygon with exactly these vertices, which keep their numbers.
/// @param vertices  3 to kMaxPolyVertices, counter-clockwise, every angle less than a straight one
/// @throws as polyShape; DegenerateShape also where the vertices are not as said
/// MIS: polyShapeNewRaw, polyShapeInitRaw
template <Scalar S>
Shape<S> polyShapeRaw(BodyId body, std::span<const Vector<S>> vertices, S radius = S(0));

/// A box around the body's origin, from its bottom right corner counter-clockwise.
/// @param width, height  metres, > 0
/// @throws NegativeHalfDimensions (a side is negative), DegenerateShape (a side is 0), else as polyShape
/// MIS: boxShapeNew, boxShapeInit
template <Scalar S>
Shape<S> boxShape(BodyId body, S width, S height, S radius = S(0));
/// Makes a box anywhere in the body's frame. MIS: boxShapeNew2, boxShapeInit2
template <Scalar S>
Shape<S> boxShape(BodyId body, const BB<S>& box, S radius = S(0));

/// Reads the geometry of a polygon; a reference to a Shape that must outlive it.
template <Scalar S>
class ConstPolyShape {
 public:
  /// @throws NotPolyShape
  explicit ConstPolyShape(const Shape<S>& shape) : shape_(shape) {
    require<Fault::NotPolyShape>(shape.type() == ShapeType::poly);
  }

  /// MIS: polyShapeGetCount
  int count() const { return static_cast<int>(shape_.vertices().size()); }
  /// @throws IndexOutOfBounds
  /// MIS: polyShapeGetVert
  Vector<S> vertex(int index) const {
    require<Fault::IndexOutOfBounds>(index >= 0 && index < count(), "PolyShape::vertex: ", index,
                                     " is asked for, of corners there are ", count());
    return shape_.vertices()[static_cast<std::size_t>(index)];
  }
  /// MIS: polyShapeGetRadius
  S radius() const { return shape_.radius(); }

 private:
  const Shape<S>& shape_;
};

/// Reads and changes the geometry of a polygon. The mass stays; moment, area and centroid follow.
template <Scalar S>
class PolyShape : public ConstPolyShape<S> {
 public:
  /// @throws NotPolyShape
  explicit PolyShape(Shape<S>& shape) : ConstPolyShape<S>(shape), shape_(shape) {}

  /// @throws as polyShape
  /// MIS: polyShapeSetVerts
  void setVertices(std::span<const Vector<S>> points, const Transform<S>& transform = Transform<S>());
  /// @throws as polyShapeRaw
  /// MIS: polyShapeSetVertsRaw
  void setVerticesRaw(std::span<const Vector<S>> vertices);
  /// @throws as polyShape
  /// MIS: polyShapeSetRadius
  void setRadius(S radius);

  /// Makes any shape this polygon; the surface, filter and ids stay, the mass too.
  static void assign(Shape<S>& shape, std::span<const Vector<S>> vertices, S radius);
  /// Assigns the hull of the points under a transform.
  static void assignHull(Shape<S>& shape, std::span<const Vector<S>> points, const Transform<S>& transform,
                         S radius);

 private:
  Shape<S>& shape_;
};

/// kg m^2 about the origin of the polygon moved by `offset`, without its rounding; of two vertices, as
/// momentForSegment. Vertices in either direction round, no two of them more than 2^20 m apart.
template <Scalar S>
Scaled<S> scaledMomentForPoly(Scaled<S> mass, std::span<const Vector<S>> vertices, const Vector<S>& offset);
/// Moment of a polygon, saturating. The radius does not count, as in Chipmunk. MIS: momentForPoly
template <Scalar S>
S momentForPoly(S mass, std::span<const Vector<S>> vertices, const Vector<S>& offset, S radius);

/// kg m^2 of a box about its own centre.
template <Scalar S>
Scaled<S> scaledMomentForBox(Scaled<S> mass, S width, S height);
/// Moment of a box, saturating.
template <Scalar S>
S momentForBox(S mass, S width, S height);
/// kg m^2 of a box about the origin; saturates.
template <Scalar S>
S momentForBox(S mass, const BB<S>& box);

/// m^2 of a polygon with its rounding; the part inside the vertices is negative where they go clockwise.
template <Scalar S>
Scaled<S> scaledAreaForPoly(std::span<const Vector<S>> vertices, S radius);
/// Area of a polygon, saturating. MIS: areaForPoly
template <Scalar S>
S areaForPoly(std::span<const Vector<S>> vertices, S radius);

/// The centre of mass of a polygon; the mean of the extremes where it has no area. MIS: centroidForPoly
template <Scalar S>
Vector<S> centroidForPoly(std::span<const Vector<S>> vertices);

#define SAMESTEP_EACH_SCALAR extern template class PolyShape<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
