// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include <samestep/control.h>
#include <samestep/error.h>

#include "support/random.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class ControlTest : public ::testing::Test {
 protected:
  using Points = std::vector<Vector<S>>;
  using Scalar = S;

  static Vector<S> at(int x, int y) { return {S(x), S(y)}; }

  static Points hullOf(const Points& points, S tolerance = S(0), int* first = nullptr) {
    Points result(points.size());
    const int count = convexHull<S>(points, result, first, tolerance);
    result.resize(static_cast<std::size_t>(count));
    return result;
  }

  static int side(const Vector<S>& a, const Vector<S>& b, const Vector<S>& c) {
    return sign(exactCross(b - a, c - a));
  }

  /// Counter-clockwise, no straight angle, nothing outside.
  static void expectHull(const Points& hull, const Points& points) {
    ASSERT_GE(hull.size(), 3u);
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Vector<S>&a = hull[i], &b = hull[(i + 1) % hull.size()], &c = hull[(i + 2) % hull.size()];
      EXPECT_GT(side(a, b, c), 0) << "corner " << i;
      for (const Vector<S>& v : points) EXPECT_GE(side(a, b, v), 0) << "edge " << i;
    }
  }
};
TYPED_TEST_SUITE(ControlTest, AllScalarsAndChecked);

// MIS section 8, fclamp and fclamp01.
TYPED_TEST(ControlTest, ClampHoldsAValueBetweenItsLimits) {
  using S = TypeParam;
  EXPECT_EQ(clamp(S(5), S(1), S(3)), S(3));
  EXPECT_EQ(clamp(S(-5), S(1), S(3)), S(1));
  EXPECT_EQ(clamp(S(2), S(1), S(3)), S(2));
  EXPECT_EQ(clamp01(S(2)), S(1));
  EXPECT_EQ(clamp01(S(-2)), S(0));
  EXPECT_EQ(clamp01(ratio<S>(1, 4)), ratio<S>(1, 4));
}

TYPED_TEST(ControlTest, LerpIsExactAtBothEndsAndGoesBeyond) {
  using S = TypeParam;
  const S a = ratio<S>(1, 3), b = ratio<S>(22, 7);
  EXPECT_EQ(lerp(a, b, S(0)), a);
  EXPECT_EQ(lerp(a, b, S(1)), b);
  EXPECT_EQ(lerp(S(2), S(6), ratio<S>(1, 4)), S(3));
  EXPECT_EQ(lerp(S(2), S(6), S(2)), S(10));
}

TYPED_TEST(ControlTest, LerpConstGoesNoFartherThanTheStepNorTheGoal) {
  using S = TypeParam;
  EXPECT_EQ(lerpConst(S(0), S(10), S(3)), S(3));
  EXPECT_EQ(lerpConst(S(10), S(0), S(3)), S(7));
  EXPECT_EQ(lerpConst(S(0), S(2), S(3)), S(2));
  EXPECT_EQ(lerpConst(S(4), S(4), S(3)), S(4));
}

// MIS section 8, loopIndices: leftmost and lowest, rightmost and highest.
TYPED_TEST(ControlTest, LoopIndicesFindsTheExtremesAndTheFirstOfEquals) {
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const typename TestFixture::Points points = {at(0, 0), at(-1, 1),  at(-1, -1), at(3, 0),
                                               at(3, 2), at(-1, -1), at(3, 2)};
  EXPECT_EQ(loopIndices<TypeParam>(points), (LoopIndices{2, 4}));
  EXPECT_EQ(loopIndices<TypeParam>(typename TestFixture::Points{at(7, 7), at(7, 7)}), (LoopIndices{0, 0}));
}

TYPED_TEST(ControlTest, LoopIndicesRefusesNoPoints) {
  EXPECT_THROW(loopIndices<TypeParam>(std::span<const Vector<TypeParam>>()), IndexOutOfBounds);
}

TYPED_TEST(ControlTest, HullOfASquareLeavesOutWhatIsInsideOnTheEdgesAndRepeated) {
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const typename TestFixture::Points points = {at(1, 1), at(2, 2), at(0, 2), at(2, 0), at(1, 0),
                                               at(0, 0), at(2, 2), at(0, 1), at(0, 0)};
  int first = -1;

  const typename TestFixture::Points hull = TestFixture::hullOf(points, TypeParam(0), &first);

  EXPECT_EQ(hull, (typename TestFixture::Points{at(0, 0), at(2, 0), at(2, 2), at(0, 2)}));
  EXPECT_EQ(first, 5);
}

TYPED_TEST(ControlTest, HullOfALineHasTwoPointsAndOfOnePointOne) {
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  EXPECT_EQ(TestFixture::hullOf({at(2, 2), at(0, 0), at(1, 1), at(3, 3)}),
            (typename TestFixture::Points{at(0, 0), at(3, 3)}));
  EXPECT_EQ(TestFixture::hullOf({at(4, 5), at(4, 5), at(4, 5)}), (typename TestFixture::Points{at(4, 5)}));
  EXPECT_EQ(TestFixture::hullOf({at(4, 5)}), (typename TestFixture::Points{at(4, 5)}));
}

// The tolerance is a distance from an edge, not from the line that it lies in.
TYPED_TEST(ControlTest, HullKeepsPointsBeyondTheEndOfALine) {
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const typename TestFixture::Points points = {at(0, 100), at(10, 0), at(5, 40), at(9, -30)};
  EXPECT_THAT(TestFixture::hullOf(points, typename TestFixture::Scalar(4)), ::testing::Contains(at(9, -30)));
}

