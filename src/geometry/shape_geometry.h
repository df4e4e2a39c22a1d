// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/limits.h>
#include <samestep/shape.h>

namespace samestep {

// These say what makes the geometry of a shape acceptable, and its mass: each once, for the factories, the
// setters and what is read from outside.

template <Scalar S>
bool finite(const Vector<S>& v) {
  return isFinite(v.x) && isFinite(v.y);
}

/// Metres from the origin to the farthest point. The points must lie within +-2 kMaxExtent.
template <Scalar S>
S extentOf(std::span<const Vector<S>> points, S radius) {
  S farthest(0);
  for (const Vector<S>& v : points) farthest = max(farthest, length(v));
  return farthest + radius;
}

template <Scalar S>
bool sizeSupported(std::span<const Vector<S>> points, S radius) {
  const S limit(kMaxExtent);
  if (radius > limit) return false;
  for (const Vector<S>& v : points) {
    if (!within(v, limit)) return false;
  }
  return extentOf(points, radius) <= limit;
}

/// Requires of points and radius what all shapes must have.
/// @throws ValueOutOfRange, NegativeRadius, SizeOutOfRange
/// @param what  for the error: "a circle"
template <Scalar S>
void requireSupported(std::span<const Vector<S>> points, S radius, const char* what) {
  for (const Vector<S>& v : points)
    require<Fault::ValueOutOfRange>(finite(v), what, ": a point is ", v, ", which is not finite");
  require<Fault::ValueOutOfRange>(isFinite(radius), what, ": radius is ", radius, " m, which is not finite");
  require<Fault::NegativeRadius>(radius >= S(0), what, ": radius is ", radius, " m, allowed are 0 and above");
  if (sizeSupported(points, radius)) return;
  for (const Vector<S>& v : points)
    require<Fault::SizeOutOfRange>(sizeSupported(std::span(&v, 1), S(0)), what, ": a point is ", v,
                                   " m, allowed are up to ", kMaxExtent, " m from the origin of the body");
  fail<Fault::SizeOutOfRange>(what, ": with a radius of ", radius, " m it reaches farther than ", kMaxExtent,
                              " m, the most allowed, from the origin of the body");
}

/// True if the points go counter-clockwise round a convex polygon with no straight angle. Every vertex is
/// held against every edge: a star turns left everywhere too.
template <Scalar S>
bool strictlyConvex(std::span<const Vector<S>> points) {
  const std::size_t count = points.size();
  if (count < 3) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = i + 1 < count ? i + 1 : 0;
    const Vector<S> edge = points[next] - points[i];
    for (std::size_t j = 0; j < count; ++j) {
      if (j == i || j == next) continue;
      if (sign(exactCross(edge, points[j] - points[i])) <= 0) return false;
    }
  }
  return true;
}

template <Scalar S>
bool massSupported(S mass) {
  return mass == S(0) || (mass >= kMinMass<S> && mass <= kMaxMass<S>);
}
/// @throws NaNMass, NegativeMass, InfiniteMass, MassOutOfRange
template <Scalar S>
void requireMass(S mass, const char* asked) {
  constexpr const char* is = ": mass is ";
  require<Fault::NaNMass>(!(mass != mass), asked, is, mass);
  require<Fault::NegativeMass>(mass >= S(0), asked, is, mass, " kg, allowed are 0 and ", kMinMass<S>, " to ",
                               kMaxMass<S>, " kg");
  require<Fault::InfiniteMass>(isFinite(mass), asked, is, mass, "; a body that nothing moves is static");
  require<Fault::MassOutOfRange>(massSupported(mass), asked, is, mass, " kg, allowed are 0 and ", kMinMass<S>,
                                 " to ", kMaxMass<S>, " kg");
}
/// Requires of elasticity and friction what a shape or a contact must have.
/// @param is  "Shape::setFriction: friction is "
/// @throws ValueOutOfRange, the fault F for what is negative
template <Fault F, Scalar S>
void requireMaterial(S value, const char* is) {
  require<Fault::ValueOutOfRange>(isFinite(value) && value <= S(kMaxMaterial), is, value,
                                  ", allowed are 0 to ", kMaxMaterial);
  require<F>(value >= S(0), is, value, ", allowed are 0 to ", kMaxMaterial);
}

template <Scalar S>
ShapeMassInfo<S> circleMassInfo(S mass, S radius, const Vector<S>& offset);
template <Scalar S>
ShapeMassInfo<S> segmentMassInfo(S mass, const Vector<S>& a, const Vector<S>& b, S radius);
template <Scalar S>
ShapeMassInfo<S> polyMassInfo(S mass, std::span<const Vector<S>> vertices, S radius);

/// Square of the length in the same unit, at the precision masses are kept with.
template <Scalar S>
Scaled<S> scaledLengthSq(const Vector<S>& v) {
  return toScaled(exactDot(v, v));
}
template <Scalar S>
Scaled<S> scaledRatio(int numerator, int denominator) {
  return toScaled(S(numerator)) / toScaled(S(denominator));
}

}  // namespace samestep
