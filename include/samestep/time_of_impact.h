// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/shape.h>

namespace samestep {

// Distances of two shapes, and the time at which two that move and turn first meet: functions of their
// arguments alone, outside of any Space. Filters do not count.

/// The distance of two shapes, and the places where they are nearest.
template <Scalar S>
struct ShapeDistance {
  S distance{};      ///< Distance of the surfaces, m; negative by the least way that parts them where they
                     ///< overlap.
  Vector<S> normal;  ///< Unit, from the first shape to the second.
  Vector<S> pointA;  ///< Point of the first shape's surface, nearest to the second, in the world.
  Vector<S> pointB;
};

/// The distance of two shapes under two rigid poses within the world. Where several places are equally near,
/// or a direction is not given by the geometry, it is one of them, the same for the same arguments.
template <Scalar S>
ShapeDistance<S> shapesDistance(const Shape<S>& a, const Transform<S>& poseA, const Shape<S>& b,
                                const Transform<S>& poseB);

/// The largest turn of a motion, rad: that of the fastest spin in the longest step.
template <Scalar S>
inline constexpr S kMaxTurn = S(1 << 8);

/// A motion from part 0 to part 1 of a step: a point of the body goes straight on while the body turns about
/// it, both evenly.
template <Scalar S>
struct RigidMotion {
  Vector<S> pivot{};  ///< The point that goes straight, in the body's coordinates, m.
  Vector<S> start{};  ///< Its place as it begins, in the world, m.
  S angle{};          ///< Angle of the body as it begins, rad.
  Vector<S> way{};    ///< Way of the point, m.
  S turn{};           ///< Turn of the body, rad.

  /// A body that stays where it is.
  static RigidMotion still(const Vector<S>& position, S angle = S(0)) {
    return {{}, position, angle, {}, S(0)};
  }
  /// The body's pose after a part of the motion, in [0, 1].
  Transform<S> at(S part) const;
  /// The rest of the motion from a part on.
  RigidMotion from(S part) const;

  friend bool operator==(const RigidMotion&, const RigidMotion&) = default;
};

/// The distance at which shapes have met, m, unless the caller says otherwise, and by how much less than the
/// distance asked it may have been before.
template <Scalar S>
inline constexpr S kImpactDistance = S(0x1p-12);
template <Scalar S>
inline constexpr S kImpactTolerance = S(0x1p-13);

/// The most advances of a search for a time of impact.
inline constexpr int kMaxImpactAdvances = 128;

/// The first meeting of two moving shapes.
template <Scalar S>
struct Impact {
  bool hit = false;
  /// True if they are as close as asked at `part`. False where the search ended before it could tell: at the
  /// limit of its advances, or where one unit of the part is a way longer than kImpactTolerance.
  bool found = false;
  S part{1};               ///< Part of the motions, in [0, 1]: 1 without a hit.
  ShapeDistance<S> there;  ///< The distance then, with a hit.
};

/// The first time at which two shapes come within `distance` of each other, by conservative advancement,
/// which leaves out nothing: up to `part` they were never nearer than distance - kImpactTolerance, and so it
/// never lies behind the time at which they are that near. Without a hit they stay farther apart than that
/// all the way. What comes within `distance` may count as a hit or, if it came no nearer than the tolerance,
/// as none. Shapes that are as close as they begin hit at part 0.
/// @param distance  m, in [-2^8, 2^8]: negative where they may overlap by as much before it counts. The
///                  overlap of two shapes is never deeper than half of what they measure across, together.
/// @throws ValueOutOfRange where a motion begins beyond the world, goes farther than twice across it, turns
/// by
///         more than kMaxTurn or about a point farther than kMaxExtent from its body, or for the distance
template <Scalar S>
Impact<S> timeOfImpact(const Shape<S>& a, const RigidMotion<S>& motionA, const Shape<S>& b,
                       const RigidMotion<S>& motionB, S distance = kImpactDistance<S>);

#define SAMESTEP_EACH_SCALAR extern template struct RigidMotion<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
