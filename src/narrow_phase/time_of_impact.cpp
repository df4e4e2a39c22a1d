// SPDX-License-Identifier: MIT
#include <samestep/time_of_impact.h>

#include <samestep/error.h>
#include <samestep/limits.h>

#include "base/require_ieee.h"
#include "narrow_phase/moving_shape.h"
#include "narrow_phase/nearest.h"

namespace samestep {
namespace {

/// Beyond a turn of so much, rad, the estimate of how far a turn takes a point says little.
template <Scalar S>
inline constexpr S kLongTurn = S(1);
/// The number of times a way is lengthened before the shapes are measured anew.
constexpr int kMaxLengthenings = 4;
/// The part taken off each way for what is rounded.
template <Scalar S>
inline constexpr S kPartUnit = S(0x1p-32);

/// The reach of a shape along a direction, seen from a point, while it goes on turning. Its way is no part of
/// it.
template <Scalar S>
class Reaching {
 public:
  Reaching(const MovingShape<S>& shape, const Vector<S>& direction, const Vector<S>& from)
      : turn_(shape.motion().turn), reach_(shape.reach()), count_(shape.placed().count) {
    // A shape has a vertex; compilers do not know it.
    along_[0] = rising_[0] = S(0);
    for (int i = 0; i < count_; ++i) {
      const Vector<S>& vertex = shape.placed().planes[i].v0;
      along_[i] = dot(vertex - from, direction);
      rising_[i] = turn_ == S(0) ? S(0) : cross(vertex - shape.pivot(), direction) * turn_;
    }
    ever_ = turn_ == S(0) ? after(S(0)) : dot(shape.pivot() - from, direction) + reach_;
  }

  /// Bound after another part of the motion. A vertex at an arm r that turns by d comes forward by its speed
  /// times d, plus no more than |r| d^2 / 2.
  S after(S part) const {
    S most = along_[0] + rising_[0] * part;
    for (int i = 1; i < count_; ++i) most = max(most, along_[i] + rising_[i] * part);
    const S turned = turn_ * part;
    return most + reach_ * (turned * turned) * ratio<S>(1, 2);
  }
  /// The reach however far it turns.
  S ever() const { return ever_; }

 private:
  S turn_, reach_, ever_{};
  int count_;
  S along_[kMaxPolyVertices], rising_[kMaxPolyVertices];
};

/// The least distance of two shapes along one direction while they go on.
template <Scalar S>
class Separation {
 public:
  Separation(const MovingShape<S>& a, const MovingShape<S>& b, const Vector<S>& normal)
      : a_(a, normal, a.pivot()),
        b_(b, -normal, a.pivot()),
        opening_(dot(b.motion().way - a.motion().way, normal)),
        radii_(a.placed().radius + b.placed().radius) {}

  /// A concave function of the part: it lies above each of its chords.
  S after(S part) const { return opening_ * part - (a_.after(part) + b_.after(part) + radii_); }
  /// The least of it over a part, however they turn.
  S ever(S part) const { return min(S(0), opening_ * part) - (a_.ever() + b_.ever() + radii_); }

