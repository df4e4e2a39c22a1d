#pragma once

#include <bit>
#include <compare>
#include <cstdint>
#include <initializer_list>

#include "samestep/expects.h"

namespace samestep {

/// An unsigned 128-bit integer in two halves; arithmetic is modulo 2^128, as of a built-in type.
/// Signed values are held as two's complement.
struct Halves {
  std::uint64_t high = 0;
  std::uint64_t low = 0;

  friend constexpr bool operator==(Halves, Halves) = default;
  friend constexpr std::strong_ordering operator<=>(Halves, Halves) = default;

  friend constexpr Halves operator+(Halves a, Halves b) {
    const std::uint64_t sum = a.low + b.low;
    return {a.high + b.high + (sum < a.low ? 1u : 0u), sum};
  }
  friend constexpr Halves operator-(Halves a, Halves b) {
    return {a.high - b.high - (a.low < b.low ? 1u : 0u), a.low - b.low};
  }
  /// @param by  0 to 127
  friend constexpr Halves operator<<(Halves a, int by) {
    if (by == 0) return a;
    if (by >= 64) return {a.low << (by - 64), 0};
    return {a.high << by | a.low >> (64 - by), a.low << by};
  }
  /// @param by  0 to 127
  friend constexpr Halves operator>>(Halves a, int by) {
    if (by == 0) return a;
    if (by >= 64) return {0, a.high >> (by - 64)};
    return {a.high >> by, a.low >> by | a.high << (64 - by)};
  }
};

/// Quotient and remainder of an unsigned division.
struct QuotientRemainder {
  std::uint64_t quotient, remainder;

  friend constexpr bool operator==(QuotientRemainder, QuotientRemainder) = default;
};

/// The 128-bit product of two 64-bit numbers, by four 32-bit products.
constexpr Halves multiplyHalves(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t kMask = 0xffffffff;
  const std::uint64_t aHigh = a >> 32, aLow = a & kMask;
  const std::uint64_t bHigh = b >> 32, bLow = b & kMask;
  const std::uint64_t lowest = aLow * bLow;
  // Neither sum can carry: (2^32-1)^2 + 2 (2^32-1) = 2^64 - 1.
  const std::uint64_t middle = aHigh * bLow + (lowest >> 32);
  const std::uint64_t other = aLow * bHigh + (middle & kMask);
  return {aHigh * bHigh + (middle >> 32) + (other >> 32), other << 32 | (lowest & kMask)};
}

/// Divides a 128-bit number by a 64-bit one with 64-bit divisions only (Knuth's algorithm D in base 2^32).
constexpr QuotientRemainder divideHalves(Halves numerator, std::uint64_t divisor) {
  expects(numerator.high < divisor);  // So that the quotient fits.
  constexpr std::uint64_t kBase = std::uint64_t{1} << 32;
  const int shift = std::countl_zero(divisor);
  const std::uint64_t d = divisor << shift;
  const Halves n = numerator << shift;
  const std::uint64_t dHigh = d >> 32, dLow = d & (kBase - 1);
  std::uint64_t rest = n.high;
  std::uint64_t quotient = 0;
  for (const std::uint64_t nextDigit : {n.low >> 32, n.low & (kBase - 1)}) {
    std::uint64_t digit = rest / dHigh;
    std::uint64_t left = rest % dHigh;
    while (digit >= kBase || digit * dLow > (left << 32 | nextDigit)) {
      --digit;
      left += dHigh;
      if (left >= kBase) break;
    }
    rest = (rest << 32 | nextDigit) - digit * d;
    quotient = quotient << 32 | digit;
  }
  return {quotient, rest >> shift};
}

}  // namespace samestep
