// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/time_of_impact.h>

namespace samestep {

/// A shape on its way.
template <Scalar S>
class MovingShape {
 public:
  /// @param prepared  of which only what does not depend on the pose counts
  MovingShape(const PlacedShape<S>& prepared, const RigidMotion<S>& motion);
  /// A shape that stays where it is placed.
  explicit MovingShape(const PlacedShape<S>& placed);
  MovingShape(const MovingShape&) = delete;
  MovingShape& operator=(const MovingShape&) = delete;

  /// The shape after a part of its motion.
  const PlacedShape<S>& at(S part);
  const PlacedShape<S>& placed() const { return placed_; }
  const RigidMotion<S>& motion() const { return motion_; }
  /// The place of its pivot now.
  const Vector<S>& pivot() const { return pivot_; }
  /// From the pivot, no vertex is farther; 0 of a shape that does not turn.
  S reach() const { return reach_; }

 private:
  PlacedShape<S> placed_;
  RigidMotion<S> motion_;
  Vector<S> pivot_;
  S reach_{};
  bool stays_ = false;
  Plane<S> planes_[kMaxPolyVertices];
};

/// @throws ValueOutOfRange for a motion that timeOfImpact refuses
template <Scalar S>
void requireMotion(const RigidMotion<S>& motion);
/// The time of impact as for shapes.
template <Scalar S>
Impact<S> timeOfImpact(MovingShape<S>& a, MovingShape<S>& b, S distance);
/// The distance as for shapes.
template <Scalar S>
ShapeDistance<S> distanceBetween(const PlacedShape<S>& a, const PlacedShape<S>& b);

}  // namespace samestep
