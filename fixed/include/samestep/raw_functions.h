#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "samestep/fixed_tables.h"
#include "samestep/raw_algebra.h"

/// sin, cos, atan2, exp2, exp, log2 and pow of Q32.32 numbers on raw bits. Here the algorithm is the
/// definition: only integers, the same widths on every machine. Comments give units as Qn: 2^-n.
namespace samestep::raw {

/// The upper half of a product.
template <class Way>
constexpr std::uint64_t multiplyHigh(std::uint64_t a, std::uint64_t b) {
  return Way::Words::high(Way::Words::multiply(a, b));
}

struct RawSinCos {
  std::int64_t sin, cos;

  friend constexpr bool operator==(RawSinCos, RawSinCos) = default;
};

/// The polynomial t0 - z (t1 - z (t2 + z (h0 + z (h1 + z h2)))), Q63, of terms t and higher terms h.
/// @param z  Q63, at most 1
template <class Way>
constexpr std::uint64_t polynomial(const std::array<std::uint64_t, 3>& terms,
                                   const std::array<std::int64_t, 3>& highTerms, std::uint64_t z) {
  const std::uint64_t shortZ = (z + (std::uint64_t{1} << 30)) >> 31;  // Q32
  const auto signedZ = static_cast<std::int64_t>(shortZ);
  // The last three need few enough bits for 64-bit products.
  std::int64_t high = highTerms[1] + (highTerms[2] * signedZ >> 32);
  high = highTerms[0] + (high * signedZ >> 32);
  std::uint64_t sum = terms[2] + static_cast<std::uint64_t>(high * signedZ >> 9);
  sum = terms[1] - Way::Words::multiplyShort(sum, shortZ);
  return terms[0] - multiplyHigh<Way>(sum, z);
}

template <class Way>
constexpr RawSinCos sincos(std::int64_t angle) {
  // The angle in turns, modulo 1, Q64: exact to 2^-63 for every angle.
  const std::uint64_t size = magnitude(angle);
  const std::uint64_t turns = size * kTurnsHigh + multiplyHigh<Way>(size, kTurnsLow);
  // The nearest quarter turn, and what is left in units of an eighth, Q63.
  const std::uint64_t quarters = (turns + (std::uint64_t{1} << 61)) >> 62;
  const std::uint64_t offset = turns - (quarters << 62);
  const bool before = offset >> 63 != 0;
  const std::uint64_t x = static_cast<std::uint64_t>(negatedIf(before, offset)) << 2;
  const std::uint64_t z = multiplyHigh<Way>(x, x) << 1;
  const std::uint64_t sine = multiplyHigh<Way>(polynomial<Way>(kSineTerms, kSineHighTerms, z), x);
  const std::uint64_t cosine = polynomial<Way>(kCosineTerms, kCosineHighTerms, z);
  const std::uint64_t sineUnits = (sine + (std::uint64_t{1} << 29)) >> 30;
  const std::uint64_t cosineUnits = (cosine + (std::uint64_t{1} << 30)) >> 31;
  // An odd count of quarters swaps sine and cosine.
  const std::uint64_t swap = (sineUnits ^ cosineUnits) & (0 - (quarters & 1));
  const bool secondHalf = (quarters & 2) != 0;
  const bool odd = (quarters & 1) != 0;
  const bool sineNegative = (!odd && before) != secondHalf;
  const bool cosineNegative = (odd && !before) != secondHalf;
  return {negatedIf(sineNegative != (angle < 0), sineUnits ^ swap),
          negatedIf(cosineNegative, cosineUnits ^ swap)};
}

template <class Way>
constexpr std::int64_t atan2(std::int64_t y, std::int64_t x) {
  if ((x | y) == 0) return 0;
  const std::uint64_t xSize = magnitude(x), ySize = magnitude(y);
  const bool steep = ySize > xSize;
  // Compilers make maximum and minimum in this form without a branch.
  const std::uint64_t large = xSize < ySize ? ySize : xSize;
  const std::uint64_t small = xSize < ySize ? xSize : ySize;
  // The larger one gets its top bit at 59; at most three bits of the smaller are lost.
  const int zeros = std::countl_zero(large);
  const std::uint64_t d = large << zeros >> 4;
  const std::uint64_t n = small << zeros >> 4;
  // Measured from atan(0), atan(1/2) or atan(1), so that the tangent t of the rest is at most 0.238, Q48.
  const std::uint64_t base = (n > (d >> 2) - (d >> 6) ? 1u : 0u) + (n > d - (d >> 2) ? 1u : 0u);
  const std::uint64_t top = 2 * n - base * d;
  const bool below = top >> 63 != 0;
  const std::uint64_t t =
      Way::Divide::fraction48(static_cast<std::uint64_t>(negatedIf(below, top)), 2 * d + base * n);
  const std::uint64_t shortT = t >> 14;           // Q34, below 2^32
  const std::uint64_t z = shortT * shortT >> 32;  // Q36, below 2^32
  const auto signedZ = static_cast<std::int64_t>(z);
  // Two halves of the sum side by side, for they are waited for.
  const std::int64_t lower = kArcTerms[1] + (kArcTerms[2] * signedZ >> 36);
  const std::int64_t upper = kArcTerms[3] + (kArcTerms[4] * signedZ >> 36);
  const auto shortSquare = static_cast<std::int64_t>(z * z >> 36);
  const std::int64_t sum = lower + (upper * shortSquare >> 36);
  const auto factor = static_cast<std::uint64_t>(kArcTerms[0] + (sum * signedZ >> 36));
  const std::uint64_t cube = shortT * z;                                // Q70, below 2^64
  const std::uint64_t part = (t << 14) - ((cube >> 32) * factor >> 8);  // Q62
  // Mirrored at the diagonal where steep, and at the y axis where x < 0. Q62.
  const bool left = x < 0;
  const std::uint64_t from = kArcBase[static_cast<std::size_t>(base) + (steep ? 3u : 0u) + (left ? 6u : 0u)];
  const std::uint64_t angle = from + static_cast<std::uint64_t>(negatedIf((below != steep) != left, part));
  return negatedIf(y < 0, (angle + (std::uint64_t{1} << 29)) >> 30);
}

/// 2^p for an exponent p in units of 2^-88, two's complement.
template <class Way>
constexpr Quotient exp2OfQ88(std::uint64_t high, std::uint64_t low) {
  constexpr std::int64_t kMost = 0x7fffffffffffffff;
  const std::int64_t whole = static_cast<std::int64_t>(high) >> 24;
  if (whole >= 31) return {kMost, false};
  if (whole < -33) return {0, true};
  const std::uint64_t i = high >> 18 & 63;
  const std::uint64_t d = high << 46 | low >> 18;  // Q70, below 1/64
  const std::uint64_t shortD = d >> 32;            // Q38
  std::uint64_t sum = kPowerTerms[4] + (kPowerTerms[5] * shortD >> 38);
  sum = kPowerTerms[3] + (sum * shortD >> 15);
  sum = kPowerTerms[2] + (multiplyHigh<Way>(sum, d) >> 6);
  sum = kPowerTerms[1] + (multiplyHigh<Way>(sum, d) >> 6);
  sum = kPowerTerms[0] + (multiplyHigh<Way>(sum, d) >> 6);
  const std::uint64_t growth = multiplyHigh<Way>(sum, d);  // 2^d - 1, Q70
  using Words = typename Way::Words;
  const std::uint64_t grown = multiplyHigh<Way>(kPowerHigh[i], growth);                                // Q69
  const auto power = Words::make(kPowerHigh[i], kPowerLow[i]) + Words::make(grown >> 6, grown << 58);  // Q127
  const std::uint64_t mantissa = Words::high(power);
  const int shift = static_cast<int>(31 - whole);  // 1 to 64
  const std::uint64_t twice = mantissa >> (shift - 1);
  return {static_cast<std::int64_t>((twice >> 1) + (twice & 1)), true};
}

template <class Way>
constexpr Quotient exp2(std::int64_t x) {
  return exp2OfQ88<Way>(static_cast<std::uint64_t>(x >> 8), static_cast<std::uint64_t>(x) << 56);
}

template <class Way>
constexpr Quotient exp(std::int64_t x) {
  constexpr std::int64_t kMost = 0x7fffffffffffffff;
  // Beyond these the power of two is out of range by far, and the product below would not fit.
  if (x >> 32 >= 22) return {kMost, false};
  if (x >> 32 < -24) return {0, true};
  using Words = typename Way::Words;
  const std::uint64_t size = magnitude(x);
  const auto product =
      Words::multiply(size, kLog2eHigh) + Words::make(0, multiplyHigh<Way>(size, kLog2eLow));  // Q95
  const auto power = x < 0 ? Words::make(0, 0) - (product >> 7) : product >> 7;
  return exp2OfQ88<Way>(Words::high(power), Words::low(power));
}

/// The mantissa of x in [1, 2), Q63, the exponent, and the interval of the mantissa.
struct Normalized {
  std::uint64_t mantissa;
  std::int64_t exponent;
  std::uint32_t interval;
};

constexpr Normalized normalized(std::int64_t x) {
  const int zeros = std::countl_zero(static_cast<std::uint64_t>(x));
  const std::uint64_t mantissa = static_cast<std::uint64_t>(x) << zeros;
  return {mantissa, 31 - zeros, static_cast<std::uint32_t>(mantissa >> 57 & 63)};
}

template <class Way>
constexpr std::int64_t log2(std::int64_t x) {
  if (x <= 0) return -0x7fffffffffffffff - 1;
  const Normalized m = normalized(x);
  // The mantissa times its short inverse is 1 + u, |u| <= 1/64, Q62.
  const auto u =
      static_cast<std::int64_t>((m.mantissa >> 10) * kInverse[m.interval] - (std::uint64_t{1} << 62));
  const std::int64_t shortU = u >> 30;
  const auto term = [](std::size_t k) { return static_cast<std::int64_t>(kShortLogTerms[k]); };
  std::int64_t sum = term(3) - (term(4) * shortU >> 32);
  sum = term(2) - (sum * shortU >> 32);
  sum = term(1) - (sum * shortU >> 32);
  sum = term(0) - (sum * shortU >> 32);
  const std::int64_t square = (u >> 25) * (u >> 25) >> 32;                        // Q42
  const std::uint64_t linear = multiplyHigh<Way>(magnitude(u) << 7, kLog2eHigh);  // Q68
  const std::int64_t fraction = static_cast<std::int64_t>(kInverseLogHigh[m.interval]) +
                                negatedIf(u < 0, linear >> 12) - (square * sum >> 18);  // Q56
  return m.exponent * (std::int64_t{1} << 32) + ((fraction + (std::int64_t{1} << 23)) >> 24);
}

/// log2 of a positive raw x in units of 2^-120, two's complement, right to 70 bits even next to 1.
template <class Way>
constexpr typename Way::Words::U128 log2Q120(std::int64_t x) {
  using Words = typename Way::Words;
  const Normalized m = normalized(x);
  const auto whole = Words::make(static_cast<std::uint64_t>(m.exponent) << 56, 0) +
                     Words::make(kInverseLogHigh[m.interval], kInverseLogLow[m.interval]);
  // The mantissa times its short inverse is 1 + u, exactly, Q72.
  const auto signedU =
      Words::multiply(m.mantissa, kInverse[m.interval]) - Words::make(std::uint64_t{1} << 8, 0);
  const bool negative = Words::high(signedU) >> 63 != 0;
  const auto u = negative ? Words::make(0, 0) - signedU : signedU;
  if (Words::high(u) == 0 && Words::low(u) == 0) return whole;
  // Shifted up to its full 64 bits, so that the tiny logarithms next to 1 keep theirs.
  const int zeros =
      Words::high(u) != 0 ? std::countl_zero(Words::high(u)) : 64 + std::countl_zero(Words::low(u));
  const auto full = u << zeros;  // Q(72 + zeros)
  const std::uint64_t v = Words::high(full);
  const auto linear = (Words::multiply(v, kLog2eHigh) + Words::make(0, multiplyHigh<Way>(v, kLog2eLow))) +
                      Words::make(0, multiplyHigh<Way>(Words::low(full), kLog2eHigh));  // Q(71 + zeros)
  const std::uint64_t shortU = Words::low(u >> 2);                                      // Q70
  std::uint64_t sum = kLogTerms.back();
  for (std::size_t k = kLogTerms.size() - 1; k-- > 0;) {
    const std::uint64_t next = multiplyHigh<Way>(sum, shortU) >> 6;
    sum = negative ? kLogTerms[k] + next : kLogTerms[k] - next;
  }
  const auto square = Words::multiply(v, v);  // Q(16 + 2 zeros)
  const auto quadratic = Words::multiply(Words::high(square), sum) +
                         Words::make(0, multiplyHigh<Way>(Words::low(square), sum));  // Q(16 + 2 zeros)
  const auto first = linear >> (zeros - 49);
  const int down = 2 * zeros - 104;
  const auto second = down >= 128 ? Words::make(0, 0) : quadratic >> down;
  return negative ? whole - first - second : whole + first - second;
}

template <class Way>
constexpr Quotient pow(std::int64_t base, std::int64_t exponent) {
  constexpr std::int64_t kOne = std::int64_t{1} << 32;
  constexpr std::int64_t kMost = 0x7fffffffffffffff;
  if (exponent == 0) return {kOne, true};
  if (base < 0) return {0, false};
  if (base == 0) return exponent > 0 ? Quotient{0, true} : Quotient{kMost, false};
  using Words = typename Way::Words;
  const auto logarithm = log2Q120<Way>(base);
  const bool negative = (Words::high(logarithm) >> 63 != 0) != (exponent < 0);
  const auto size = Words::high(logarithm) >> 63 != 0 ? Words::make(0, 0) - logarithm : logarithm;
  const std::uint64_t factor = magnitude(exponent);
  // Q88; at most 2^(5 + 31 + 88), which fits.
  const auto product = Words::multiply(Words::high(size), factor) +
                       Words::make(0, multiplyHigh<Way>(Words::low(size), factor));
  const auto power = negative ? Words::make(0, 0) - product : product;
  return exp2OfQ88<Way>(Words::high(power), Words::low(power));
}

}  // namespace samestep::raw
