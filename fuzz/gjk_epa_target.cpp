// SPDX-License-Identifier: MIT
// GJK and EPA alone: cores of any convex polygons, any start, any axis.
#include "narrow_phase/gjk.h"

#include <algorithm>
#include <cmath>

#include "cases.h"
#include "check.h"
#include "distance.h"

namespace samestep::fuzz {
namespace {

struct Case {
  ShapePlan shapeA, shapeB;
  PosePlan poseA, poseB;
  bool same = false;  ///< True if B is the same shape as A.
  Vector<Fixed> axis;
  std::uint32_t start = 0;
};
Case current;

void describe() {
  print("A", current.shapeA, current.poseA);
  print("B", current.shapeB, current.poseB);
  std::fprintf(stderr, "axis (%.17g, %.17g), start %08x\n", static_cast<double>(current.axis.x),
               static_cast<double>(current.axis.y), current.start);
}

/// Ratio below which double makes no promise: the thickness of the Minkowski difference to its size.
constexpr double kThin = 0x1p-20;
/// Ratio of an edge to the size below which it makes none either.
constexpr double kDust = 0x1p-30;

template <Scalar S>
bool isVertexOf(const SupportShape<S>& shape, int vertex) {
  return vertex >= -1 && vertex < shape.count;
}

template <Scalar S>
void check(const Cores<S>& cores, const BruteAnswer& brute, const SupportPair<S>& pair,
           const ClosestPoints<S>& found, const CollisionStats& stats) {
  // GJK answers with one rounded direction times one difference. In double the edges of the difference are
  // rounded, the short ones most.
  const double turned = std::min(1.0, cores.reach * 0x1p-50 / cores.shortest);
  const double bound = kIsFixed<S> ? 4 * 0x1p-32 + cores.size * 0x1p-30
                                   : cores.size * (0x1p-46 + turned) + cores.reach * 0x1p-50;
  // A search that reached its limit of iterations answers with the best edge so far.
  const double gaveUp = stats.highEpaIterations > 0 ? cores.size * 0x1p-5 : 0;
  const double distance = static_cast<double>(found.distance);
  expectNear(distance, brute.distance, bound + gaveUp, "the distance is that of brute force");
  const double nx = static_cast<double>(found.normal.x), ny = static_cast<double>(found.normal.y);
  expectNear(nx * nx + ny * ny, 1, kIsFixed<S> ? 0x1p-30 : 0x1p-50, "the normal is a unit vector");
  expectNear(separationAlong(cores, found.normal), distance, bound + gaveUp,
             "the normal separates by the distance");
  expect(isVertexOf(pair.a, found.vertexA) && isVertexOf(pair.b, found.vertexB), "vertices are vertices");
  if (found.vertexA >= 0 && found.vertexB >= 0 && distance > bound) {
    const Vector<S> between = pair.vertex(found.vertexA, found.vertexB).ab;
    expectNear(std::hypot(static_cast<double>(between.x), static_cast<double>(between.y)), distance, bound,
               "the vertices named are nearest");
  }
}

template <Scalar S>
bool same(const ClosestPoints<S>& a, const ClosestPoints<S>& b) {
  return a.normal == b.normal && a.distance == b.distance && a.vertexA == b.vertexA && a.vertexB == b.vertexB;
}

template <Scalar S>
struct Search {
  Placed<S> a, b;
  bool make() {
    const auto shapeA = build<S>(current.shapeA);
    if (!shapeA) return false;
    const auto shapeB = current.same ? shapeA : build<S>(current.shapeB);
    if (!shapeB) return false;
    a.prepare(*shapeA);
    b.prepare(*shapeB);
    return true;
  }
};

/// @return what the search finds from the start of the case
template <Scalar S>
ClosestPoints<S> searchFrom(const SupportPair<S>& pair, std::uint32_t start, CollisionStats& stats) {
  stats = {};
  return gjk(pair, start, as<S>(current.axis), &stats);
}

template <Scalar S>
void runWith(Search<S>& search) {
  const PlacedShape<S>&a = search.a.at(transformOf<S>(current.poseA)),
        &b = search.b.at(transformOf<S>(current.poseB));
  Cores<S> cores(a, b);
  cores.reach =
      std::max({cores.reach, reachOf(current.shapeA, current.poseA), reachOf(current.shapeB, current.poseB)});
  const SupportPair<S> pair{SupportShape<S>(a), SupportShape<S>(b)};
  CollisionStats stats;
  if (!kIsFixed<S> && (thickness(cores) < cores.reach * kThin || cores.shortest < cores.reach * kDust)) {
    // Only exact products decide right in a difference that is as thin as rounding: here only that it ends.
    searchFrom<S>(pair, current.start, stats);
    return;
  }
  const BruteAnswer brute = bruteDistance(cores, 1e300);
  const ClosestPoints<S> cold = searchFrom<S>(pair, 0, stats);
  check(cores, brute, pair, cold, stats);
  for (const std::uint32_t start : {current.start, cold.id}) {
    const ClosestPoints<S> found = searchFrom<S>(pair, start, stats);
    if (start != cold.id || !same(found, cold)) check(cores, brute, pair, found, stats);
  }
}

void runChecked() {
  static Search<CheckedFixed> search;
  expect(search.make(), "CheckedFixed takes what Fixed takes");
  CollisionStats stats;
  const PlacedShape<CheckedFixed>&a = search.a.at(transformOf<CheckedFixed>(current.poseA)),
        &b = search.b.at(transformOf<CheckedFixed>(current.poseB));
  searchFrom<CheckedFixed>({SupportShape<CheckedFixed>(a), SupportShape<CheckedFixed>(b)}, current.start,
                           stats);
}

/// @param choice  a hash of the input: which of the dearer checks are made
void run(Input& input, std::uint64_t choice) {
  const std::uint64_t head = input.word();
  current = {};
  current.shapeA = readShape(input);
  resolve(current.shapeA);
  current.same = (head & 1) != 0;
  current.shapeB = current.same ? current.shapeA : readShape(input);
  resolve(current.shapeB);
  current.poseA = readPose(input, nullptr);
  current.poseB = readPose(input, &current.poseA);
  current.start = static_cast<std::uint32_t>(head >> 32);
  // A start that names vertices: garbage mostly does not.
  if ((head & 2) != 0) current.start &= 0x0f0f0f0f;
  if ((head & 4) != 0) current.axis = {input.number(), input.number()};

  static Search<Fixed> fixedSearch;
  if (!fixedSearch.make()) return;
  runWith(fixedSearch);

  if ((choice & 3) == 0) runChecked();

  static Search<double> doubleSearch;
  if ((choice & 4) == 0 && doubleSearch.make()) runWith(doubleSearch);
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  samestep::fuzz::describer() = samestep::fuzz::describe;
  samestep::fuzz::Input input(data, size);
  samestep::fuzz::guarded([&] { samestep::fuzz::run(input, samestep::fuzz::mixed(data, size)); });
  return 0;
}
