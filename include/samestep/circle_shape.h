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
/// The same, saturating. MIS: momentForCircle
template <Scalar S>
S momentForCircle(S mass, S innerRadius, S outerRadius, const Vector<S>& offset);

/// m^2 between two circles.
template <Scalar S>
Scaled<S> scaledAreaForCircle(S innerRadius, S outerRadius);
/// The same, saturating. MIS: areaForCircle
template <Scalar S>
S areaForCircle(S innerRadius, S outerRadius);

#ifndef SAMESTEP_FIXED_ONLY
extern template class CircleShape<double>;
extern template Shape<double> circleShape<double>(BodyId, double, const Vector<double>&);
extern template Scaled<double> scaledMomentForCircle<double>(Scaled<double>, double, double,
                                                             const Vector<double>&);
extern template double momentForCircle<double>(double, double, double, const Vector<double>&);
extern template Scaled<double> scaledAreaForCircle<double>(double, double);
extern template double areaForCircle<double>(double, double);
#endif
extern template class CircleShape<Fixed>;
extern template Shape<Fixed> circleShape<Fixed>(BodyId, Fixed, const Vector<Fixed>&);
extern template Scaled<Fixed> scaledMomentForCircle<Fixed>(Scaled<Fixed>, Fixed, Fixed, const Vector<Fixed>&);
extern template Fixed momentForCircle<Fixed>(Fixed, Fixed, Fixed, const Vector<Fixed>&);
extern template Scaled<Fixed> scaledAreaForCircle<Fixed>(Fixed, Fixed);
extern template Fixed areaForCircle<Fixed>(Fixed, Fixed);
extern template class CircleShape<CheckedFixed>;
extern template Shape<CheckedFixed> circleShape<CheckedFixed>(BodyId, CheckedFixed,
                                                              const Vector<CheckedFixed>&);
extern template Scaled<CheckedFixed> scaledMomentForCircle<CheckedFixed>(Scaled<CheckedFixed>, CheckedFixed,
                                                                         CheckedFixed,
                                                                         const Vector<CheckedFixed>&);
extern template CheckedFixed momentForCircle<CheckedFixed>(CheckedFixed, CheckedFixed, CheckedFixed,
                                                           const Vector<CheckedFixed>&);
extern template Scaled<CheckedFixed> scaledAreaForCircle<CheckedFixed>(CheckedFixed, CheckedFixed);
extern template CheckedFixed areaForCircle<CheckedFixed>(CheckedFixed, CheckedFixed);

}  // namespace samestep
