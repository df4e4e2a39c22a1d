// SPDX-License-Identifier: MIT
#include <samestep/segment_shape.h>

#include <samestep/poly_shape.h>

#include "geometry/shape_geometry.h"

namespace samestep {

template <Scalar S>
Scaled<S> scaledMomentForSegment(Scaled<S> mass, const Vector<S>& a, const Vector<S>& b, S radius) {
  // The centre is (a + b) / 2; the square is quartered instead, which loses no bit.
  const Scaled<S> offset = scaledLengthSq(a + b) * scaledRatio<S>(1, 4);
  const S width = radius + radius;
  return scaledMomentForBox<S>(mass, distance(a, b) + width, width) + mass * offset;
}

template <Scalar S>
S momentForSegment(S mass, const Vector<S>& a, const Vector<S>& b, S radius) {
  return toScalar<S>(scaledMomentForSegment<S>(toScaled(mass), a, b, radius));
}

template <Scalar S>
Scaled<S> scaledAreaForSegment(const Vector<S>& a, const Vector<S>& b, S radius) {
  const Scaled<S> r = toScaled(radius), straight = toScaled(distance(a, b));
  return r * (toScaled(kPi<S>) * r + straight + straight);
}

template <Scalar S>
S areaForSegment(const Vector<S>& a, const Vector<S>& b, S radius) {
  return toScalar<S>(scaledAreaForSegment(a, b, radius));
}

template <Scalar S>
ShapeMassInfo<S> segmentMassInfo(S mass, const Vector<S>& a, const Vector<S>& b, S radius) {
  const S width = radius + radius;
  return {mass, lerp(a, b, ratio<S>(1, 2)),
          scaledMomentForBox<S>(toScaled(S(1)), distance(a, b) + width, width),
          scaledAreaForSegment(a, b, radius)};
}

template <Scalar S>
Shape<S> segmentShape(BodyId body, const Vector<S>& a, const Vector<S>& b, S radius) {
  Shape<S> shape;
  shape.setBody(body);
  SegmentShape<S>::assign(shape, a, b, radius);
  return shape;
}

template <Scalar S>
void SegmentShape<S>::setGeometry(Shape<S>& shape, const Vector<S>& a, const Vector<S>& b, S radius,
                                  const Vector<S>& tangentA, const Vector<S>& tangentB) {
  const Vector<S> points[] = {a, b, tangentA, tangentB};
  requireSupported<S>(std::span(points).first(2), radius, "a segment");
  require<Fault::DegenerateShape>(a != b, "a segment: both ends are ", a, ", it has no length");
  shape.setGeometry(ShapeType::segment, points, radius, segmentMassInfo(shape.mass(), a, b, radius));
}

template <Scalar S>
void SegmentShape<S>::assign(Shape<S>& shape, const Vector<S>& a, const Vector<S>& b, S radius) {
  setGeometry(shape, a, b, radius, Vector<S>(), Vector<S>());
}

template <Scalar S>
void SegmentShape<S>::setNeighbors(const Vector<S>& previous, const Vector<S>& next) {
  const Vector<S> points[] = {previous, next};
  requireSupported<S>(points, S(0), "a neighbour of a segment");
  setGeometry(shape_, this->a(), this->b(), this->radius(), previous - this->a(), next - this->b());
}

template <Scalar S>
void SegmentShape<S>::setEndpoints(const Vector<S>& a, const Vector<S>& b) {
  setGeometry(shape_, a, b, this->radius(), this->tangentA(), this->tangentB());
}

template <Scalar S>
void SegmentShape<S>::setRadius(S radius) {
  setGeometry(shape_, this->a(), this->b(), radius, this->tangentA(), this->tangentB());
}

#define SAMESTEP_EACH_SCALAR                                                                      \
  template class SegmentShape<S>;                                                                 \
  template Shape<S> segmentShape<S>(BodyId, const Vector<S>&, const Vector<S>&, S);               \
  template Scaled<S> scaledMomentForSegment<S>(Scaled<S>, const Vector<S>&, const Vector<S>&, S); \
  template S momentForSegment<S>(S, const Vector<S>&, const Vector<S>&, S);                       \
  template Scaled<S> scaledAreaForSegment<S>(const Vector<S>&, const Vector<S>&, S);              \
  template S areaForSegment<S>(const Vector<S>&, const Vector<S>&, S);                            \
  template ShapeMassInfo<S> segmentMassInfo<S>(S, const Vector<S>&, const Vector<S>&, S);
#include <samestep/each_scalar.h>

}  // namespace samestep
