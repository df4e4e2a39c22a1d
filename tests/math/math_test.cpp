// SPDX-License-Identifier: MIT
#include "samestep/math.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace samestep {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kLeast = std::numeric_limits<double>::denorm_min();

std::uint64_t bitsOf(double x) { return std::bit_cast<std::uint64_t>(x); }

/// Vigna's splitmix64: the same inputs on every platform.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }

  double anyFinite() {
    while (true) {
      const auto x = std::bit_cast<double>(bits());
      if (isFinite(x)) return x;
    }
  }

 private:
  std::uint64_t state_;
};

/// FNV-1a over the bits of results.
class Fingerprint {
 public:
  void add(double result) {
    for (int shift = 0; shift < 64; shift += 8) {
      hash_ = (hash_ ^ ((bitsOf(result) >> shift) & 0xff)) * 0x100000001b3;
    }
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

constexpr int kGoldenCount = 100'000;

template <class Function>
std::uint64_t fingerprint(Function addResults) {
  Random random(20261122);
  Fingerprint print;
  for (int i = 0; i < kGoldenCount; ++i) addResults(random, i, print);
  return print.value();
}

// The bits every platform must give. A change here is a change of simulationRevision.

TEST(MathGolden, Sincos) {
  EXPECT_EQ(fingerprint([](Random& random, int i, Fingerprint& print) {
              const double angle = i % 4 == 0 ? random.anyFinite() : random.within(-100.0, 100.0);
              const SinCos<double> result = sincos(angle);
              print.add(result.sin);
              print.add(result.cos);
            }),
            0xee506709cc367f16u);
}

TEST(MathGolden, Atan2) {
  EXPECT_EQ(fingerprint([](Random& random, int i, Fingerprint& print) {
              const bool wide = i % 4 == 0;
              const double y = wide ? random.anyFinite() : random.within(-1.0, 1.0);
              const double x = wide ? random.anyFinite() : random.within(-1.0, 1.0);
              print.add(atan2(y, x));
            }),
            0xcc581470a7c7bac2u);
}

TEST(MathGolden, Exp) {
  EXPECT_EQ(fingerprint([](Random& random, int i, Fingerprint& print) {
              print.add(exp(i % 2 == 0 ? random.within(-746.0, 710.0) : random.within(-1.0, 1.0)));
            }),
            0xd78cbdc27843c3fcu);
}

TEST(MathGolden, Exp2) {
  EXPECT_EQ(fingerprint([](Random& random, int i, Fingerprint& print) {
              print.add(exp2(i % 2 == 0 ? random.within(-1076.0, 1024.0) : random.within(-1.0, 1.0)));
            }),
            0xc5920f2d2de727b3u);
}

TEST(MathGolden, Log2) {
  EXPECT_EQ(fingerprint([](Random& random, int i, Fingerprint& print) {
              print.add(log2(i % 2 == 0 ? abs(random.anyFinite()) : random.within(0.5, 2.0)));
            }),
            0x85c59d1f52cff09cu);
}

TEST(MathGolden, Pow) {
  EXPECT_EQ(fingerprint([](Random& random, int i, Fingerprint& print) {
              const double base = i % 2 == 0 ? random.within(0.0, 2.0) : random.within(0.0, 1e6);
              print.add(pow(base, random.within(-40.0, 40.0)));
            }),
            0x7bb55bdf2b4cf483u);
}

TEST(MathGolden, LengthAndNormalize) {
  EXPECT_EQ(fingerprint([](Random& random, int i, Fingerprint& print) {
              const double factor = i % 4 == 0 ? 0x1p-700 : 1.0;
              const double x = random.within(-100.0, 100.0) * factor;
              const double y = random.within(-100.0, 100.0) * factor;
              print.add(length(x, y));
              print.add(normalize(x, y).x);
              print.add(normalize(x, y).y);
            }),
            0x797833e98a9b58a2u);
}

TEST(MathTest, ProductsAreAddedFromLeftToRight) {
  EXPECT_EQ(mulAdd(3.0, 4.0, 5.0), 17.0);
  EXPECT_EQ(dot(3.0, 4.0, 5.0, 6.0), 42.0);
  EXPECT_EQ(cross(3.0, 4.0, 5.0, 6.0), -18.0);
  EXPECT_EQ(dot3(1.0, 0x1p60, 1.0, 1.0, -1.0, 0x1p60), 0.0);
  EXPECT_EQ(dot4(1.0, 0x1p60, -1.0, 0x1p60, 1.0, 1.0, 2.0, 3.0), 7.0);
  EXPECT_EQ(mulDiv(6.0, 4.0, 3.0), 8.0);
  EXPECT_EQ(reciprocal(4.0), 0.25);
}

TEST(MathTest, ProductsRoundTwice) {
  const double x = 1.0 + 0x1p-30;
  EXPECT_EQ(mulAdd(x, x, -(1.0 + 0x1p-29)), 0.0);
  EXPECT_EQ(cross(x, x, 1.0 + 0x1p-29, 1.0), 0.0);
}

TEST(MathTest, SquareRootIsExactAndZeroBelowZero) {
  EXPECT_EQ(sqrt(2.25), 1.5);
  EXPECT_EQ(sqrt(0.0), 0.0);
  EXPECT_EQ(sqrt(-1.0), 0.0);
}

TEST(MathTest, SelectionsKeepTheFirstOfEqualNumbers) {
  EXPECT_EQ(bitsOf(min(0.0, -0.0)), bitsOf(0.0));
  EXPECT_EQ(bitsOf(min(-0.0, 0.0)), bitsOf(-0.0));
  EXPECT_EQ(bitsOf(max(0.0, -0.0)), bitsOf(0.0));
  EXPECT_EQ(bitsOf(max(-0.0, 0.0)), bitsOf(-0.0));
  EXPECT_EQ(bitsOf(abs(-0.0)), bitsOf(-0.0));
  EXPECT_EQ(bitsOf(clamp(-0.0, 0.0, 1.0)), bitsOf(-0.0));
}

TEST(MathTest, SelectionsOrder) {
  EXPECT_EQ(min(1.0, 2.0), 1.0);
  EXPECT_EQ(max(1.0, 2.0), 2.0);
  EXPECT_EQ(abs(-3.0), 3.0);
  EXPECT_EQ(clamp(-3.0, -1.0, 1.0), -1.0);
  EXPECT_EQ(clamp(3.0, -1.0, 1.0), 1.0);
  EXPECT_EQ(clamp(0.5, -1.0, 1.0), 0.5);
}

TEST(MathTest, FiniteExcludesInfinitiesAndNan) {
  EXPECT_TRUE(isFinite(0.0));
  EXPECT_TRUE(isFinite(kLargest));
  EXPECT_TRUE(isFinite(-kLargest));
  EXPECT_FALSE(isFinite(kInfinity));
  EXPECT_FALSE(isFinite(-kInfinity));
  EXPECT_FALSE(isFinite(kNan));
}

TEST(MathTest, ADoubleIsItsOwnWideAndScaled) {
  static_assert(std::is_same_v<Wide<double>, double>);
  static_assert(std::is_same_v<Scaled<double>, double>);
  EXPECT_EQ(toScalar(exactDot(1.0, 2.0, 3.0, 4.0)), 14.0);
  EXPECT_EQ(toScalar(exactCross(1.0, 2.0, 3.0, 4.0)), -10.0);
  EXPECT_EQ(exactProduct(3.0, 4.0), 12.0);
  EXPECT_EQ(toScalar<double>(toScaled(1.5)), 1.5);
  EXPECT_EQ(sign(-2.0), -1);
  EXPECT_EQ(sign(-0.0), 0);
  EXPECT_EQ(sign(kLeast), 1);
}

TEST(MathTest, LengthSurvivesExtremeScales) {
  for (const double scale : {1.0, 0x1p-1000, 0x1p-1072, 0x1p1000, 0x1p-480, 0x1p500, 0x1p-520}) {
    EXPECT_EQ(length(3.0 * scale, -4.0 * scale), 5.0 * scale) << scale;
  }
  EXPECT_EQ(length(0.0, 0.0), 0.0);
  EXPECT_EQ(length(kLeast, 0.0), kLeast);
  EXPECT_EQ(length(0.0, -kLargest), kLargest);
}

TEST(MathTest, NormalizeGivesUnitVectorsAtEveryScale) {
  for (const double scale : {1.0, 0x1p-1000, 0x1p-1072, 0x1p1000, 0x1p-480, 0x1p500, 0x1p-520}) {
    EXPECT_EQ(normalize(3.0 * scale, -4.0 * scale), (Components<double>{0.6, -0.8})) << scale;
  }
  EXPECT_EQ(normalize(-kLeast, 0.0), (Components<double>{-1.0, 0.0}));
  EXPECT_EQ(normalize(0.0, kLargest), (Components<double>{0.0, 1.0}));
}

TEST(MathTest, RemainderIsExactWithTheSignOfTheDividend) {
  EXPECT_EQ(remainder(7.5, 2.0), 1.5);
  EXPECT_EQ(remainder(-7.5, 2.0), -1.5);
  EXPECT_EQ(remainder(7.5, -2.0), 1.5);
  EXPECT_EQ(remainder(1.0, 2.0), 1.0);
  EXPECT_EQ(remainder(8.0, 2.0), 0.0);
  EXPECT_TRUE(std::signbit(remainder(-8.0, 2.0)));
  EXPECT_EQ(remainder(kLargest, 3.0), 2.0);
  EXPECT_EQ(remainder(kLargest, kLeast), 0.0);
  EXPECT_EQ(remainder(3.0, kInfinity), 3.0);
  Random random(7);
  for (int i = 0; i < 20'000; ++i) {
    const double x = random.anyFinite();
    const double y = random.anyFinite();
    if (y == 0.0) continue;
    ASSERT_EQ(remainder(x, y), std::fmod(x, y)) << x << ' ' << y;
  }
}

TEST(MathTest, NormalizeMapsZeroToZero) { EXPECT_EQ(normalize(0.0, -0.0), (Components<double>{0.0, 0.0})); }

TEST(MathTest, SincosIsOddAndEven) {
  Random random(1);
  for (int i = 0; i < 100'000; ++i) {
    const double angle = i % 2 == 0 ? random.anyFinite() : random.within(-1e6, 1e6);
    const SinCos<double> there = sincos(angle);
    const SinCos<double> back = sincos(-angle);
    ASSERT_EQ(bitsOf(back.sin), bitsOf(-there.sin)) << angle;
    ASSERT_EQ(bitsOf(back.cos), bitsOf(there.cos)) << angle;
  }
}

TEST(MathTest, SincosOfSmallAnglesIsTheAngle) {
  for (const double angle : {0.0, -0.0, kLeast, -kLeast, 0x1p-1022, 0x1p-30}) {
    EXPECT_EQ(bitsOf(sincos(angle).sin), bitsOf(angle));
    EXPECT_EQ(sincos(angle).cos, 1.0);
  }
}

TEST(MathTest, Atan2OfAxesAndDiagonals) {
  constexpr double kPi = 0x1.921fb54442d18p+1;
  EXPECT_EQ(bitsOf(atan2(0.0, 1.0)), bitsOf(0.0));
  EXPECT_EQ(bitsOf(atan2(-0.0, 1.0)), bitsOf(-0.0));
  EXPECT_EQ(bitsOf(atan2(0.0, 0.0)), bitsOf(0.0));
  EXPECT_EQ(atan2(0.0, -1.0), kPi);
  EXPECT_EQ(atan2(-0.0, -1.0), -kPi);
  EXPECT_EQ(atan2(0.0, -0.0), kPi);
  EXPECT_EQ(atan2(1.0, 0.0), kPi / 2);
  EXPECT_EQ(atan2(-1.0, -0.0), -kPi / 2);
  EXPECT_EQ(atan2(2.0, 2.0), kPi / 4);
  EXPECT_EQ(atan2(kLeast, kLeast), kPi / 4);
  EXPECT_EQ(atan2(-kLargest, kLargest), -kPi / 4);
  EXPECT_EQ(atan2(kInfinity, 1.0), kPi / 2);
  EXPECT_EQ(atan2(1.0, kInfinity), 0.0);
  EXPECT_EQ(atan2(1.0, -kInfinity), kPi);
  EXPECT_EQ(atan2(kInfinity, kInfinity), kPi / 4);
  EXPECT_EQ(atan2(-kInfinity, -kInfinity), -0x1.2d97c7f3321d2p+1);
}

TEST(MathTest, PowersOfTwoAreExact) {
  for (int n = -1074; n <= 1023; ++n) {
    const double power = n < -1022 ? std::bit_cast<double>(std::uint64_t{1} << (n + 1074))
                                   : std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52);
    ASSERT_EQ(exp2(n), power) << n;
    ASSERT_EQ(log2(power), n);
    ASSERT_EQ(pow(2.0, n), power) << n;
  }
}

TEST(MathTest, ExponentialsSaturateAsIeeeSays) {
  EXPECT_EQ(exp(0.0), 1.0);
  EXPECT_EQ(exp(-0.0), 1.0);
  EXPECT_EQ(exp(kLeast), 1.0);
  EXPECT_EQ(exp(709.79), kInfinity);
  EXPECT_EQ(exp(kInfinity), kInfinity);
  EXPECT_EQ(exp(-745.14), 0.0);
  EXPECT_EQ(exp(-kInfinity), 0.0);
  EXPECT_EQ(exp2(1024.0), kInfinity);
  EXPECT_EQ(exp2(kLargest), kInfinity);
  EXPECT_EQ(exp2(-1075.0), 0.0);
  EXPECT_EQ(exp2(-kLargest), 0.0);
}

TEST(MathTest, LogarithmOfTheEdges) {
  EXPECT_EQ(log2(1.0), 0.0);
  EXPECT_EQ(log2(0.0), -kInfinity);
  EXPECT_EQ(log2(kInfinity), kInfinity);
  EXPECT_EQ(log2(kLargest), 1024.0);
}

TEST(MathTest, PowOfTheEdges) {
  EXPECT_EQ(pow(0.0, 0.0), 1.0);
  EXPECT_EQ(pow(kLargest, 0.0), 1.0);
  EXPECT_EQ(pow(1.0, kLargest), 1.0);
  EXPECT_EQ(pow(0.0, 2.0), 0.0);
  EXPECT_EQ(pow(0.0, -2.0), kInfinity);
  EXPECT_EQ(pow(kInfinity, 0.5), kInfinity);
  EXPECT_EQ(pow(kInfinity, -0.5), 0.0);
  EXPECT_EQ(pow(0.5, kLargest), 0.0);
  EXPECT_EQ(pow(0.5, -kLargest), kInfinity);
  EXPECT_EQ(pow(2.0, kInfinity), kInfinity);
  EXPECT_EQ(pow(2.0, -kInfinity), 0.0);
  EXPECT_EQ(pow(kLargest, 1.0), kLargest);
  EXPECT_EQ(pow(kLeast, 1.0), kLeast);
  EXPECT_EQ(pow(kLargest, kLeast), 1.0);
  EXPECT_EQ(pow(3.0, 4.0), 81.0);
  EXPECT_EQ(pow(0.25, 0.5), 0.5);
}

TEST(MathTest, InvalidOperationsGiveOneNan) {
  const std::uint64_t one = 0x7ff8000000000000;
  EXPECT_EQ(bitsOf(sincos(kInfinity).sin), one);
  EXPECT_EQ(bitsOf(sincos(-kInfinity).cos), one);
  EXPECT_EQ(bitsOf(sincos(-kNan).sin), one);
  EXPECT_EQ(bitsOf(atan2(-kNan, 1.0)), one);
  EXPECT_EQ(bitsOf(atan2(1.0, -kNan)), one);
  EXPECT_EQ(bitsOf(exp(-kNan)), one);
  EXPECT_EQ(bitsOf(exp2(-kNan)), one);
  EXPECT_EQ(bitsOf(log2(-1.0)), one);
  EXPECT_EQ(bitsOf(log2(-kNan)), one);
  EXPECT_EQ(bitsOf(pow(-1.0, 2.0)), one);
  EXPECT_EQ(bitsOf(pow(2.0, -kNan)), one);
  EXPECT_EQ(bitsOf(pow(-kNan, 2.0)), one);
  EXPECT_EQ(bitsOf(remainder(kInfinity, 2.0)), one);
  EXPECT_EQ(bitsOf(remainder(2.0, 0.0)), one);
  EXPECT_EQ(bitsOf(remainder(2.0, -kNan)), one);
}

}  // namespace
}  // namespace samestep