// Three points on an edge are all equally far from a line along it: only the outer two are corners.
TYPED_TEST(ControlTest, HullLeavesOutPointsOnEdgesWhateverLineTheyAreFoundFrom) {
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const typename TestFixture::Points points = {at(7, 1),  at(-5, 0), at(-8, -3), at(-7, -6), at(7, 0),
                                               at(4, -3), at(1, -6), at(1, -5),  at(-2, -8), at(-5, 6)};
  TestFixture::expectHull(TestFixture::hullOf(points), points);
  Random random(5);
  for (int round = 0; round < 200; ++round) {
    typename TestFixture::Points grid(static_cast<std::size_t>(random.between(8, 30)));
    for (auto& v : grid) v = at(random.between(-3, 3), random.between(-3, 3));
    grid.insert(grid.end(), {at(-4, 0), at(4, 0), at(0, 4), at(0, -4)});
    TestFixture::expectHull(TestFixture::hullOf(grid), grid);
  }
}

TYPED_TEST(ControlTest, HullOfScatteredPointsIsConvexAndHoldsThemAllInPlaceToo) {
  using S = TypeParam;
  Random random(3);
  for (int round = 0; round < 60; ++round) {
    typename TestFixture::Points points(static_cast<std::size_t>(random.between(4, 60)));
    for (auto& v : points) v = {random.number<S>(-300, 300), random.number<S>(-300, 300)};
    const typename TestFixture::Points hull = TestFixture::hullOf(points);
    TestFixture::expectHull(hull, points);

    typename TestFixture::Points inPlace = points;
    const int count = convexHull<S>(std::span<const Vector<S>>(inPlace), inPlace);
    inPlace.resize(static_cast<std::size_t>(count));
    EXPECT_EQ(inPlace, hull);
  }
}

TYPED_TEST(ControlTest, HullDoesNotDependOnTheOrderOfThePoints) {
  using S = TypeParam;
  Random random(4);
  typename TestFixture::Points points(40);
  for (auto& v : points) v = {S(random.between(-6, 6)), S(random.between(-6, 6))};
  const typename TestFixture::Points hull = TestFixture::hullOf(points);
  TestFixture::expectHull(hull, points);
  for (int round = 0; round < 20; ++round) {
    for (std::size_t i = points.size(); i > 1; --i) {
      std::swap(points[i - 1], points[random.below(static_cast<std::uint32_t>(i))]);
    }
    EXPECT_EQ(TestFixture::hullOf(points), hull);
  }
}

// A truncated product would call these straight: the corner stands out by less than 2^-32 m over 512 m.
TYPED_TEST(ControlTest, HullSeesACornerBelowTheRoundingOfAProduct) {
  using S = TypeParam;
  const S step = S(0x1p-30);
  const typename TestFixture::Points points = {
      {S(0), S(0)}, {S(256), step}, {S(512), step + step + step}, {S(0), S(1)}};
  EXPECT_EQ(TestFixture::hullOf(points).size(), 4u);
}

TYPED_TEST(ControlTest, ToleranceLeavesOutShallowCorners) {
  using S = TypeParam;
  const typename TestFixture::Points points = {
      {S(0), S(0)}, {S(4), ratio<S>(-1, 8)}, {S(8), S(0)}, {S(8), S(8)}, {S(0), S(8)}};
  EXPECT_EQ(TestFixture::hullOf(points, S(0)).size(), 5u);
  EXPECT_EQ(TestFixture::hullOf(points, ratio<S>(1, 16)).size(), 5u);
  EXPECT_EQ(TestFixture::hullOf(points, ratio<S>(1, 8)).size(), 4u);
}

// Each split of a parabola's arc can leave a single point: the depth is the number of points.
TYPED_TEST(ControlTest, HullOfAnArcOfManyPointsKeepsThemAll) {
  using S = TypeParam;
  typename TestFixture::Points points;
  S x(0), y(0);
  for (int i = 0; i < 3000; ++i) {
    points.push_back({x, y});
    x = x + ratio<S>(1, 1024);
    y = y + ratio<S>(i, 1 << 20);
  }
  EXPECT_EQ(TestFixture::hullOf(points).size(), points.size());
}

TYPED_TEST(ControlTest, HullRefusesBadArguments) {
  using S = TypeParam;
  typename TestFixture::Points points(3), small(2);
  const std::span<const Vector<S>> read(points);
  EXPECT_THROW(convexHull<S>(std::span<const Vector<S>>(), points), IndexOutOfBounds);
  EXPECT_THROW(convexHull<S>(read, small), IndexOutOfBounds);
  EXPECT_THROW(convexHull<S>(read, points, nullptr, S(-1)), ValueOutOfRange);
  points[1].x = S(1 << 21);
  EXPECT_THROW(convexHull<S>(read, points), ValueOutOfRange);
}

#ifndef SAMESTEP_FIXED_ONLY
TEST(ControlDoubleTest, HullRefusesWhatIsNotFinite) {
  std::vector<Vector<double>> points(3);
  points[2].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(convexHull<double>(std::span<const Vector<double>>(points), points), ValueOutOfRange);
  points[2].y = -std::numeric_limits<double>::infinity();
  EXPECT_THROW(convexHull<double>(std::span<const Vector<double>>(points), points), ValueOutOfRange);
}
#endif

}  // namespace
}  // namespace samestep
