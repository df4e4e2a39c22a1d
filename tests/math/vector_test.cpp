// SPDX-License-Identifier: MIT
#include <samestep/vector.h>

#include <gtest/gtest.h>

#include "support/scalars.h"

namespace samestep {
namespace {

template <Scalar S>
class VectorTest : public ::testing::Test {
 protected:
  static S half() { return ratio<S>(1, 2); }
  static void expectNear(const Vector<S>& v, double x, double y) {
    EXPECT_NEAR(double(v.x), x, 1e-9);
    EXPECT_NEAR(double(v.y), y, 1e-9);
  }
};
TYPED_TEST_SUITE(VectorTest, AllScalarsAndChecked);

TYPED_TEST(VectorTest, HoldsItsComponentsAndBeginsAtZero) {
  using S = TypeParam;
  using V = Vector<S>;
  const V v(S(3), S(-4));
  EXPECT_EQ(v.x, S(3));
  EXPECT_EQ(v.y, S(-4));
  EXPECT_EQ(V(), V(S(0), S(0)));
}

TYPED_TEST(VectorTest, EqualOnlyIfBothComponentsAre) {
  using S = TypeParam;
  using V = Vector<S>;
  EXPECT_TRUE(V(S(1), S(2)) == V(S(1), S(2)));
  EXPECT_FALSE(V(S(1), S(2)) == V(S(1), S(3)));
  EXPECT_FALSE(V(S(1), S(2)) == V(S(0), S(2)));
  EXPECT_TRUE(V(S(1), S(2)) != V(S(2), S(1)));
}

TYPED_TEST(VectorTest, AddsSubtractsNegatesAndScalesByComponents) {
  using S = TypeParam;
  using V = Vector<S>;
  const V a(S(3), S(-4));
  const V b(S(1), this->half());
  EXPECT_EQ(a + b, V(S(4), ratio<S>(-7, 2)));
  EXPECT_EQ(a - b, V(S(2), ratio<S>(-9, 2)));
  EXPECT_EQ(-a, V(S(-3), S(4)));
  EXPECT_EQ(a * this->half(), V(ratio<S>(3, 2), S(-2)));
  EXPECT_EQ(this->half() * a, a * this->half());
  V c = a;
  c += b;
  EXPECT_EQ(c, a + b);
  c -= b;
  EXPECT_EQ(c, a);
  c *= S(2);
  EXPECT_EQ(c, a + a);
}

TYPED_TEST(VectorTest, DotAndCrossOfKnownVectors) {
  using S = TypeParam;
  using V = Vector<S>;
  EXPECT_EQ(dot(V(S(3), S(4)), V(S(-2), S(5))), S(14));
  EXPECT_EQ(dot(V(S(3), S(4)), V(S(-4), S(3))), S(0));
  EXPECT_EQ(cross(V(S(3), S(4)), V(S(-2), S(5))), S(23));
  EXPECT_EQ(cross(V(S(-2), S(5)), V(S(3), S(4))), S(-23));
  // Positive where the second lies to the left.
  EXPECT_EQ(cross(V(S(1), S(0)), V(S(0), S(1))), S(1));
}

TYPED_TEST(VectorTest, PerpTurnsLeftAndRperpTurnsRight) {
  using S = TypeParam;
  using V = Vector<S>;
  const V v(S(3), S(4));
  EXPECT_EQ(perp(v), V(S(-4), S(3)));
  EXPECT_EQ(rperp(v), V(S(4), S(-3)));
  EXPECT_EQ(perp(rperp(v)), v);
}

TYPED_TEST(VectorTest, ProjectIsTheComponentAlongTheOther) {
  using S = TypeParam;
  using V = Vector<S>;
  EXPECT_EQ(project(V(S(3), S(4)), V(S(10), S(0))), V(S(3), S(0)));
  EXPECT_EQ(project(V(S(3), S(4)), V(S(0), S(-2))), V(S(0), S(4)));
  EXPECT_EQ(project(V(S(3), S(4)), V()), V());
  this->expectNear(project(V(S(2), S(1)), V(S(3), S(4))), 1.2, 1.6);
}

TYPED_TEST(VectorTest, AnglesAndDirectionsTurnIntoEachOther) {
  using S = TypeParam;
  using V = Vector<S>;
  EXPECT_EQ(forAngle(S(0)), V(S(1), S(0)));
  this->expectNear(forAngle(S(1)), 0.5403023058681398, 0.8414709848078965);
  this->expectNear(forAngle(S(-2)), -0.4161468365471424, -0.9092974268256817);
  EXPECT_EQ(toAngle(V(S(5), S(0))), S(0));
  EXPECT_EQ(toAngle(V()), S(0));
  EXPECT_NEAR(double(toAngle(V(S(0), S(3)))), 1.5707963267948966, 1e-9);
  EXPECT_NEAR(double(toAngle(V(S(-2), S(0)))), 3.141592653589793, 1e-9);
  EXPECT_NEAR(double(toAngle(V(S(-1), S(-1)))), -2.356194490192345, 1e-9);
}

TYPED_TEST(VectorTest, RotateMultipliesAsComplexNumbersAndUnrotateUndoesIt) {
  using S = TypeParam;
  using V = Vector<S>;
  const V v(S(3), S(4));
  EXPECT_EQ(rotate(v, V(S(0), S(1))), V(S(-4), S(3)));
  EXPECT_EQ(rotate(v, V(S(2), S(-1))), V(S(10), S(5)));
  EXPECT_EQ(unrotate(v, V(S(0), S(1))), V(S(4), S(-3)));
  EXPECT_EQ(unrotate(v, V(S(2), S(-1))), V(S(2), S(11)));
  const V turned = unrotate(rotate(v, forAngle(S(1))), forAngle(S(1)));
  this->expectNear(turned, 3, 4);
}

TYPED_TEST(VectorTest, LengthsAndDistancesOfAnEgyptianTriangle) {
  using S = TypeParam;
  using V = Vector<S>;
  const V v(S(3), S(-4));
  EXPECT_EQ(lengthSq(v), S(25));
  EXPECT_EQ(length(v), S(5));
  EXPECT_EQ(length(V()), S(0));
  EXPECT_EQ(distanceSq(V(S(4), S(-2)), V(S(1), S(2))), S(25));
  EXPECT_EQ(distance(V(S(4), S(-2)), V(S(1), S(2))), S(5));
}

TYPED_TEST(VectorTest, NormalizeGivesAUnitVectorAndLeavesZeroAlone) {
  using S = TypeParam;
  using V = Vector<S>;
  EXPECT_EQ(normalize(V(S(3), S(-4))), V(ratio<S>(3, 5), ratio<S>(-4, 5)));
  EXPECT_EQ(normalize(V(S(0), S(-7))), V(S(0), S(-1)));
  EXPECT_EQ(normalize(V()), V());
}

TYPED_TEST(VectorTest, ClampShortensOnlyWhatIsTooLong) {
  using S = TypeParam;
  using V = Vector<S>;
  const V v(S(0), S(-8));
  EXPECT_EQ(clampLength(v, S(2)), V(S(0), S(-2)));
  EXPECT_EQ(clampLength(v, S(8)), v);
  EXPECT_EQ(clampLength(v, S(9)), v);
  EXPECT_EQ(clampLength(V(), S(0)), V());
  this->expectNear(clampLength(V(S(30), S(40)), S(5)), 3, 4);
}

TYPED_TEST(VectorTest, LerpGoesFromTheFirstToTheSecond) {
  using S = TypeParam;
  using V = Vector<S>;
  const V a(S(1), S(-2));
  const V b(S(5), S(6));
  EXPECT_EQ(lerp(a, b, S(0)), a);
  EXPECT_EQ(lerp(a, b, S(1)), b);
  EXPECT_EQ(lerp(a, b, ratio<S>(1, 4)), V(S(2), S(0)));
  EXPECT_EQ(lerp(a, b, S(2)), V(S(9), S(14)));
}

TYPED_TEST(VectorTest, NearExcludesTheLimitItself) {
  using S = TypeParam;
  using V = Vector<S>;
  const V a(S(1), S(1));
  const V b(S(4), S(5));
  EXPECT_FALSE(near(a, b, S(5)));
  EXPECT_TRUE(near(a, b, S(5) + ratio<S>(1, 1 << 20)));
  EXPECT_FALSE(near(a, b, S(4)));
  EXPECT_FALSE(near(a, a, S(0)));
}

// Products rounded to 2^-32 could not tell these apart.

TEST(VectorFixedTest, CrossOfAlmostParallelVectorsIsDecidedExactly) {
  using V = Vector<Fixed>;
  const Fixed unit = Fixed::epsilon();
  const V a(unit, Fixed());
  const V b(Fixed(), unit);
  EXPECT_EQ(cross(a, b), Fixed());
  EXPECT_EQ(sign(exactCross(a, b)), 1);
  EXPECT_EQ(sign(exactCross(b, a)), -1);

  const V far(Fixed(1 << 20), Fixed(1 << 20) + unit);
  EXPECT_EQ(sign(exactCross(far, far)), 0);
  EXPECT_EQ(sign(exactCross(far, V(Fixed(1 << 20), Fixed(1 << 20)))), -1);
  // (n, n + 1) x (n + 1, n + 2) = n (n + 2) - (n + 1)^2 = -1, in units of 2^-64.
  const std::int64_t n = std::int64_t{1} << 51;
  const auto raw = [](std::int64_t x, std::int64_t y) { return V(Fixed::fromRaw(x), Fixed::fromRaw(y)); };
  EXPECT_EQ(sign(exactCross(raw(n, n + 1), raw(n + 1, n + 2))), -1);
  EXPECT_EQ(sign(exactDot(raw(n, n + 1), raw(-(n + 2), n + 1))), 1);
}

TEST(VectorFixedTest, NearDecidesBelowTheRoundingOfASquare) {
  using V = Vector<Fixed>;
  const Fixed unit = Fixed::epsilon();
  const V a;
  const V b(unit, unit);
  EXPECT_TRUE(near(a, b, unit + unit));
  EXPECT_FALSE(near(a, b, unit));
}

TEST(VectorFixedTest, NormalizeIsRightFromOneUnitToTheEndOfTheRange) {
  using V = Vector<Fixed>;
  const V expected(ratio<Fixed>(3, 5), ratio<Fixed>(4, 5));
  for (int shift = 0; shift <= 60; ++shift) {
    const V v(Fixed::fromRaw(std::int64_t{3} << shift), Fixed::fromRaw(std::int64_t{4} << shift));
    EXPECT_EQ(normalize(v), expected) << shift;
    EXPECT_EQ(normalize(-v), -expected) << shift;
  }
  const Fixed unit = Fixed::epsilon();
  EXPECT_EQ(normalize(V(unit, Fixed())), V(Fixed(1), Fixed()));
  EXPECT_EQ(normalize(V(Fixed(), -unit)), V(Fixed(), Fixed(-1)));
  EXPECT_EQ(normalize(V(unit, unit)), V(Fixed(0.70710678118654752), Fixed(0.70710678118654752)));
}

}  // namespace
}  // namespace samestep
