// SPDX-License-Identifier: MIT
#include <cstdint>

#include "base/require_ieee.h"
#include "math/math_double_tables.h"
#include "samestep/math.h"

namespace samestep {
namespace {

using detail::Pair;

constexpr double kInfinity = __builtin_huge_val();
constexpr std::uint64_t kSignBit = std::uint64_t{1} << 63;
constexpr std::uint64_t kMantissaMask = (std::uint64_t{1} << 52) - 1;

std::uint64_t bitsOf(double x) { return __builtin_bit_cast(std::uint64_t, x); }
double fromBits(std::uint64_t bits) { return __builtin_bit_cast(double, bits); }

/// The result of every invalid operation: hardware disagrees on the sign of its own NaN.
double notANumber() { return fromBits(0x7ff8000000000000u); }

/// The biased exponent; the sign must be clear.
int biasedExponent(double x) { return static_cast<int>(bitsOf(x) >> 52); }

/// 2^exponent for a normal result.
double powerOfTwo(int exponent) { return fromBits(static_cast<std::uint64_t>(exponent + 1023) << 52); }

double withSignOf(double magnitude, double sign) {
  return fromBits((bitsOf(magnitude) & ~kSignBit) | (bitsOf(sign) & kSignBit));
}

/// The nearest integer, for |x| < 2^51.
double roundToInteger(double x) {
  constexpr double kShift = 0x1.8p52;
  return (x + kShift) - kShift;
}

// Pair arithmetic: Dekker 1971, Knuth TAOCP 4.2.2. A product is split by hand, as no fused operation may be
// used.

/// a + b exactly, for |a| >= |b| or a = 0.
Pair quickSum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a + b exactly.
Pair exactSum(double a, double b) {
  const double sum = a + b;
  const double shareOfB = sum - a;
  return {sum, (a - (sum - shareOfB)) + (b - shareOfB)};
}

/// x as a sum of two numbers of at most 26 bits, for |x| < 2^995.
Pair split(double x) {
  constexpr double kSplitter = 0x1p27 + 1;
  const double scaled = x * kSplitter;
  const double high = scaled - (scaled - x);
  return {high, x - high};
}

/// a * b exactly, where nothing over- or underflows.
Pair exactMultiply(double a, double b) {
  const Pair as = split(a);
  const Pair bs = split(b);
  const double product = a * b;
  return {product, ((as.high * bs.high - product) + as.high * bs.low + as.low * bs.high) + as.low * bs.low};
}

Pair multiply(Pair a, Pair b) {
  const Pair product = exactMultiply(a.high, b.high);
  return quickSum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

/// a + b, for |a.high| >= |b.high|.
Pair addSmaller(Pair a, Pair b) {
  const Pair sum = quickSum(a.high, b.high);
  return quickSum(sum.high, sum.low + (a.low + b.low));
}

// ---- sine and cosine ----

/// An angle within [-pi/4, pi/4] and the quarter turns to add to it.
struct ReducedAngle {
  Pair rest;
  unsigned quarters;
};

/// Reduces any finite angle >= 0.5: the product with 2/pi in integers, only those words of it that matter.
ReducedAngle reduceExactly(double magnitude) {
  constexpr int kWords = 8;
  const int exponent = biasedExponent(magnitude) - 1075;
  const std::uint64_t mantissa = (bitsOf(magnitude) & kMantissaMask) | (kMantissaMask + 1);
  // magnitude * 2/pi = mantissa * 2^exponent * sum of word[i] * 2^(-32 (i + 1)). Words whose product is a
  // multiple of four quarters are left out; those kept leave 222 bits after the point, 169 of them right.
  const int first = exponent >= 34 ? (exponent - 2) / 32 : 0;

  std::uint32_t product[kWords + 2] =
      {};  // least significant first, in units of 2^(exponent - 32 (first + kWords))
  const std::uint32_t factors[2] = {static_cast<std::uint32_t>(mantissa),
                                    static_cast<std::uint32_t>(mantissa >> 32)};
  for (int f = 0; f < 2; ++f) {
    std::uint64_t carry = 0;
    for (int i = 0; i < kWords; ++i) {
      carry += std::uint64_t{factors[f]} * detail::kTwoOverPiWords[first + kWords - 1 - i] + product[f + i];
      product[f + i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    product[f + kWords] = static_cast<std::uint32_t>(carry);
  }

  // Bit number `point` has the weight of one quarter.
  const int point = 32 * (first + kWords) - exponent;
  const auto bit = [&](int index) -> unsigned {
    return index < 32 * (kWords + 2) ? (product[index / 32] >> (index % 32)) & 1u : 0u;
  };
  unsigned quarters = bit(point) | (bit(point + 1) << 1);
  const bool roundUp = bit(point - 1) != 0;
  quarters += roundUp;

  // The fraction, or what it lacks to one (but for one unit of the last bit), in two doubles of 53 bits.
  const auto fractionBit = [&](int index) { return (bit(index) != 0) != roundUp; };
  int top = point - 1;
  while (top > 0 && !fractionBit(top)) --top;
  const auto take = [&](int from) {
    std::uint64_t chunk = 0;
    for (int i = from; i > from - 53; --i)
      chunk = chunk << 1 | static_cast<std::uint64_t>(i >= 0 && fractionBit(i));
    return static_cast<double>(chunk) * powerOfTwo(from - 52 - point);
  };
  const double high = take(top);
  const double low = take(top - 53);
  const Pair rest = multiply(quickSum(high, low), detail::kHalfPi);
  return {roundUp ? Pair{-rest.high, -rest.low} : rest, quarters};
}

/// Cody and Waite in three parts, for |angle| <= 2^20: n has at most 20 bits, so the first two products are
/// exact.
ReducedAngle reduce(double angle) {
  constexpr double kShift = 0x1.8p52;
  const double shifted = angle * detail::kTwoOverPi + kShift;
  const double n = shifted - kShift;
  const double afterFirst = angle - n * detail::kHalfPi1;
  const Pair afterSecond = exactSum(afterFirst, -(n * detail::kHalfPi2));
  const Pair rest = quickSum(afterSecond.high, afterSecond.low - n * detail::kHalfPi3);
  return {rest, static_cast<unsigned>(bitsOf(shifted) & 3)};
}

SinCos<double> sincosNearZero(Pair angle) {
  const double r = angle.high;
  const double z = r * r;
  const double z2 = z * z;
  const auto& s = detail::kSin;
  const auto& c = detail::kCos;
  const double sinPoly = (s[0] + z * s[1]) + z2 * ((s[2] + z * s[3]) + z2 * (s[4] + z * s[5]));
  const double cosPoly = (c[0] + z * c[1]) + z2 * ((c[2] + z * c[3]) + z2 * (c[4] + z * c[5]));
  const double halfSquare = 0.5 * z;
  const double sine = r + ((angle.low - halfSquare * angle.low) + (r * z) * sinPoly);
  const double whole = 1.0 - halfSquare;
  const double cosine = whole + (((1.0 - whole) - halfSquare) + (z2 * cosPoly - r * angle.low));
  return {sine, cosine};
}

/// (sin, cos) turned by quarters of a turn, without a branch: the quarter is as good as random.
SinCos<double> turn(SinCos<double> v, unsigned quarters) {
  const std::uint64_t swap = 0 - std::uint64_t{quarters & 1};
  const std::uint64_t s = bitsOf(v.sin);
  const std::uint64_t c = bitsOf(v.cos);
  const std::uint64_t change = (s ^ c) & swap;
  const std::uint64_t sinSign = std::uint64_t{quarters & 2} << 62;
  const std::uint64_t cosSign = std::uint64_t{(quarters + 1) & 2} << 62;
  return {fromBits((s ^ change) ^ sinSign), fromBits((c ^ change) ^ cosSign)};
}

// ---- powers ----

/// value * 2^exponent for value in [0.5, 2], rounded once.
double scale(double value, int exponent) {
  if (exponent > 1024) return kInfinity;
  if (exponent == 1024) return value * 0x1p1023 * 2.0;
  if (exponent < -1080) return 0.0;
  if (exponent >= -1020) return fromBits(bitsOf(value) + (static_cast<std::uint64_t>(exponent) << 52));
  return value * powerOfTwo(exponent + 200) * 0x1p-200;
}

/// 2^(n / 64) * e^r for an integral |n| < 2^17 and |r| <= ln 2 / 127.
double exponential(double n, double r) {
  const int index = static_cast<int>(n);
  const Pair& root = detail::kExp2Table[index & 63];
  const double square = r * r;
  const double growth =
      r + square * ((0.5 + r * (1.0 / 6)) + square * ((1.0 / 24 + r * (1.0 / 120)) + square * (1.0 / 720)));
  return scale(root.high + (root.low + root.high * growth), index >> 6);
}

/// The binary logarithm of a finite x > 0, to 2^-74 relative.
Pair log2Pair(double x) {
  int exponent = -1023;
  if (biasedExponent(x) == 0) {
    x *= 0x1p54;
    exponent -= 54;
  }
  exponent += biasedExponent(x);
  const std::uint64_t mantissa = bitsOf(x) & kMantissaMask;
  const auto cellIndex = static_cast<int>(mantissa >> 45);
  const detail::Log2Cell& cell = detail::kLog2Table[cellIndex];
  exponent += cellIndex >= detail::kLog2Fold;

  // r = m * c - 1 exactly: c has 10 bits and each half of m at most 27.
  constexpr std::uint64_t kOne = std::uint64_t{1023} << 52;
  constexpr std::uint64_t kLowHalf = (std::uint64_t{1} << 27) - 1;
  const double m = fromBits(mantissa | kOne);
  const double mHigh = fromBits((mantissa & ~kLowHalf) | kOne);
  const Pair r = exactSum(mHigh * cell.c - 1.0, (m - mHigh) * cell.c);

  const auto& c = detail::kLog1p;
  const double h = r.high;
  const double h2 = h * h;
  const double tail =
      (h2 * h2) * ((c[0] + h * c[1]) + h2 * ((c[2] + h * c[3]) + h2 * ((c[4] + h * c[5]) + h2 * c[6])));
  const Pair square = multiply(r, r);
  const Pair slope = addSmaller({-0.5, 0.0}, multiply(r, detail::kThird));
  const Pair bend = multiply(square, slope);
  const Pair log1p = addSmaller(r, {bend.high, bend.low + tail});
  const Pair fraction = multiply(log1p, detail::kInverseLn2);

  const Pair sum = exactSum(static_cast<double>(exponent) + cell.high, fraction.high);
  return quickSum(sum.high, sum.low + (cell.low + fraction.low));
}

// ---- arc tangent ----

/// The arc tangent of a / b for 0 <= a <= b, b in [1, 2).
Pair atanOfRatio(double a, double b) {
  // atan(a/b) = atan(c) + atan(u), u = (a - c b) / (b + c a), with c the nearest 64th.
  const double index = roundToInteger(a / b * 64.0);
  const double c = index * 0x1p-6;
  const Pair bs = split(b);
  const Pair as = split(a);
  const Pair above = exactSum(a - c * bs.high, -(c * bs.low));
  const Pair below = exactSum(b + c * as.high, c * as.low);
  const double u = above.high / below.high;
  const Pair back = exactMultiply(u, below.high);
  const double uLow = (((above.high - back.high) - back.low) + (above.low - u * below.low)) / below.high;

  const auto& p = detail::kAtan;
  const double z = u * u;
  const double bend = (u * z) * ((p[0] + z * p[1]) + (z * z) * (p[2] + z * p[3]));
  const Pair& base = detail::kAtanTable[static_cast<int>(index)];
  const Pair sum = quickSum(base.high, u);
  return quickSum(sum.high, sum.low + (base.low + (uLow + bend)));
}

}  // namespace

double length(double x, double y) {
  const double largest = max(abs(x), abs(y));
  if (largest > 0x1p-480 && largest < 0x1p500) return sqrt(x * x + y * y);
  const double factor = largest < 1.0 ? 0x1p600 : 0x1p-600;
  const double sx = x * factor;
  const double sy = y * factor;
  return sqrt(sx * sx + sy * sy) * (largest < 1.0 ? 0x1p-600 : 0x1p600);
}

Components<double> normalize(double x, double y) {
  const double largest = max(abs(x), abs(y));
  if (!(largest > 0x1p-480 && largest < 0x1p500)) {
    if (largest == 0.0) return {0.0, 0.0};
    const double factor = largest < 1.0 ? 0x1p600 : 0x1p-600;
    x *= factor;
    y *= factor;
  }
  const double norm = sqrt(x * x + y * y);
  return {x / norm, y / norm};
}

SinCos<double> sincos(double angle) {
  const double magnitude = abs(angle);
  if (magnitude <= 0x1p20) {
    // Below 2^-27 the cubic term is under half an ulp; and a sum would lose the sign of -0.
    if (magnitude < 0x1p-27) return {angle, 1.0};
    const ReducedAngle reduced = reduce(angle);
    // Nearer than this to a multiple of pi/2, three parts of it are too few.
    if (abs(reduced.rest.high) >= 0x1p-38 || magnitude < 0.5)
      return turn(sincosNearZero(reduced.rest), reduced.quarters);
  }
  if (!isFinite(angle)) return {notANumber(), notANumber()};
  const ReducedAngle reduced = reduceExactly(magnitude);
  const SinCos<double> result = turn(sincosNearZero(reduced.rest), reduced.quarters);
  return {fromBits(bitsOf(result.sin) ^ (bitsOf(angle) & kSignBit)), result.cos};
}

double atan2(double y, double x) {
  if (x != x || y != y) return notANumber();
  const double ax = withSignOf(x, 0.0);
  const double ay = withSignOf(y, 0.0);
  const bool left = (bitsOf(x) & kSignBit) != 0;
  if (ay == 0.0) return withSignOf(left ? detail::kPi.high : 0.0, y);
  if (ax == kInfinity && ay == kInfinity)
    return withSignOf(left ? 3 * 0.25 * detail::kPi.high : 0.25 * detail::kPi.high, y);

  const bool steep = ay > ax;
  double a = steep ? ax : ay;
  double b = steep ? ay : ax;
  // So flat that the angle is the ratio itself, which may be subnormal and must be rounded once.
  if (!steep && !left && a < b * 0x1p-28) return withSignOf(a / b, y);

  Pair angle{0.0, 0.0};
  // Flatter than this the ratio vanishes beside pi/2 and pi.
  if (a > b * 0x1p-70) {
    if (biasedExponent(b) == 0) {
      a *= 0x1p54;
      b *= 0x1p54;
    }
    const double unit = powerOfTwo(512 - biasedExponent(b) / 2);
    const double rest = powerOfTwo(511 - (biasedExponent(b) - biasedExponent(b) / 2));
    angle = atanOfRatio(a * unit * rest, b * unit * rest);
  }
  if (steep) angle = addSmaller(detail::kHalfPi, {-angle.high, -angle.low});
  if (left) angle = addSmaller(detail::kPi, {-angle.high, -angle.low});
  return withSignOf(angle.high + angle.low, y);
}

double exp(double x) {
  if (x != x) return notANumber();
  if (x > 710.0) return kInfinity;
  if (x < -746.0) return 0.0;
  const double n = roundToInteger(x * detail::kExpInverseStep);
  return exponential(n, (x - n * detail::kExpStep1) - n * detail::kExpStep2);
}

double exp2(double x) {
  if (x != x) return notANumber();
  if (x >= 1024.0) return kInfinity;
  if (x < -1076.0) return 0.0;
  const double n = roundToInteger(x * 64.0);
  return exponential(n, (x - n * 0x1p-6) * detail::kLn2);
}

double log2(double x) {
  if (x == 0.0) return -kInfinity;
  if (!(x > 0.0)) return notANumber();
  if (x == kInfinity) return kInfinity;
  return log2Pair(x).high;
}

double pow(double base, double exponent) {
  if (exponent == 0.0 || base == 1.0) return 1.0;
  if (!(base >= 0.0) || exponent != exponent) return notANumber();
  if (base == 0.0 || base == kInfinity) return (base == 0.0) == (exponent > 0.0) ? 0.0 : kInfinity;
  // |log2(base)| is at least 2^-53, so beyond these the result is out of range, or 1.
  constexpr double kLargest = 0x1p65;
  constexpr double kLeast = 0x1p-65;
  if (abs(exponent) > kLargest) return (base > 1.0) == (exponent > 0.0) ? kInfinity : 0.0;
  if (abs(exponent) < kLeast) return 1.0;

  const Pair t = multiply(log2Pair(base), {exponent, 0.0});
  if (t.high > 1025.0) return kInfinity;
  if (t.high < -1076.0) return 0.0;
  const double n = roundToInteger(t.high * 64.0);
  return exponential(n, ((t.high - n * 0x1p-6) + t.low) * detail::kLn2);
}

}  // namespace samestep
