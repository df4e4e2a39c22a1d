// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include <samestep/collision.h>
#include <samestep/shape.h>

#include "input.h"

namespace samestep::fuzz {

/// The numbers a shape is made from, before any check.
struct ShapePlan {
  enum class Make : std::uint8_t { circle, segment, raw, hull };
  Make make = Make::circle;
  int count = 0;
  Fixed radius{};
  Vector<Fixed> points[kMaxPolyVertices];
  bool hasNeighbors = false;
  Vector<Fixed> previous, next;
};

/// Pose of a shape. Turns are whole quarters, exact in every scalar, or an angle.
struct PosePlan {
  Vector<Fixed> position;
  int quarters = 0;
  Fixed angle{};
};

/// A shape of any kind: plain, random, regular or of the degenerate library.
ShapePlan readShape(Input& input);
/// A pose; `near` is another one that it may be close to, or null.
PosePlan readPose(Input& input, const PosePlan* near);

/// Exact for all numbers that Input makes.
template <Scalar S>
S as(Fixed x) {
  if constexpr (kIsFixed<S>) {
    return S::fromRaw(x.raw());
  } else {
    return S(static_cast<double>(x));
  }
}
template <Scalar S>
Vector<S> as(const Vector<Fixed>& v) {
  return {as<S>(v.x), as<S>(v.y)};
}

/// The shape, or none where the library refuses the plan.
template <Scalar S>
std::optional<Shape<S>> build(const ShapePlan& plan);

/// Makes a plan of a hull one of the vertices that the hull has. What the library's search makes of points is
/// the business of the target `hull`.
void resolve(ShapePlan& plan);

/// Arm of the farthest point of a shape from its body, at most, m.
double armOf(const ShapePlan& plan);
/// The largest number that places a shape, m: it rounds the vertices, even where they come to lie at the
/// origin.
double reachOf(const ShapePlan& plan, const PosePlan& pose);

template <Scalar S>
Vector<S> rotationOf(const PosePlan& pose) {
  const Vector<S> turned = pose.angle == Fixed(0) ? Vector<S>(S(1), S(0)) : forAngle(as<S>(pose.angle));
  switch (pose.quarters & 3) {
    case 0:
      return turned;
    case 1:
      return perp(turned);
    case 2:
      return -turned;
    default:
      return rperp(turned);
  }
}
template <Scalar S>
Transform<S> transformOf(const PosePlan& pose) {
  return Transform<S>::rigid(as<S>(pose.position), rotationOf<S>(pose));
}

/// Room for a shape under several poses, one after the other.
template <Scalar S>
class Placed {
 public:
  Placed() = default;
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;

  void prepare(const Shape<S>& shape) {
    placed_.planes = planes_;
    samestep::prepare(shape, local_, placed_);
  }
  const PlacedShape<S>& at(const Transform<S>& pose) {
    place(pose, placed_);
    return placed_;
  }
  const PlacedShape<S>& operator*() const { return placed_; }

 private:
  Plane<S> planes_[kMaxPolyVertices], local_[kMaxPolyVertices];
  PlacedShape<S> placed_;
};

void print(const char* name, const ShapePlan& shape, const PosePlan& pose);

}  // namespace samestep::fuzz
