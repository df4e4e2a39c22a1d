// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>

#include <samestep/collision.h>

#include "chipmunk_shapes.h"

namespace samestep {
namespace {

using PairOfTypes = std::tuple<ShapeType, ShapeType>;

constexpr int kPairs = 4000;

/// Chipmunk's answer, with what 7.0.3 gets wrong put right: its circle against a rounded polygon puts the
/// polygon's point on the wrong side of the edge.
struct Expected {
  int count = 0;
  Vector<double> normal;
  Vector<double> pointA[2], pointB[2];
};

Expected chipmunkContacts(const ShapeRecipe& a, const Transform<double>& poseA, const ShapeRecipe& b,
                          const Transform<double>& poseB) {
  const ChipmunkShape shapeA(a, poseA), shapeB(b, poseB);
  const cpContactPointSet set = cpShapesCollide(shapeA.get(), shapeB.get());
  Expected expected;
  expected.count = set.count;
  expected.normal = fromChipmunk(set.normal);
  const bool circlePoly = a.type == ShapeType::circle && b.type == ShapeType::poly;
  const bool polyCircle = a.type == ShapeType::poly && b.type == ShapeType::circle;
  for (int i = 0; i < set.count; ++i) {
    expected.pointA[i] = fromChipmunk(set.points[i].pointA);
    expected.pointB[i] = fromChipmunk(set.points[i].pointB);
    if (circlePoly) expected.pointB[i] -= expected.normal * (2 * b.radius);
    if (polyCircle) expected.pointA[i] += expected.normal * (2 * a.radius);
  }
  return expected;
}

class CollisionConformanceTest : public ::testing::TestWithParam<PairOfTypes> {
 protected:
  template <Scalar S>
  void compare(double size, double reach, double tolerance) {
    const auto [typeA, typeB] = GetParam();
    RecipeSource source(0x5a + static_cast<unsigned>(typeA) * 8 + static_cast<unsigned>(typeB));
    int touching = 0, two = 0, differing = 0;
    double worstNormal = 0, worstPoint = 0;
    for (int i = 0; i < kPairs; ++i) {
      const ShapeRecipe a = source.shape(typeA, size, source.random().oneIn(2));
      const ShapeRecipe b = source.shape(typeB, size, source.random().oneIn(2));
      const Transform<double> poseA = source.pose(reach), poseB = source.pose(reach);
      const Expected expected = chipmunkContacts(a, poseA, b, poseB);
      const ContactPointSet<S> found =
          shapesCollide(build<S>(a), convert<S>(poseA), build<S>(b), convert<S>(poseB));
      if (found.count != expected.count) {
        ++differing;
        ADD_FAILURE() << "pair " << i << ": " << found.count << " points, Chipmunk " << expected.count;
        continue;
      }
      if (found.count == 0) continue;
      ++touching;
      if (found.count == 2) ++two;
      double worst = far(toDouble(found.normal), expected.normal);
      worstNormal = std::max(worstNormal, worst);
      for (int k = 0; k < found.count; ++k) {
        const double apart = std::max(far(toDouble(found.points[k].pointA), expected.pointA[k]),
                                      far(toDouble(found.points[k].pointB), expected.pointB[k])) /
                             size;
        worstPoint = std::max(worstPoint, apart);
        worst = std::max(worst, apart);
      }
      EXPECT_LE(worst, tolerance) << "pair " << i;
    }
    RecordProperty("touching", touching);
    std::printf(
        "touching %d, in two points %d, counts differ %d; worst normal %.1e, worst point %.1e of size\n",
        touching, two, differing, worstNormal, worstPoint);
    EXPECT_GT(touching, kPairs / 20);
  }
};

TEST_P(CollisionConformanceTest, DoubleFindsTheContactsOfChipmunk) { compare<double>(2, 1, 1e-9); }
TEST_P(CollisionConformanceTest, FixedFindsTheContactsOfChipmunk) { compare<Fixed>(2, 1, 1e-6); }

std::string nameOf(const ::testing::TestParamInfo<PairOfTypes>& instance) {
  const char* names[] = {"Circle", "Segment", "Poly"};
  return std::string(names[static_cast<int>(std::get<0>(instance.param))]) +
         names[static_cast<int>(std::get<1>(instance.param))];
}

const auto kTypes = ::testing::Values(ShapeType::circle, ShapeType::segment, ShapeType::poly);

INSTANTIATE_TEST_SUITE_P(AllPairs, CollisionConformanceTest, ::testing::Combine(kTypes, kTypes), nameOf);

}  // namespace
}  // namespace samestep
