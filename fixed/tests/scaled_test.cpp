#include "samestep/scaled.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "test_random.h"

namespace samestep {
namespace {

using Number = Scaled<Fixed>;

static_assert(sizeof(Number) == 16 && std::is_trivially_copyable_v<Number>);

/// The value to the 64 bits of a long double's mantissa.
long double valueOf(Number x) {
  return std::ldexp(static_cast<long double>(x.mantissa()), static_cast<int>(x.exponent()));
}

void expectCanonical(Number x) { ASSERT_TRUE(Number::isValid(x.mantissa(), x.exponent())); }

TEST(ScaledTest, ConversionFromAndToTheNumberIsExact) {
  Random random;
  for (int i = 0; i < 100'000; ++i) {
    const Fixed x = Fixed::fromRaw(random.anySize());
    expectCanonical(toScaled(x));
    ASSERT_EQ(toScalar<Fixed>(toScaled(x)), x);
  }
  for (const Fixed x : {Fixed(), Fixed::max(), Fixed::lowest(), Fixed::epsilon(), -Fixed::epsilon()}) {
    EXPECT_EQ(toScalar<Fixed>(toScaled(x)), x);
  }
}

// A long double has 64 bits, one more than a Scaled: its result is within one unit of the 64th bit of the
// exact one, so that a correctly rounded 63-bit result is within 2^-63 + 2^-64 of it.
TEST(ScaledTest, OperationsAreRoundedTo63Bits) {
  const long double bound = std::ldexp(1.5L, -63);
  Random random;
  const auto near = [&](Number found, long double expected) {
    expectCanonical(found);
    ASSERT_LE(std::fabs(valueOf(found) - expected), std::fabs(expected) * bound);
  };
  for (int i = 0; i < 200'000; ++i) {
    const Number a =
        toScaled(Fixed::fromRaw(random.anySize() | 1)) / toScaled(Fixed::fromRaw(random.anySize() | 1));
    const Number b =
        toScaled(Fixed::fromRaw(random.anySize() | 1)) * toScaled(Fixed::fromRaw(random.anySize() | 1));
    near(a * b, valueOf(a) * valueOf(b));
    near(a / b, valueOf(a) / valueOf(b));
    near(reciprocal(a), 1.0L / valueOf(a));
    if ((a < Number()) == (b < Number())) near(a + b, valueOf(a) + valueOf(b));
    ASSERT_EQ(a < b, valueOf(a) < valueOf(b));
    ASSERT_EQ(a - a, Number());
    ASSERT_EQ(a + b, b + a);
    ASSERT_EQ(-(a - b), b - a);
  }
}

TEST(ScaledTest, CancellationIsExact) {
  const Number large = toScaled(Fixed(1 << 30)) * toScaled(Fixed(1 << 30));
  const Number unit = toScaled(Fixed::epsilon());
  EXPECT_EQ((large + toScaled(Fixed(1))) - large, toScaled(Fixed(1)));
  EXPECT_EQ((large + unit) - large, Number());  // 92 bits apart
  EXPECT_EQ(unit - (unit - unit * unit), unit * unit);
}

TEST(ScaledTest, MassesAndMomentsOfTheWholeRangeKeepTheirInverses) {
  for (const Fixed x : {Fixed::ratio(1, 1000), Fixed(1000000), Fixed(1 << 30), Fixed::ratio(1, 1 << 20)}) {
    const Number inverse = reciprocal(toScaled(x));
    EXPECT_EQ(toScalar<Fixed>(inverse * toScaled(x)), Fixed(1));
    // A chain as of a lever arm squared over a moment.
    const Number lever = toScaled(Fixed(256)) * toScaled(Fixed(256));
    EXPECT_EQ(toScalar<Fixed>(lever * inverse / lever * toScaled(x)), Fixed(1));
  }
}

TEST(ScaledTest, ResultsOutsideTheNumberSaturate) {
  const Number large = toScaled(Fixed::max());
  EXPECT_EQ(toScalar<Fixed>(large * large), Fixed::max());
  EXPECT_EQ(toScalar<Fixed>(-large * large), Fixed::lowest());
  EXPECT_EQ(toScalar<Fixed>(toScaled(Fixed(3)) / Number()), Fixed::max());
  EXPECT_EQ(toScalar<Fixed>(toScaled(Fixed(-3)) / Number()), Fixed::lowest());
  EXPECT_EQ(Number() / Number(), Number());
  Number huge = large;
  for (int i = 0; i < 64; ++i) huge *= huge;
  EXPECT_EQ(huge, Number::max());
  Number tiny = toScaled(Fixed::epsilon());
  for (int i = 0; i < 64; ++i) tiny *= tiny;
  EXPECT_EQ(tiny, Number());
}

TEST(ScaledTest, RoundingToTheNumberIsToNearestTiesToEven) {
  const Number half = toScaled(Fixed::epsilon()) * toScaled(Fixed(0.5));
  EXPECT_EQ(toScalar<Fixed>(half), Fixed());
  EXPECT_EQ(toScalar<Fixed>(half + half * toScaled(Fixed::epsilon())), Fixed::epsilon());
  EXPECT_EQ(toScalar<Fixed>(half * toScaled(Fixed(3))).raw(), 2);
  EXPECT_EQ(toScalar<Fixed>(half * toScaled(Fixed(-3))).raw(), -2);
}

TEST(ScaledTest, PartsThatNoScaledHasGiveZero) {
  EXPECT_EQ(Number::fromParts(1, 0), Number());
  EXPECT_EQ(Number::fromParts(0, 5), Number());
  EXPECT_EQ(Number::fromParts(std::int64_t{1} << 62, Number::kMaxExponent + 1), Number());
  const Number x = toScaled(Fixed(7));
  EXPECT_EQ(Number::fromParts(x.mantissa(), x.exponent()), x);
}

}  // namespace
}  // namespace samestep
