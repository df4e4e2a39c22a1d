// SPDX-License-Identifier: MIT
// Times of impact of any two shapes that move and turn.
#include <samestep/time_of_impact.h>

#include <algorithm>
#include <cmath>

#include <samestep/limits.h>

#include "cases.h"
#include "check.h"
#include "distance.h"

namespace samestep::fuzz {
namespace {

struct MotionPlan {
  PosePlan pose;
  Vector<Fixed> pivot, way;
  Fixed turn{};
};

struct Case {
  ShapePlan shapeA, shapeB;
  MotionPlan a, b;
  Fixed distance{};
};
Case current;

void describe() {
  print("A", current.shapeA, current.a.pose);
  print("B", current.shapeB, current.b.pose);
  for (const MotionPlan* plan : {&current.a, &current.b}) {
    std::fprintf(stderr, "pivot (%.17g, %.17g), way (%.17g, %.17g), turn %.17g\n",
                 static_cast<double>(plan->pivot.x), static_cast<double>(plan->pivot.y),
                 static_cast<double>(plan->way.x), static_cast<double>(plan->way.y),
                 static_cast<double>(plan->turn));
  }
  std::fprintf(stderr, "distance %.17g\n", static_cast<double>(current.distance));
}

/// The number of times the oracle measures the shapes.
constexpr int kMeasurements = 200;
/// The part of its size below which double makes no promise for a Minkowski difference.
constexpr double kThin = 0x1p-20;

MotionPlan readMotion(Input& input, const MotionPlan* near) {
  const std::uint64_t head = input.word();
  MotionPlan plan;
  plan.pose = readPose(input, near == nullptr ? nullptr : &near->pose);
  plan.pose.angle = clamp(plan.pose.angle, Fixed(-(1 << 20)), Fixed(1 << 20));
  const auto point = [&](Fixed limit) {
    const Fixed x = input.numberIn(-limit, limit);
    return Vector<Fixed>(x, input.numberIn(-limit, limit));
  };
  if ((head & 1) != 0) plan.pivot = point((head & 2) != 0 ? Fixed(1 << 8) : Fixed(4));
  if ((head & 4) != 0) plan.way = point((head & 8) != 0 ? Fixed(1 << 21) : Fixed(1 << 5));
  if ((head & 16) != 0) plan.turn = input.numberIn(-kMaxTurn<Fixed>, kMaxTurn<Fixed>);
  // Mostly turns of a step.
  if ((head & 96) != 0) plan.turn = plan.turn * Fixed(0x1p-6);
  return plan;
}

/// Quarters are left out: a motion's angle is a number.
template <Scalar S>
RigidMotion<S> motionOf(const MotionPlan& plan) {
  return {as<S>(plan.pivot), as<S>(plan.pose.position), as<S>(plan.pose.angle), as<S>(plan.way),
          as<S>(plan.turn)};
}

/// Two shapes and their distance at any part of their motions, by brute force.
template <Scalar S>
struct Moving {
  Placed<S> a, b;
  Shape<S> shapeA, shapeB;
  RigidMotion<S> motionA, motionB;
  double speed = 0;     ///< Bound of how much nearer they come in a whole motion, m.
  double rounding = 0;  ///< Bound of what is rounded in the last distance, m.
  bool sound = true;    ///< True while promises hold for all cores measured.

  bool make() {
    const auto builtA = build<S>(current.shapeA), builtB = build<S>(current.shapeB);
    if (!builtA || !builtB) return false;
    shapeA = *builtA;
    shapeB = *builtB;
    a.prepare(shapeA);
    b.prepare(shapeB);
    motionA = motionOf<S>(current.a);
    motionB = motionOf<S>(current.b);
    const auto lengthOf = [](const Vector<S>& v) {
      return std::hypot(static_cast<double>(v.x), static_cast<double>(v.y));
    };
    const auto turning = [&](const Shape<S>& shape, const RigidMotion<S>& motion) {
      double arm = 0;
      for (const Vector<S>& v : shape.vertices()) arm = std::max(arm, lengthOf(v - motion.pivot));
      return arm * std::fabs(static_cast<double>(motion.turn));
    };
    speed = lengthOf(motionA.way - motionB.way) + turning(shapeA, motionA) + turning(shapeB, motionB);
    sound = true;
    return true;
  }

