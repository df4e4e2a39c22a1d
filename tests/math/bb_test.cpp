// SPDX-License-Identifier: MIT
#include <samestep/bb.h>

#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "support/scalars.h"

namespace samestep {
namespace {

template <Scalar S>
class BBTest : public ::testing::Test {
 protected:
  static BB<S> box(int l, int b, int r, int t) { return {S(l), S(b), S(r), S(t)}; }
  static Vector<S> at(int x, int y) { return {S(x), S(y)}; }
};
TYPED_TEST_SUITE(BBTest, AllScalarsAndChecked);

TYPED_TEST(BBTest, HoldsItsEdgesInTheOrderLeftBottomRightTop) {
  using S = TypeParam;
  const BB<S> box(S(-1), S(-2), S(3), S(4));
  EXPECT_EQ(box.left, S(-1));
  EXPECT_EQ(box.bottom, S(-2));
  EXPECT_EQ(box.right, S(3));
  EXPECT_EQ(box.top, S(4));
  EXPECT_EQ(BB<S>(), this->box(0, 0, 0, 0));
}

TYPED_TEST(BBTest, ForExtentsGoesHalfTheSizeToEachSide) {
  using S = TypeParam;
  EXPECT_EQ(BB<S>::forExtents(this->at(1, 2), S(3), S(4)), this->box(-2, -2, 4, 6));
  EXPECT_EQ(BB<S>::forExtents(this->at(1, 2), S(0), S(0)), this->box(1, 2, 1, 2));
}

TYPED_TEST(BBTest, ForExtentsRefusesNegativeHalfDimensions) {
  using S = TypeParam;
  const S less = -ratio<S>(1, 1 << 20);
  EXPECT_THROW(BB<S>::forExtents({}, less, S(1)), NegativeHalfDimensions);
  EXPECT_THROW(BB<S>::forExtents({}, S(1), less), NegativeHalfDimensions);
  if constexpr (std::numeric_limits<S>::has_quiet_NaN) {
    EXPECT_THROW(BB<S>::forExtents({}, std::numeric_limits<S>::quiet_NaN(), S(1)), NegativeHalfDimensions);
  }
}

TYPED_TEST(BBTest, ForCircleGoesTheRadiusToEachSide) {
  using S = TypeParam;
  EXPECT_EQ(BB<S>::forCircle(this->at(1, -2), S(3)), this->box(-2, -5, 4, 1));
}

TYPED_TEST(BBTest, ForCircleRefusesANegativeRadius) {
  using S = TypeParam;
  EXPECT_THROW(BB<S>::forCircle({}, -ratio<S>(1, 1 << 20)), NegativeRadius);
  EXPECT_NO_THROW(BB<S>::forCircle({}, S(0)));
  if constexpr (std::numeric_limits<S>::has_quiet_NaN) {
    EXPECT_THROW(BB<S>::forCircle({}, std::numeric_limits<S>::quiet_NaN()), NegativeRadius);
  }
}

TYPED_TEST(BBTest, IntersectsWhereTheyShareAPointTouchingIncluded) {
  const auto box = this->box(0, 0, 2, 2);
  for (const auto& other : {this->box(1, 1, 3, 3), this->box(2, 0, 4, 2), this->box(2, 2, 3, 3),
                            this->box(-5, -5, 5, 5), this->box(1, 1, 1, 1)}) {
    EXPECT_TRUE(intersects(box, other));
    EXPECT_TRUE(intersects(other, box));
  }
  for (const auto& other : {this->box(3, 0, 4, 2), this->box(-2, 0, -1, 2), this->box(0, 3, 2, 4),
                            this->box(0, -2, 2, -1), this->box(3, 3, 4, 4)}) {
    EXPECT_FALSE(intersects(box, other));
    EXPECT_FALSE(intersects(other, box));
  }
}

TYPED_TEST(BBTest, ContainsBoxesWithinItEdgesIncluded) {
  const auto box = this->box(0, 0, 4, 4);
  EXPECT_TRUE(contains(box, this->box(1, 1, 3, 3)));
  EXPECT_TRUE(contains(box, box));
  EXPECT_FALSE(contains(box, this->box(-1, 1, 3, 3)));
  EXPECT_FALSE(contains(box, this->box(1, -1, 3, 3)));
  EXPECT_FALSE(contains(box, this->box(1, 1, 5, 3)));
  EXPECT_FALSE(contains(box, this->box(1, 1, 3, 5)));
}

TYPED_TEST(BBTest, ContainsPointsWithinItEdgesIncluded) {
  const auto box = this->box(0, 0, 4, 2);
  EXPECT_TRUE(contains(box, this->at(1, 1)));
  EXPECT_TRUE(contains(box, this->at(0, 0)));
  EXPECT_TRUE(contains(box, this->at(4, 2)));
  EXPECT_FALSE(contains(box, this->at(-1, 1)));
  EXPECT_FALSE(contains(box, this->at(5, 1)));
  EXPECT_FALSE(contains(box, this->at(1, -1)));
  EXPECT_FALSE(contains(box, this->at(1, 3)));
}

TYPED_TEST(BBTest, MergeIsTheSmallestBoxAroundBoth) {
  EXPECT_EQ(merge(this->box(0, 0, 1, 1), this->box(5, -3, 6, 0)), this->box(0, -3, 6, 1));
  EXPECT_EQ(merge(this->box(0, 0, 9, 9), this->box(1, 1, 2, 2)), this->box(0, 0, 9, 9));
}

TYPED_TEST(BBTest, ExpandTakesInAPointAndInflateGrowsEachSide) {
  using S = TypeParam;
  EXPECT_EQ(expand(this->box(0, 0, 1, 1), this->at(3, -2)), this->box(0, -2, 3, 1));
  EXPECT_EQ(expand(this->box(0, 0, 4, 4), this->at(1, 1)), this->box(0, 0, 4, 4));
  EXPECT_EQ(inflate(this->box(0, 0, 1, 2), S(3)), this->box(-3, -3, 4, 5));
}

TYPED_TEST(BBTest, CenterIsHalfWayBetweenTheEdges) {
  using S = TypeParam;
  EXPECT_EQ(center(this->box(-1, 2, 4, 6)), Vector<S>(ratio<S>(3, 2), S(4)));
}

TYPED_TEST(BBTest, AreaIsWidthTimesHeightAndMergedAreaThatOfTheMerged) {
  using S = TypeParam;
  EXPECT_EQ(area(this->box(-1, 2, 4, 6)), S(20));
  EXPECT_EQ(area(this->box(1, 2, 1, 6)), S(0));
  EXPECT_EQ(mergedArea(this->box(0, 0, 1, 1), this->box(5, -3, 6, 0)), S(24));
  EXPECT_EQ(halfPerimeter(this->box(-1, 2, 4, 6)), S(9));
}

TYPED_TEST(BBTest, ClampTakesTheNearestPointOfTheBox) {
  const auto box = this->box(0, 0, 4, 2);
  EXPECT_EQ(clampTo(box, this->at(1, 1)), this->at(1, 1));
  EXPECT_EQ(clampTo(box, this->at(-3, 1)), this->at(0, 1));
  EXPECT_EQ(clampTo(box, this->at(7, 9)), this->at(4, 2));
  EXPECT_EQ(clampTo(box, this->at(2, -1)), this->at(2, 0));
}

TYPED_TEST(BBTest, WrapMovesByWholeWidthsAndHeightsIntoTheBox) {
  using S = TypeParam;
  const auto box = this->box(-1, 2, 3, 5);
  EXPECT_EQ(wrapInto(box, this->at(0, 3)), this->at(0, 3));
  EXPECT_EQ(wrapInto(box, this->at(4, 6)), this->at(0, 3));
  EXPECT_EQ(wrapInto(box, this->at(-2, 1)), this->at(2, 4));
  EXPECT_EQ(wrapInto(box, this->at(-4001, -2998)), this->at(-1, 2));
  EXPECT_EQ(wrapInto(box, this->at(4002, 3003)), this->at(2, 3));
  // The upper edges are the lower ones of the next box.
  EXPECT_EQ(wrapInto(box, this->at(3, 5)), this->at(-1, 2));
  EXPECT_EQ(wrapInto(box, Vector<S>(ratio<S>(13, 2), ratio<S>(-1, 4))),
            Vector<S>(ratio<S>(5, 2), ratio<S>(11, 4)));
}

TYPED_TEST(BBTest, WrapIntoAnEmptySideGivesItsEdge) {
  EXPECT_EQ(wrapInto(this->box(1, 2, 1, 5), this->at(7, 6)), this->at(1, 3));
  EXPECT_EQ(wrapInto(this->box(1, 2, 4, 2), this->at(5, 6)), this->at(2, 2));
}

TEST(BBFixedTest, WrapIsExactInUnitsOfTheLastPlace) {
  const auto raw = [](std::int64_t bits) { return Fixed::fromRaw(bits); };
  const BB<Fixed> box(raw(-5), raw(10), raw(2), raw(21));
  const std::int64_t far = (std::int64_t{1} << 52) * 7 * 11;
  EXPECT_EQ(wrapInto(box, {raw(far + 3 - 5), raw(-far + 4 + 10)}), Vector<Fixed>(raw(3 - 5), raw(4 + 10)));
}

TYPED_TEST(BBTest, OffsetMovesEveryEdge) {
  EXPECT_EQ(offset(this->box(0, 1, 2, 3), this->at(10, -20)), this->box(10, -19, 12, -17));
}

}  // namespace
}  // namespace samestep
