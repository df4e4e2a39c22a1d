#include "samestep/wide.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "samestep/fixed_math.h"
#include "test_random.h"

namespace samestep {
namespace {

using Native = WideFixed<Fixed, way::NativeWords>;
using Portable = WideFixed<Fixed, way::PortableWords>;

template <class T>
class WideTest : public ::testing::Test {};
using WideTypes = ::testing::Types<Native, Portable>;
TYPED_TEST_SUITE(WideTest, WideTypes);

TYPED_TEST(WideTest, SignOfATinyAreaIsExact) {
  const Fixed unit = Fixed::epsilon();
  const Fixed x = Fixed(1000);
  // The cross product of (x, x) and (x + unit, x) is -x unit: far below what a rounded product holds.
  const auto area = TypeParam::fromProduct(x, x) - TypeParam::fromProduct(x, x + unit);
  EXPECT_EQ(sign(area), -1);
  EXPECT_EQ(sign(-area), 1);
  EXPECT_EQ(sign(area - area), 0);
  EXPECT_EQ(sign(TypeParam::fromProduct(unit, unit)), 1);
  EXPECT_EQ(sign(TypeParam::fromProduct(unit, -unit)), -1);
}

TYPED_TEST(WideTest, ToScalarRoundsToNearestTiesToEven) {
  const auto half = TypeParam::fromProduct(Fixed::epsilon(), Fixed(0.5));
  EXPECT_EQ(toScalar(half), Fixed());
  EXPECT_EQ(toScalar(half + half + half).raw(), 2);
  EXPECT_EQ(toScalar(-half - half - half).raw(), -2);
  EXPECT_EQ(toScalar(half + TypeParam::fromProduct(Fixed::epsilon(), Fixed::epsilon())).raw(), 1);
}

TYPED_TEST(WideTest, ShiftsScaleByPowersOfTwo) {
  const auto x = TypeParam::fromProduct(Fixed(-3), Fixed(5));
  EXPECT_EQ(toScalar(x << 1), Fixed(-30));
  EXPECT_EQ(toScalar(x >> 1), Fixed(-7.5));
  EXPECT_EQ(x >> 127, -TypeParam::fromProduct(Fixed::epsilon(), Fixed::epsilon()));
}

TEST(WideTest, BothKindsOfWordsGiveTheSameBits) {
  Random random;
  for (int i = 0; i < 100'000; ++i) {
    const Fixed a = Fixed::fromRaw(random.anySize() >> 1), b = Fixed::fromRaw(random.anySize() >> 1);
    const Fixed c = Fixed::fromRaw(random.anySize() >> 1), d = Fixed::fromRaw(random.anySize() >> 1);
    const Native n1 = Native::fromProduct(a, b), n2 = Native::fromProduct(c, d);
    const Portable p1 = Portable::fromProduct(a, b), p2 = Portable::fromProduct(c, d);
    ASSERT_EQ((n1 + n2).high(), (p1 + p2).high());
    ASSERT_EQ((n1 + n2).low(), (p1 + p2).low());
    ASSERT_EQ(n1 <=> n2, p1 <=> p2);
    ASSERT_EQ(sign(n1 - n2), sign(p1 - p2));
    ASSERT_EQ(toScalar(n1 - n2), toScalar(p1 - p2));
    ASSERT_EQ((n1 >> 7).high(), (p1 >> 7).high());
    // The rounded sum is the fused one.
    ASSERT_EQ(toScalar(n1 + n2), dot(a, b, c, d));
    ASSERT_EQ(toScalar(exactCross(a, b, c, d)), cross(a, b, c, d));
  }
}

}  // namespace
}  // namespace samestep