  double distanceAt(double part) {
    const S at(part);
    const PlacedShape<S>&placedA = a.at(motionA.at(at)), &placedB = b.at(motionB.at(at));
    const Cores<S> cores(placedA, placedB);
    sound = sound && !cores.dented;
    if (!kIsFixed<S> && thickness(cores) < cores.reach * kThin) sound = false;
    rounding = 0x1p-17 + cores.size * 0x1p-29;
    return bruteDistance(cores, 1e300).distance - static_cast<double>(shapeA.radius()) -
           static_cast<double>(shapeB.radius());
  }

  /// Halves what its middle does not prove to be free, while measurements are left.
  void expectFree(double from, double to, double kept, int& left) {
    if (left-- <= 0) return;
    const double middle = static_cast<double>(S((from + to) / 2)), d = distanceAt(middle);
    if (!sound) return;
    expectAtMost(kept - rounding, d, "the shapes were no nearer before");
    if (d - speed * (to - from) / 2 * (1 + 0x1p-20) >= kept || middle <= from || middle >= to) return;
    expectFree(from, middle, kept, left);
    expectFree(middle, to, kept, left);
  }
};

template <Scalar S>
Impact<S> impactOf(const Moving<S>& moving) {
  return timeOfImpact(moving.shapeA, moving.motionA, moving.shapeB, moving.motionB, as<S>(current.distance));
}

template <Scalar S>
Impact<S> check(Moving<S>& moving) {
  const Impact<S> impact = impactOf(moving);
  const double part = static_cast<double>(impact.part), asked = static_cast<double>(current.distance);
  const double kept = asked - static_cast<double>(kImpactTolerance<S>);
  expect(part >= 0 && part <= 1 && (impact.hit || part == 1), "the part is one");
  const double there = moving.distanceAt(part);
  if (!moving.sound) return impact;
  if (impact.found) expectAtMost(there, asked + moving.rounding, "a hit is as near as asked");
  if (impact.hit) {
    expectNear(static_cast<double>(impact.there.distance), there, moving.rounding,
               "the distance is that there");
  }
  if (impact.hit && part == 0) return impact;
  int left = kMeasurements;
  moving.expectFree(0, part, kept, left);
  return impact;
}

void run(Input& input, std::uint64_t choice) {
  current = {};
  current.shapeA = readShape(input);
  resolve(current.shapeA);
  current.shapeB = readShape(input);
  resolve(current.shapeB);
  current.a = readMotion(input, nullptr);
  current.b = readMotion(input, &current.a);
  const std::uint64_t head = input.word();
  current.distance = (head & 1) != 0 ? input.numberIn(Fixed(-4), Fixed(4)) : kImpactDistance<Fixed>;

  static Moving<Fixed> fixedMoving;
  if (!fixedMoving.make()) return;
  const Impact<Fixed> impact = check(fixedMoving);
  if ((choice & 3) == 0) {
    static Moving<CheckedFixed> checkedMoving;
    expect(checkedMoving.make(), "CheckedFixed takes what Fixed takes");
    const Impact<CheckedFixed> same = impactOf(checkedMoving);
    expect(same.hit == impact.hit && same.part.raw() == impact.part.raw(),
           "CheckedFixed has the bits of Fixed");
  }
  static Moving<double> doubleMoving;
  if ((choice & 4) == 0 && doubleMoving.make()) check(doubleMoving);
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  samestep::fuzz::describer() = samestep::fuzz::describe;
  samestep::fuzz::Input input(data, size);
  samestep::fuzz::guarded([&] { samestep::fuzz::run(input, samestep::fuzz::mixed(data, size)); });
  return 0;
}
