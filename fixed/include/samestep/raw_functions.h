#pragma once

#include <bit>
#include <cstdint>

#include "samestep/raw_algebra.h"

/// sin, cos, atan2, exp2, exp, log2 and pow of Q32.32 numbers on raw bits. Here the algorithm is the
/// definition: only integers, the same widths on every machine.
namespace samestep::raw {

struct RawSinCos {
  std::int64_t sin, cos;

  friend constexpr bool operator==(RawSinCos, RawSinCos) = default;
};

/// The upper half of a product: of a fraction in units of 2^-64 and a number of any unit.
template <class Way>
constexpr std::uint64_t multiplyHigh(std::uint64_t a, std::uint64_t b) {
  return Way::Words::high(Way::Words::multiply(a, b));
}

inline constexpr std::uint64_t kOneQ63 = std::uint64_t{1} << 63;

template <class Way>
constexpr RawSinCos sincos(std::int64_t angle) {
  // 2^96 / (2 pi): the angle in turns modulo 1, in units of 2^-64.
  constexpr std::uint64_t kTurnsHigh = 0x28be60db, kTurnsLow = 0x9391054a7f09d5f4;
  constexpr std::uint64_t kQuarterPi = 0xc90fdaa22168c235;
  const std::uint64_t size = magnitude(angle);
  const std::uint64_t turns = size * kTurnsHigh + multiplyHigh<Way>(size, kTurnsLow);
  const std::uint64_t quadrant = (turns + (std::uint64_t{1} << 61)) >> 62;
  const std::uint64_t offset = turns - (quadrant << 62);
  const bool before = static_cast<std::int64_t>(offset) < 0;
  // In units of 2^-64 radians, at most pi / 4.
  const std::uint64_t x = multiplyHigh<Way>((before ? 0 - offset : offset) << 2, kQuarterPi) << 1;
  const std::uint64_t square = multiplyHigh<Way>(x, x);
  std::uint64_t sine = kOneQ63, cosine = kOneQ63;
  for (std::uint64_t k = 20; k >= 2; k -= 2) {
    cosine = kOneQ63 - multiplyHigh<Way>(square / (k * (k - 1)), cosine);
    sine = kOneQ63 - multiplyHigh<Way>(square / (k * (k + 1)), sine);
  }
  sine = multiplyHigh<Way>(x, sine);
  const auto sineUnits = static_cast<std::int64_t>((sine + (std::uint64_t{1} << 30)) >> 31);
  const auto cosineUnits = static_cast<std::int64_t>((cosine + (std::uint64_t{1} << 30)) >> 31);
  const std::int64_t s = before ? -sineUnits : sineUnits;
  const std::int64_t c = cosineUnits;
  RawSinCos result{};
  switch (quadrant & 3) {
    case 0:
      result = {s, c};
      break;
    case 1:
      result = {c, -s};
      break;
    case 2:
      result = {-s, -c};
      break;
    default:
      result = {-c, s};
      break;
  }
  return {angle < 0 ? -result.sin : result.sin, result.cos};
}

template <class Way>
constexpr std::int64_t atan2(std::int64_t y, std::int64_t x) {
  if (y == 0 && x == 0) return 0;
  constexpr std::uint64_t kHalfPi = 0x6487ed5110b4611a;  // in units of 2^-62
  constexpr std::uint64_t kAtanHalf = 0x1dac670561bb4f69, kAtanOne = 0x3243f6a8885a308d;
  const std::uint64_t xSize = magnitude(x), ySize = magnitude(y);
  const bool steep = ySize > xSize;
  std::uint64_t n = steep ? xSize : ySize;
  std::uint64_t d = steep ? ySize : xSize;
  const int shift = std::countl_zero(d) - 3;
  n = shift >= 0 ? n << shift : n >> -shift;
  d = shift >= 0 ? d << shift : d >> -shift;
  // tan of the difference to 0, atan(1/2) or atan(1).
  std::uint64_t base = 0;
  std::int64_t top = static_cast<std::int64_t>(n);
  if (n > d - d / 4) {
    base = kAtanOne;
    top = static_cast<std::int64_t>(n - d);
    d = d + n;
  } else if (n > d / 4) {
    base = kAtanHalf;
    top = static_cast<std::int64_t>(2 * n - d);
    d = 2 * d + n;
  }
  const std::uint64_t t = Way::Divide::divide(magnitude(top), 0, d).quotient;
  const std::uint64_t square = multiplyHigh<Way>(t, t);
  std::uint64_t sum = 0;
  for (std::uint64_t k = 27; k <= 27; k -= 2) sum = kOneQ63 / k - multiplyHigh<Way>(square, sum);
  const std::uint64_t part = multiplyHigh<Way>(t, sum) >> 1;
  std::uint64_t angle = top < 0 ? base - part : base + part;
  if (steep) angle = kHalfPi - angle;
  if (x < 0) angle = 2 * kHalfPi - angle;
  const auto units = static_cast<std::int64_t>((angle + (std::uint64_t{1} << 29)) >> 30);
  return y < 0 ? -units : units;
}

template <class Way>
constexpr Quotient exp2(std::int64_t x) {
  constexpr std::uint64_t kLn2 = 0xb17217f7d1cf79ac;
  constexpr std::int64_t kMost = 0x7fffffffffffffff;
  const std::int64_t whole = x >> 32;
  if (whole >= 31) return {kMost, false};
  if (whole < -34) return {0, true};
  const std::uint64_t y = multiplyHigh<Way>(static_cast<std::uint64_t>(x) << 32, kLn2);
  std::uint64_t sum = kOneQ63 >> 1;
  for (std::uint64_t k = 24; k >= 1; --k) sum = (kOneQ63 >> 1) + multiplyHigh<Way>(y, sum) / k;
  const int shift = static_cast<int>(30 - whole);
  if (shift == 0) return {static_cast<std::int64_t>(sum), true};
  if (shift > 63) return {0, true};
  return {static_cast<std::int64_t>((sum + (std::uint64_t{1} << (shift - 1))) >> shift), true};
}

template <class Way>
constexpr Quotient exp(std::int64_t x) {
  constexpr std::int64_t kMost = 0x7fffffffffffffff;
  constexpr std::int64_t kLog2e = 0x171547653;
  if (x >> 32 >= 22) return {kMost, false};
  if (x >> 32 < -24) return {0, true};
  way::Sum<typename Way::Words, 32> power;
  power.plus(x, kLog2e);
  return exp2<Way>(power.rounded());
}

template <class Way>
constexpr std::int64_t log2(std::int64_t x) {
  if (x <= 0) return -0x7fffffffffffffff - 1;
  const int zeros = std::countl_zero(static_cast<std::uint64_t>(x));
  std::uint64_t m = static_cast<std::uint64_t>(x) << zeros;
  std::uint64_t result = 0;
  for (int bit = 0; bit < 33; ++bit) {
    const auto square = Way::Words::multiply(m, m);
    const bool two = Way::Words::high(square) >> 63 != 0;
    m = two ? Way::Words::high(square) : Way::Words::high(square << 1);
    result = result << 1 | (two ? 1 : 0);
  }
  return (std::int64_t{31 - zeros} * 4294967296) + static_cast<std::int64_t>((result + 1) >> 1);
}

template <class Way>
constexpr Quotient pow(std::int64_t base, std::int64_t exponent) {
  constexpr std::int64_t kOne = std::int64_t{1} << 32;
  if (exponent == 0) return {kOne, true};
  if (base < 0) return {0, false};
  if (base == 0) return exponent > 0 ? Quotient{0, true} : Quotient{0x7fffffffffffffff, false};
  way::Sum<typename Way::Words, 32> power;
  power.plus(log2<Way>(base), exponent);
  return exp2<Way>(power.rounded());
}

}  // namespace samestep::raw
