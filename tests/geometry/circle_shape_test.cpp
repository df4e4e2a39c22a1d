// SPDX-License-Identifier: MIT
#include <samestep/circle_shape.h>

#include <gtest/gtest.h>

#include <limits>

#include <samestep/error.h>
#include <samestep/poly_shape.h>

#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class CircleShapeTest : public ::testing::Test {
 protected:
  static Vector<S> at(int x, int y) { return {S(x), S(y)}; }
};
TYPED_TEST_SUITE(CircleShapeTest, AllScalarsAndChecked);

TYPED_TEST(CircleShapeTest, NewCircleHasItsRadiusAndOffset) {
  using S = TypeParam;
  const Shape<S> shape = circleShape<S>(BodyId{2, 0}, S(3), TestFixture::at(4, 5));
  EXPECT_EQ(shape.type(), ShapeType::circle);
  EXPECT_EQ(ConstCircleShape<S>(shape).radius(), S(3));
  EXPECT_EQ(ConstCircleShape<S>(shape).offset(), TestFixture::at(4, 5));
  EXPECT_EQ(shape.centerOfMass(), TestFixture::at(4, 5));
}

TYPED_TEST(CircleShapeTest, SettersKeepTheMassAndRenewTheMoment) {
  using S = TypeParam;
  Shape<S> shape = circleShape<S>(BodyId(), S(1));
  shape.setMass(S(8));
  shape.setFriction(S(1));
  CircleShape<S> circle(shape);
  circle.setRadius(S(2));
  circle.setOffset(TestFixture::at(1, 1));
  EXPECT_EQ(circle.radius(), S(2));
  EXPECT_EQ(circle.offset(), TestFixture::at(1, 1));
  EXPECT_EQ(shape.mass(), S(8));
  EXPECT_EQ(shape.moment(), S(16));  // About its own centre.
  EXPECT_EQ(shape.centerOfMass(), TestFixture::at(1, 1));
  EXPECT_EQ(shape.friction(), S(1));
}

TYPED_TEST(CircleShapeTest, AnotherTypeIsNoCircle) {
  using S = TypeParam;
  Shape<S> box = boxShape<S>(BodyId(), S(1), S(1));
  EXPECT_THROW(CircleShape<S>{box}, NotCircleShape);
  EXPECT_THROW(ConstCircleShape<S>{box}, NotCircleShape);
}

TYPED_TEST(CircleShapeTest, RefusesNegativeAndTooLargeAndKeepsTheOld) {
  using S = TypeParam;
  Shape<S> shape = circleShape<S>(BodyId(), S(1));
  const Shape<S> before = shape;
  EXPECT_THROW(CircleShape<S>(shape).setRadius(S(-1)), NegativeRadius);
  EXPECT_THROW(CircleShape<S>(shape).setRadius(S(kMaxExtent + 1)), SizeOutOfRange);
  EXPECT_THROW(CircleShape<S>(shape).setOffset(TestFixture::at(kMaxExtent, 0)), SizeOutOfRange);
  EXPECT_THROW(CircleShape<S>(shape).setOffset(TestFixture::at(1 << 30, 1 << 30)), SizeOutOfRange);
  EXPECT_EQ(shape, before);
  EXPECT_THROW(circleShape<S>(BodyId(), S(-1)), NegativeRadius);
  circleShape<S>(BodyId(), S(kMaxExtent));
  circleShape<S>(BodyId(), S(0));
}

TYPED_TEST(CircleShapeTest, MomentForCircleIsThatOfARingAboutTheOrigin) {
  using S = TypeParam;
  EXPECT_EQ(momentForCircle<S>(S(2), S(0), S(4), Vector<S>()), S(16));
  EXPECT_EQ(momentForCircle<S>(S(2), S(2), S(4), Vector<S>()), S(20));
  EXPECT_EQ(momentForCircle<S>(S(2), S(0), S(4), TestFixture::at(3, 4)), S(66));
}

TYPED_TEST(CircleShapeTest, MomentsOfTheSmallestAndTheLargestKeepTheirPrecision) {
  using S = TypeParam;
  const S small = S(0x1p-20);
  EXPECT_EQ(scaledMomentForCircle<S>(toScaled(S(2)), S(0), small, Vector<S>()),
            toScaled(small) * toScaled(small));
  const S large = S(kMaxExtent);
  EXPECT_EQ(scaledMomentForCircle<S>(toScaled(S(1000000)), S(0), large, Vector<S>()),
            toScaled(S(500000)) * toScaled(large) * toScaled(large));
}

TYPED_TEST(CircleShapeTest, AreaForCircleIsThatOfARing) {
  using S = TypeParam;
  EXPECT_EQ(areaForCircle<S>(S(0), S(2)), kPi<S> * S(4));
  EXPECT_EQ(areaForCircle<S>(S(3), S(1)), kPi<S> * S(8));
  EXPECT_EQ(areaForCircle<S>(S(1), S(3)), kPi<S> * S(8));
}

#ifndef SAMESTEP_FIXED_ONLY
TEST(CircleShapeDoubleTest, RefusesWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_THROW(circleShape<double>(BodyId(), nan), ValueOutOfRange);
  EXPECT_THROW(circleShape<double>(BodyId(), inf), ValueOutOfRange);
  EXPECT_THROW(circleShape<double>(BodyId(), 1, {0, nan}), ValueOutOfRange);
}
#endif

}  // namespace
}  // namespace samestep
