// SPDX-License-Identifier: MIT
#include <samestep/circle_shape.h>

#include "geometry/shape_geometry.h"

namespace samestep {

template <Scalar S>
Scaled<S> scaledMomentForCircle(Scaled<S> mass, S innerRadius, S outerRadius, const Vector<S>& offset) {
  const Scaled<S> ring = toScaled(exactDot(innerRadius, innerRadius, outerRadius, outerRadius));
  return mass * (ring * scaledRatio<S>(1, 2) + scaledLengthSq(offset));
}

template <Scalar S>
S momentForCircle(S mass, S innerRadius, S outerRadius, const Vector<S>& offset) {
  return toScalar<S>(scaledMomentForCircle<S>(toScaled(mass), innerRadius, outerRadius, offset));
}

template <Scalar S>
Scaled<S> scaledAreaForCircle(S innerRadius, S outerRadius) {
  const Scaled<S> squares = toScaled(exactCross(innerRadius, innerRadius, outerRadius, outerRadius));
  return toScaled(kPi<S>) * abs(squares);
}

template <Scalar S>
S areaForCircle(S innerRadius, S outerRadius) {
  return toScalar<S>(scaledAreaForCircle(innerRadius, outerRadius));
}

template <Scalar S>
ShapeMassInfo<S> circleMassInfo(S mass, S radius, const Vector<S>& offset) {
  return {mass, offset, scaledMomentForCircle<S>(toScaled(S(1)), S(0), radius, Vector<S>()),
          scaledAreaForCircle(S(0), radius)};
}

template <Scalar S>
Shape<S> circleShape(BodyId body, S radius, const Vector<S>& offset) {
  Shape<S> shape;
  shape.setBody(body);
  CircleShape<S>::assign(shape, radius, offset);
  return shape;
}

template <Scalar S>
void CircleShape<S>::assign(Shape<S>& shape, S radius, const Vector<S>& offset) {
  const Vector<S> points[] = {offset};
  requireSupported<S>(points, radius);
  shape.setGeometry(ShapeType::circle, points, radius, circleMassInfo(shape.mass(), radius, offset));
}

template <Scalar S>
void CircleShape<S>::setRadius(S radius) {
  assign(shape_, radius, this->offset());
}

template <Scalar S>
void CircleShape<S>::setOffset(const Vector<S>& offset) {
  assign(shape_, this->radius(), offset);
}

#ifndef SAMESTEP_FIXED_ONLY
template class CircleShape<double>;
template Shape<double> circleShape<double>(BodyId, double, const Vector<double>&);
template Scaled<double> scaledMomentForCircle<double>(Scaled<double>, double, double, const Vector<double>&);
template double momentForCircle<double>(double, double, double, const Vector<double>&);
template Scaled<double> scaledAreaForCircle<double>(double, double);
template double areaForCircle<double>(double, double);
template ShapeMassInfo<double> circleMassInfo<double>(double, double, const Vector<double>&);
#endif
template class CircleShape<Fixed>;
template Shape<Fixed> circleShape<Fixed>(BodyId, Fixed, const Vector<Fixed>&);
template Scaled<Fixed> scaledMomentForCircle<Fixed>(Scaled<Fixed>, Fixed, Fixed, const Vector<Fixed>&);
template Fixed momentForCircle<Fixed>(Fixed, Fixed, Fixed, const Vector<Fixed>&);
template Scaled<Fixed> scaledAreaForCircle<Fixed>(Fixed, Fixed);
template Fixed areaForCircle<Fixed>(Fixed, Fixed);
template ShapeMassInfo<Fixed> circleMassInfo<Fixed>(Fixed, Fixed, const Vector<Fixed>&);
template class CircleShape<CheckedFixed>;
template Shape<CheckedFixed> circleShape<CheckedFixed>(BodyId, CheckedFixed, const Vector<CheckedFixed>&);
template Scaled<CheckedFixed> scaledMomentForCircle<CheckedFixed>(Scaled<CheckedFixed>, CheckedFixed,
                                                                  CheckedFixed, const Vector<CheckedFixed>&);
template CheckedFixed momentForCircle<CheckedFixed>(CheckedFixed, CheckedFixed, CheckedFixed,
                                                    const Vector<CheckedFixed>&);
template Scaled<CheckedFixed> scaledAreaForCircle<CheckedFixed>(CheckedFixed, CheckedFixed);
template CheckedFixed areaForCircle<CheckedFixed>(CheckedFixed, CheckedFixed);
template ShapeMassInfo<CheckedFixed> circleMassInfo<CheckedFixed>(CheckedFixed, CheckedFixed,
                                                                  const Vector<CheckedFixed>&);

}  // namespace samestep
