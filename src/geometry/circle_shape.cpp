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
  requireSupported<S>(points, radius, "a circle");
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

#define SAMESTEP_EACH_SCALAR                                                      \
  template class CircleShape<S>;                                                  \
  template Shape<S> circleShape<S>(BodyId, S, const Vector<S>&);                  \
  template Scaled<S> scaledMomentForCircle<S>(Scaled<S>, S, S, const Vector<S>&); \
  template S momentForCircle<S>(S, S, S, const Vector<S>&);                       \
  template Scaled<S> scaledAreaForCircle<S>(S, S);                                \
  template S areaForCircle<S>(S, S);                                              \
  template ShapeMassInfo<S> circleMassInfo<S>(S, S, const Vector<S>&);
#include <samestep/each_scalar.h>

}  // namespace samestep
