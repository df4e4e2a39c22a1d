// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <samestep/shape.h>

namespace samestep {

// Shapes and poses that break collision routines, by name: for tests, fuzzing, the envelope and benchmarks.
// All numbers are in units of 2^-32 m, so that every scalar holds them exactly.

struct RawPoint {
  std::int64_t x;
  std::int64_t y;
};

struct NastyShape {
  const char* name;
  const char* about;
  ShapeType type;
  std::int64_t radius;
  std::span<const RawPoint> points;  ///< Circle: the centre. Segment: both ends. Polygon: the vertices.
};

/// A pair of such shapes at poses in which something coincides or is barely missed.
struct NastyPair {
  const char* name;
  const char* about;
  int shapeA;  ///< Index into nastyShapes().
  RawPoint positionA;
  std::int64_t angleA;  ///< rad, in units of 2^-32.
  int shapeB;
  RawPoint positionB;
  std::int64_t angleB;
  bool touches;  ///< True if they meet to 2^-20 m, turning by an angle being rounded; else they do not.
};

std::span<const NastyShape> nastyShapes();
std::span<const NastyPair> nastyPairs();
/// @return the index, or -1
int findNastyShape(const char* name);

/// Multiples of 2^-32 as a number; 53 bits at most.
template <Scalar S>
S fromUnits(std::int64_t units) {
  return S(static_cast<double>(units) * 0x1p-32);
}
template <Scalar S>
Vector<S> fromUnits(const RawPoint& p) {
  return {fromUnits<S>(p.x), fromUnits<S>(p.y)};
}

/// The shape on a body.
template <Scalar S>
Shape<S> makeNasty(const NastyShape& shape, BodyId body = {});
template <Scalar S>
Transform<S> poseAOf(const NastyPair& pair) {
  return Transform<S>::rigid(fromUnits<S>(pair.positionA), fromUnits<S>(pair.angleA));
}
template <Scalar S>
Transform<S> poseBOf(const NastyPair& pair) {
  return Transform<S>::rigid(fromUnits<S>(pair.positionB), fromUnits<S>(pair.angleB));
}

}  // namespace samestep