 private:
  Reaching<S> a_, b_;
  S opening_, radii_;
};

/// The part of the motions, at most `rest`, for which the shapes stay farther apart than `kept` along one
/// direction; 0 where that cannot be told.
template <Scalar S>
S freePart(const MovingShape<S>& a, const MovingShape<S>& b, const Vector<S>& normal, S kept, S rest) {
  const Separation<S> separation(a, b, normal);
  if (separation.ever(rest) >= kept) return rest;
  const S turn = max(abs(a.motion().turn), abs(b.motion().turn));
  S far = rest;
  if (turn * rest > kLongTurn<S>) far = kLongTurn<S> / turn;
  const S atFar = separation.after(far);
  if (atFar >= kept) return far;
  S free(0), atFree = separation.after(S(0));
  // Where a chord comes down to `kept`, the function is not below it.
  for (int i = 0; i < kMaxLengthenings && atFree > kept; ++i) {
    const S longer = free + mulDiv(far - free, atFree - kept, atFree - atFar);
    if (longer <= free || longer >= far) break;
    free = longer;
    const S left = separation.after(free);
    if (left - kept <= kImpactTolerance<S> * ratio<S>(1, 4)) break;
    atFree = left;
  }
  return max(S(0), free - kPartUnit<S>);
}

template <Scalar S>
PlacedShape<S> prepared(const Shape<S>& shape, Plane<S>* local) {
  PlacedShape<S> result;
  prepare(shape, local, result);
  return result;
}

}  // namespace

template <Scalar S>
void requireMotion(const RigidMotion<S>& motion) {
  const S far = S(2) * kMaxWorldExtent<S>;
  require<Fault::ValueOutOfRange>(within(motion.pivot, S(kMaxExtent)), "a motion: the pivot is ",
                                  motion.pivot, " m, allowed are up to ", kMaxExtent, " m along each axis");
  require<Fault::ValueOutOfRange>(within(motion.start, kMaxWorldExtent<S>), "a motion: the start is ",
                                  motion.start, " m, allowed are up to ", kMaxWorldExtent<S>,
                                  " m along each axis");
  require<Fault::ValueOutOfRange>(within(motion.angle, kMaxAngle<S>), "a motion: the angle is ", motion.angle,
                                  " rad, allowed are up to ", kMaxAngle<S>, " rad");
  require<Fault::ValueOutOfRange>(within(motion.way, far), "a motion: the way is ", motion.way,
                                  " m, allowed are up to ", far, " m along each axis");
  require<Fault::ValueOutOfRange>(within(motion.turn, kMaxTurn<S>), "a motion: the turn is ", motion.turn,
                                  " rad, allowed are up to ", kMaxTurn<S>, " rad");
}

template <Scalar S>
Transform<S> RigidMotion<S>::at(S part) const {
  const Vector<S> rotation = forAngle(mulAdd(turn, part, angle));
  return Transform<S>::rigid(mulAdd(way, part, start) - rotate(pivot, rotation), rotation);
}

template <Scalar S>
RigidMotion<S> RigidMotion<S>::from(S part) const {
  const S rest = S(1) - part;
  return {pivot, mulAdd(way, part, start), mulAdd(turn, part, angle), way * rest, turn * rest};
}

template <Scalar S>
MovingShape<S>::MovingShape(const PlacedShape<S>& prepared, const RigidMotion<S>& motion)
    : placed_(prepared), motion_(motion), pivot_(motion.start) {
  placed_.planes = planes_;
  if (motion.turn == S(0)) return;
  for (int i = 0; i < placed_.count; ++i) {
    reach_ = max(reach_, length(placed_.local[i].v0 - motion.pivot));
  }
  // Rounded up, with what rounding a turned arm may add.
  reach_ += reach_ * S(0x1p-30) + S(0x1p-30);
}

template <Scalar S>
MovingShape<S>::MovingShape(const PlacedShape<S>& placed) : placed_(placed), stays_(true) {
  const int count = placed.type == ShapeType::segment ? 3 : placed.count;
  for (int i = 0; i < count; ++i) planes_[i] = placed.planes[i];
  placed_.planes = planes_;
  pivot_ = motion_.start = planes_[0].v0;
}

template <Scalar S>
const PlacedShape<S>& MovingShape<S>::at(S part) {
  if (stays_) return placed_;
  pivot_ = mulAdd(motion_.way, part, motion_.start);
  place(motion_.at(part), placed_);
  return placed_;
}

template <Scalar S>
ShapeDistance<S> distanceBetween(const PlacedShape<S>& a, const PlacedShape<S>& b) {
  const Gap<S> gap = gapBetween(a, b);
  const Vector<S> n = gap.normal;
  if (a.type == ShapeType::circle) {
    const Vector<S> onA = a.center() + n * a.radius;
    return {gap.distance, n, onA, onA + n * gap.distance};
  }
  if (b.type == ShapeType::circle) {
    const Vector<S> onB = b.center() - n * b.radius;
    return {gap.distance, n, onB - n * gap.distance, onB};
  }
  const NearestPlaces<S> places(a, b, closestOf(a, b, 0, nullptr));
  return {gap.distance, n, places.onA + n * a.radius, places.onB - n * b.radius};
}

template <Scalar S>
ShapeDistance<S> shapesDistance(const Shape<S>& a, const Transform<S>& poseA, const Shape<S>& b,
                                const Transform<S>& poseB) {
  const Placement<S> placedA(a, poseA), placedB(b, poseB);
  return distanceBetween(*placedA, *placedB);
}

template <Scalar S>
Impact<S> timeOfImpact(MovingShape<S>& a, MovingShape<S>& b, S distance) {
  const auto hitAt = [&](S part, bool found) {
    return Impact<S>{true, found, part, distanceBetween(a.placed(), b.placed())};
  };
  S part(0);
  for (int i = 0; i < kMaxImpactAdvances; ++i) {
    const Gap<S> gap = gapBetween(a.at(part), b.at(part));
    if (gap.distance <= distance) return hitAt(part, true);
    const S rest = S(1) - part;
    const S free = freePart(a, b, gap.normal, distance - kImpactTolerance<S>, rest);
    if (free >= rest) return {};
    if (free <= S(0)) return hitAt(part, false);
    part += free;
  }
  a.at(part);
  b.at(part);
  return hitAt(part, false);
}

template <Scalar S>
Impact<S> timeOfImpact(const Shape<S>& a, const RigidMotion<S>& motionA, const Shape<S>& b,
                       const RigidMotion<S>& motionB, S distance) {
  requireMotion(motionA);
  requireMotion(motionB);
  require<Fault::ValueOutOfRange>(within(distance, S(kMaxDynamicExtent)), "timeOfImpact: the distance is ",
                                  distance, " m, allowed are up to ", kMaxDynamicExtent, " m");
  Plane<S> localA[kMaxPolyVertices], localB[kMaxPolyVertices];
  MovingShape<S> movingA(prepared(a, localA), motionA), movingB(prepared(b, localB), motionB);
  return timeOfImpact(movingA, movingB, distance);
}

#define SAMESTEP_EACH_SCALAR                                                                         \
  template void requireMotion<S>(const RigidMotion<S>&);                                             \
  template struct RigidMotion<S>;                                                                    \
  template class MovingShape<S>;                                                                     \
  template ShapeDistance<S> distanceBetween<S>(const PlacedShape<S>&, const PlacedShape<S>&);        \
  template ShapeDistance<S> shapesDistance<S>(const Shape<S>&, const Transform<S>&, const Shape<S>&, \
                                              const Transform<S>&);                                  \
  template Impact<S> timeOfImpact<S>(MovingShape<S>&, MovingShape<S>&, S);                           \
  template Impact<S> timeOfImpact<S>(const Shape<S>&, const RigidMotion<S>&, const Shape<S>&,        \
                                     const RigidMotion<S>&, S);
#include <samestep/each_scalar.h>

}  // namespace samestep
