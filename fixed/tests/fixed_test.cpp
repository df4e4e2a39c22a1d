#include "samestep/fixed.h"

#include <gtest/gtest.h>

#include "samestep/fixed_io.h"
#include "samestep/fixed_math.h"
#include "samestep/fixed_text.h"
#include "samestep/scaled.h"
#include "samestep/wide.h"

namespace samestep {
namespace {

using namespace literals;

static_assert(sizeof(Fixed) == 8 && std::is_trivially_copyable_v<Fixed>);
static_assert(Fixed(3) * Fixed(-0.5) == Fixed(-1.5));
static_assert(sqrt(Fixed(2)) == 1.4142135623730950488_fixed);
static_assert(sincos(Fixed(1)).sin == 0.8414709848_fixed);
static_assert(atan2(Fixed(1), Fixed(1)) == 0.7853981633974483_fixed);

TEST(FixedTest, RoundsProductsToNearestTiesToEven) {
  const Fixed unit = Fixed::epsilon();
  EXPECT_EQ((unit * Fixed(0.5)).raw(), 0);
  EXPECT_EQ((Fixed::fromRaw(3) * Fixed(0.5)).raw(), 2);
  EXPECT_EQ((Fixed::fromRaw(-3) * Fixed(0.5)).raw(), -2);
  EXPECT_EQ((Fixed::fromRaw(-1) * Fixed(0.5)).raw(), 0);
  EXPECT_EQ((Fixed::fromRaw(5) * Fixed(0.5)).raw(), 2);
}

TEST(FixedTest, FusedSumsRoundOnce) {
  const Fixed half = Fixed(0.5), unit = Fixed::epsilon();
  EXPECT_EQ(dot(unit, half, unit, half), unit);
  EXPECT_EQ(cross(unit, half, unit, half), Fixed());
  EXPECT_EQ(dot4(unit, half, unit, half, unit, half, unit, half).raw(), 2);
  EXPECT_EQ(mulAdd(unit, half, unit).raw(), 2);
}

TEST(FixedTest, DivisionSaturates) {
  EXPECT_EQ(Fixed(1) / Fixed(), Fixed::max());
  EXPECT_EQ(Fixed(-1) / Fixed(), Fixed::lowest());
  EXPECT_EQ(Fixed() / Fixed(), Fixed());
  EXPECT_EQ(Fixed(1) / Fixed(3), Fixed::ratio(1, 3));
  EXPECT_EQ(Fixed::max() / Fixed::epsilon(), Fixed::max());
  EXPECT_EQ(Fixed::lowest() / Fixed(-1), Fixed::max());
  EXPECT_EQ(Fixed::lowest() / Fixed(1), Fixed::lowest());
  EXPECT_EQ(reciprocal(Fixed::epsilon()), Fixed::max());
  EXPECT_EQ(reciprocal(Fixed(4)), Fixed(0.25));
}

TEST(FixedTest, RemainderIsExactWithTheSignOfTheDividend) {
  EXPECT_EQ(remainder(Fixed(7.5), Fixed(2)), Fixed(1.5));
  EXPECT_EQ(remainder(Fixed(-7.5), Fixed(2)), Fixed(-1.5));
  EXPECT_EQ(remainder(Fixed(7.5), Fixed(-2)), Fixed(1.5));
  EXPECT_EQ(remainder(Fixed(1), Fixed(2)), Fixed(1));
  EXPECT_EQ(remainder(Fixed::max(), Fixed::fromRaw(10)).raw(), 7);
  EXPECT_EQ(remainder(Fixed::lowest(), Fixed::fromRaw(-1)), Fixed());
  EXPECT_EQ(remainder(Fixed(3), Fixed()), Fixed());
  EXPECT_THROW(remainder(CheckedFixed(3), CheckedFixed()), FixedOverflow);
}

TEST(FixedTest, RootsAndUnitVectors) {
  EXPECT_EQ(sqrt(Fixed(9)), Fixed(3));
  EXPECT_EQ(sqrt(Fixed(-9)), Fixed());
  EXPECT_EQ(length(Fixed(3), Fixed(-4)), Fixed(5));
  EXPECT_EQ(length(Fixed::lowest(), Fixed::lowest()), Fixed::max());
  EXPECT_EQ(normalize(Fixed(3), Fixed(-4)), (Components<Fixed>{0.6_fixed, -0.8_fixed}));
  EXPECT_EQ(normalize(Fixed::epsilon(), Fixed()), (Components<Fixed>{Fixed(1), Fixed()}));
  EXPECT_EQ(normalize(Fixed(), Fixed()), (Components<Fixed>{}));
}

TEST(FixedTest, WideDecidesExactly) {
  const Fixed unit = Fixed::epsilon();
  EXPECT_EQ(sign(exactCross(unit, unit, Fixed(), Fixed())), 1);
  EXPECT_EQ(sign(exactCross(unit, unit, unit, unit)), 0);
  EXPECT_LT(-exactProduct(unit, unit), exactProduct(unit, Fixed()));
  EXPECT_EQ(toScalar(exactDot(Fixed(2), Fixed(3), Fixed(-4), Fixed(5))), Fixed(-14));
}

TEST(FixedTest, ScaledKeepsTinyInverses) {
  const Scaled<Fixed> mass = toScaled(Fixed(1000000000));
  const Scaled<Fixed> inverse = reciprocal(mass);
  EXPECT_EQ(toScalar<Fixed>(inverse * mass), Fixed(1));
  EXPECT_EQ(toScalar<Fixed>(inverse * toScaled(Fixed(500000000))), Fixed(0.5));
  EXPECT_EQ(toScalar<Fixed>(toScaled(Fixed(-3)) + toScaled(Fixed(0.25))), Fixed(-2.75));
  EXPECT_EQ(toScalar<Fixed>(mass * mass), Fixed::max());
}

TEST(FixedTest, TextReadsBack) {
  EXPECT_EQ(formatDecimal(Fixed(0.1)), "0.1");
  EXPECT_EQ(formatDecimal(Fixed::lowest()), "-2147483648");
  EXPECT_EQ(formatDecimal(Fixed::epsilon()), "0.0000000002");
  Fixed out;
  EXPECT_EQ(parseDecimal("-1.25e2", out), DecimalStatus::ok);
  EXPECT_EQ(out, Fixed(-125));
  EXPECT_EQ(parseDecimal("2147483648", out), DecimalStatus::outOfRange);
  EXPECT_EQ(parseDecimal("1.2.3", out), DecimalStatus::notANumber);
}

TEST(FixedTest, CheckedReports) {
  EXPECT_THROW(CheckedFixed(2000000000) * CheckedFixed(2), FixedOverflow);
  try {
    static_cast<void>(CheckedFixed(2000000000) + CheckedFixed(2000000000));
    FAIL();
  } catch (const FixedOverflow& overflow) {
    EXPECT_STREQ(overflow.what(), "add(2000000000, 2000000000)");
  }
  EXPECT_THROW(sqrt(CheckedFixed(-1)), FixedOverflow);
  EXPECT_THROW(CheckedFixed(1) / CheckedFixed(), FixedOverflow);
}

TEST(FixedTest, Functions) {
  EXPECT_EQ(exp2(Fixed(3)), Fixed(8));
  EXPECT_EQ(log2(Fixed(8)), Fixed(3));
  EXPECT_EQ(log2(Fixed()), Fixed::lowest());
  EXPECT_EQ(pow(Fixed(2), Fixed(10)), Fixed(1024));
  EXPECT_EQ(exp(Fixed()), Fixed(1));
}

}  // namespace
}  // namespace samestep
