// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/shape.h>

namespace samestep {

/// A circle of `radius` around `offset` in the body's frame, metres; without mass.
/// @throws ValueOutOfRange (not finite), NegativeRadius, SizeOutOfRange (extent over kMaxExtent)
/// MIS: circleShapeNew, circleShapeInit
template <Scalar S>
Shape<S> circleShape(BodyId body, S radius, const Vector<S>& offset = Vector<S>());

/// Reads the geometry of a circle; a reference to a Shape that must outlive it.
template <Scalar S>
class ConstCircleShape {
 public:
  /// @throws NotCircleShape
  explicit ConstCircleShape(const Shape<S>& shape) : shape_(shape) {
    require<Fault::NotCircleShape>(shape.type() == ShapeType::circle);
  }

  /// MIS: circleShapeGetRadius
  S radius() const { return shape_.radius(); }
  /// MIS: circleShapeGetOffset
  Vector<S> offset() const { return shape_.vertices()[0]; }

 private:
  const Shape<S>& shape_;
};

/// Reads and changes the geometry of a circle. The mass stays; moment, area and centroid follow.
template <Scalar S>
class CircleShape : public ConstCircleShape<S> {
 public:
  /// @throws NotCircleShape
  explicit CircleShape(Shape<S>& shape) : ConstCircleShape<S>(shape), shape_(shape) {}

  /// @throws as circleShape
  /// MIS: circleShapeSetRadius
  void setRadius(S radius);
  /// @throws as circleShape
  /// MIS: circleShapeSetOffset
  void setOffset(const Vector<S>& offset);

  /// Makes any shape this circle; the surface, filter and ids stay, the mass too.
  static void assign(Shape<S>& shape, S radius, const Vector<S>& offset);

 private:
  Shape<S>& shape_;
};

/// kg m^2 of a ring (or disc, with one radius 0) about the origin that `offset` is measured from; exact to
/// 60 bits. Any finite radii.
template <Scalar S>
Scaled<S> scaledMomentForCircle(Scaled<S> mass, S innerRadius, S outerRadius, const Vector<S>& offset);
/// Moment of a circle, saturating. MIS: momentForCircle
template <Scalar S>
S momentForCircle(S mass, S innerRadius, S outerRadius, const Vector<S>& offset);

/// m^2 between two circles.
template <Scalar S>
Scaled<S> scaledAreaForCircle(S innerRadius, S outerRadius);
/// Area of a circle, saturating. MIS: areaForCircle
template <Scalar S>
S areaForCircle(S innerRadius, S outerRadius);

#define SAMESTEP_EACH_SCALAR extern template class CircleShape<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
