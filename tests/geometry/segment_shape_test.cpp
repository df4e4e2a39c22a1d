// SPDX-License-Identifier: MIT
#include <samestep/segment_shape.h>

#include <gtest/gtest.h>

#include <limits>

#include <samestep/circle_shape.h>
#include <samestep/error.h>

#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class SegmentShapeTest : public ::testing::Test {
 protected:
  static Vector<S> at(int x, int y) { return {S(x), S(y)}; }
};
TYPED_TEST_SUITE(SegmentShapeTest, AllScalarsAndChecked);

TYPED_TEST(SegmentShapeTest, NewSegmentHasItsEndsRadiusAndNormal) {
  using S = TypeParam;
  const Shape<S> shape = segmentShape<S>(BodyId(), TestFixture::at(1, 2), TestFixture::at(5, 2), S(1));
  const ConstSegmentShape<S> segment(shape);
  EXPECT_EQ(segment.a(), TestFixture::at(1, 2));
  EXPECT_EQ(segment.b(), TestFixture::at(5, 2));
  EXPECT_EQ(segment.radius(), S(1));
  EXPECT_EQ(segment.normal(), TestFixture::at(0, -1));
  EXPECT_EQ(segment.tangentA(), Vector<S>());
  EXPECT_EQ(shape.centerOfMass(), TestFixture::at(3, 2));
}

TYPED_TEST(SegmentShapeTest, SettersKeepMassAndTangentsAndRenewTheMoment) {
  using S = TypeParam;
  Shape<S> shape = segmentShape<S>(BodyId(), TestFixture::at(0, 0), TestFixture::at(1, 0), S(0));
  shape.setMass(S(12));
  SegmentShape<S> segment(shape);
  segment.setNeighbors(TestFixture::at(-1, 1), TestFixture::at(3, 0));
  segment.setEndpoints(TestFixture::at(-2, 0), TestFixture::at(2, 0));
  segment.setRadius(S(1));
  EXPECT_EQ(segment.a(), TestFixture::at(-2, 0));
  EXPECT_EQ(segment.b(), TestFixture::at(2, 0));
  EXPECT_EQ(segment.radius(), S(1));
  EXPECT_EQ(segment.tangentA(), TestFixture::at(-1, 1));
  EXPECT_EQ(segment.tangentB(), TestFixture::at(2, 0));
  EXPECT_EQ(shape.mass(), S(12));
  EXPECT_EQ(shape.moment(), S(40));  // A box of 6 by 2.
}

TYPED_TEST(SegmentShapeTest, AnotherTypeIsNoSegment) {
  using S = TypeParam;
  Shape<S> circle = circleShape<S>(BodyId(), S(1));
  EXPECT_THROW(SegmentShape<S>{circle}, NotSegmentShape);
  EXPECT_THROW(ConstSegmentShape<S>{circle}, NotSegmentShape);
}

TYPED_TEST(SegmentShapeTest, RefusesAPointNegativeAndTooLargeAndKeepsTheOld) {
  using S = TypeParam;
  Shape<S> shape = segmentShape<S>(BodyId(), TestFixture::at(0, 0), TestFixture::at(1, 0), S(1));
  const Shape<S> before = shape;
  SegmentShape<S> segment(shape);
  EXPECT_THROW(segment.setRadius(S(-1)), NegativeRadius);
  EXPECT_THROW(segment.setEndpoints(TestFixture::at(1, 1), TestFixture::at(1, 1)), DegenerateShape);
  EXPECT_THROW(segment.setEndpoints(TestFixture::at(kMaxExtent, 0), TestFixture::at(0, 0)), SizeOutOfRange);
  EXPECT_THROW(segment.setNeighbors(TestFixture::at(kMaxExtent + 1, 0), TestFixture::at(0, 0)),
               SizeOutOfRange);
  EXPECT_EQ(shape, before);
  EXPECT_THROW(segmentShape<S>(BodyId(), TestFixture::at(0, 0), TestFixture::at(0, 0), S(1)),
               DegenerateShape);
}

// The ground of the example scene fits.
TYPED_TEST(SegmentShapeTest, TwentyKilometresOfGroundAreAllowed) {
  using S = TypeParam;
  const Shape<S> ground =
      segmentShape<S>(BodyId(), TestFixture::at(-10000, 0), TestFixture::at(10000, 0), S(10));
  EXPECT_EQ(ground.extent(), S(10010));
}

TYPED_TEST(SegmentShapeTest, MomentForSegmentIsThatOfABox) {
  using S = TypeParam;
  EXPECT_EQ(momentForSegment<S>(S(3), TestFixture::at(-2, 0), TestFixture::at(2, 0), S(0)), S(4));
  EXPECT_EQ(momentForSegment<S>(S(3), TestFixture::at(-2, 0), TestFixture::at(2, 0), S(1)), S(10));
  EXPECT_EQ(momentForSegment<S>(S(3), TestFixture::at(1, 4), TestFixture::at(5, 4), S(0)), S(79));
}

TYPED_TEST(SegmentShapeTest, AreaForSegmentCountsTheRoundEnds) {
  using S = TypeParam;
  EXPECT_EQ(areaForSegment<S>(TestFixture::at(0, 0), TestFixture::at(3, 4), S(0)), S(0));
  EXPECT_EQ(areaForSegment<S>(TestFixture::at(0, 0), TestFixture::at(3, 4), S(1)), kPi<S> + S(10));
}

#ifndef SAMESTEP_FIXED_ONLY
TEST(SegmentShapeDoubleTest, RefusesWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_THROW(segmentShape<double>(BodyId(), {nan, 0}, {1, 0}), ValueOutOfRange);
  EXPECT_THROW(segmentShape<double>(BodyId(), {0, 0}, {1, inf}), ValueOutOfRange);
  EXPECT_THROW(segmentShape<double>(BodyId(), {0, 0}, {1, 0}, nan), ValueOutOfRange);
}
#endif

}  // namespace
}  // namespace samestep
