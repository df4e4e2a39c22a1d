#pragma once

#include <bit>
#include <compare>
#include <cstdint>
#include <type_traits>

#include "samestep/halves.h"

/// The ways a machine may compute what the exact result defines. All of them give the same bits; every way
/// this compiler can build is compiled and compared by the tests. This is the only file that asks which
/// compiler or processor it meets.
namespace samestep::way {

/// 128-bit words in two halves: needs nothing but 64-bit integers.
struct PortableWords {
  using U128 = Halves;

  static constexpr U128 make(std::uint64_t high, std::uint64_t low) { return {high, low}; }
  static constexpr std::uint64_t high(U128 a) { return a.high; }
  static constexpr std::uint64_t low(U128 a) { return a.low; }
  static constexpr U128 multiply(std::uint64_t a, std::uint64_t b) { return multiplyHalves(a, b); }
  static constexpr U128 multiplySigned(std::int64_t a, std::int64_t b) {
    Halves product = multiplyHalves(static_cast<std::uint64_t>(a), static_cast<std::uint64_t>(b));
    product.high -= (static_cast<std::uint64_t>(a >> 63) & static_cast<std::uint64_t>(b)) +
                    (static_cast<std::uint64_t>(b >> 63) & static_cast<std::uint64_t>(a));
    return product;
  }

  /// The sum of products of Q32.32 numbers, modulo 2^64 units, with its fraction apart. Keeps only the bits
  /// that reach the result: four 64-bit products each, no carries.
  class Sum32 {
   public:
    constexpr void plus(std::int64_t a, std::int64_t b) {
      const Parts parts = product(a, b);
      whole_ += parts.whole;
      fraction_ += parts.fraction;
    }
    constexpr void minus(std::int64_t a, std::int64_t b) {
      const Parts parts = product(a, b);
      whole_ -= parts.whole;
      fraction_ -= parts.fraction;
    }
    constexpr void plus(std::int64_t c) { whole_ += static_cast<std::uint64_t>(c); }
    /// To nearest, ties to even.
    constexpr std::int64_t rounded() const {
      const std::uint64_t floor =
          whole_ + static_cast<std::uint64_t>(static_cast<std::int64_t>(fraction_) >> 32);
      const std::uint64_t roundUp = ((fraction_ & kMask) + (kMask >> 1) + (floor & 1)) >> 32;
      return static_cast<std::int64_t>(floor + roundUp);
    }

   private:
    static constexpr std::uint64_t kMask = 0xffffffff;
    struct Parts {
      std::uint64_t whole, fraction;
    };
    static constexpr Parts product(std::int64_t a, std::int64_t b) {
      const auto aHigh = static_cast<std::uint64_t>(a >> 32), aLow = static_cast<std::uint64_t>(a) & kMask;
      const auto bHigh = static_cast<std::uint64_t>(b >> 32), bLow = static_cast<std::uint64_t>(b) & kMask;
      const std::uint64_t lowest = aLow * bLow;
      return {(aHigh * bHigh << 32) + aHigh * bLow + aLow * bHigh + (lowest >> 32), lowest & kMask};
    }
    std::uint64_t whole_ = 0;
    std::uint64_t fraction_ = 0;
  };
};

/// The sum of products of numbers with kBits fraction bits, modulo 2^128.
template <class Words, int kBits>
class Sum {
 public:
  constexpr void plus(std::int64_t a, std::int64_t b) { sum_ = sum_ + Words::multiplySigned(a, b); }
  constexpr void minus(std::int64_t a, std::int64_t b) { sum_ = sum_ - Words::multiplySigned(a, b); }
  constexpr void plus(std::int64_t c) {
    sum_ = sum_ + (Words::make(static_cast<std::uint64_t>(c >> 63), static_cast<std::uint64_t>(c)) << kBits);
  }
  /// To nearest, ties to even.
  constexpr std::int64_t rounded() const {
    if constexpr (kBits == 0) {
      return static_cast<std::int64_t>(Words::low(sum_));
    } else {
      constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
      const std::uint64_t floor = Words::low(sum_ >> kBits);
      const std::uint64_t roundUp = ((Words::low(sum_) & kMask) + (kMask >> 1) + (floor & 1)) >> kBits;
      return static_cast<std::int64_t>(floor + roundUp);
    }
  }

 private:
  typename Words::U128 sum_ = {};
};

template <>
class Sum<PortableWords, 32> : public PortableWords::Sum32 {};

/// 128 by 64 bits with 64-bit divisions only.
struct DivideByHalves {
  static constexpr QuotientRemainder divide(std::uint64_t high, std::uint64_t low, std::uint64_t divisor) {
    return divideHalves({high, low}, divisor);
  }
};

/// 128 by 64 bits by two estimates in double, each made exact by integers: for processors that have a fast
/// floating divide but none of 128 by 64 bits. Any rounding mode and contraction gives the same quotient,
/// because the estimates are only required to be near.
struct DivideByDouble {
  static constexpr QuotientRemainder divide(std::uint64_t high, std::uint64_t low, std::uint64_t divisor) {
    // Scaled so that the divisor has its top bit: the quotient of the upper parts then has 64 bits at most.
    const int shift = std::countl_zero(divisor);
    const std::uint64_t d = divisor << shift;
    const Halves n = Halves{high, low} << shift;
    const double inverse = 18446744073709551616.0 / static_cast<double>(d);
    // The first estimate is right to about 2^-50 of the quotient; rounded down it leaves a remainder that
    // the second one brings to within one unit.
    const std::uint64_t first = estimate(n.high, n.low, inverse);
    Halves rest = n - PortableWords::multiply(first, d);
    std::uint64_t quotient = first;
    while (static_cast<std::int64_t>(rest.high) < 0) {
      const std::uint64_t back = estimate(~rest.high, ~rest.low, inverse) + 1;
      quotient -= back;
      rest = rest + PortableWords::multiply(back, d);
    }
    while (rest.high != 0 || rest.low >= d) {
      const std::uint64_t more = estimate(rest.high, rest.low, inverse);
      const std::uint64_t step = more == 0 ? 1 : more;
      quotient += step;
      rest = rest - PortableWords::multiply(step, d);
      while (static_cast<std::int64_t>(rest.high) < 0) {
        --quotient;
        rest = rest + Halves{0, d};
      }
    }
    return {quotient, rest.low >> shift};
  }

 private:
  static constexpr std::uint64_t estimate(std::uint64_t high, std::uint64_t low, double inverse) {
    const double value =
        (static_cast<double>(high) + static_cast<double>(low) * (1.0 / 18446744073709551616.0)) * inverse;
    return value >= 18446744073709549568.0 ? ~std::uint64_t{0} : static_cast<std::uint64_t>(value);
  }
};

/// Square roots without floating point.
struct RootByInteger {
  /// The largest integer whose square is at most high:low. Newton's iteration from above.
  static constexpr std::uint64_t floorRoot(std::uint64_t high, std::uint64_t low) {
    if (high == 0 && low == 0) return 0;
    const int bits = high != 0 ? 128 - std::countl_zero(high) : 64 - std::countl_zero(low);
    const int half = (bits + 1) / 2;
    std::uint64_t root = half == 64 ? ~std::uint64_t{0} : std::uint64_t{1} << half;
    while (true) {
      if (high >= root) return root;  // only where the root is 2^64 - 1
      const std::uint64_t quotient = divideHalves({high, low}, root).quotient;
      if (quotient >= root) return root;
      root = root / 2 + quotient / 2 + (root & quotient & 1);
    }
  }
};

/// Square roots from a double estimate, made exact by integers.
struct RootByDouble {
  static constexpr std::uint64_t floorRoot(std::uint64_t high, std::uint64_t low) {
    if (std::is_constant_evaluated()) return RootByInteger::floorRoot(high, low);
    const double value = static_cast<double>(high) * 18446744073709551616.0 + static_cast<double>(low);
    const double estimate = __builtin_sqrt(value);
    std::uint64_t root =
        estimate >= 18446744073709549568.0 ? ~std::uint64_t{0} : static_cast<std::uint64_t>(estimate);
    if (high >> 40 != 0) {
      // More bits than a double holds: one step of Newton's iteration on the exact remainder.
      const Halves rest = Halves{high, low} - multiplyHalves(root, root);
      const bool below = static_cast<std::int64_t>(rest.high) < 0;
      const Halves size = below ? Halves{} - rest : rest;
      const double step =
          (static_cast<double>(size.high) * 18446744073709551616.0 + static_cast<double>(size.low)) /
          (2.0 * static_cast<double>(root));
      const auto change = static_cast<std::uint64_t>(step);
      root = below ? root - change : root + change < root ? ~std::uint64_t{0} : root + change;
    }
    while (multiplyHalves(root, root) > Halves{high, low}) --root;
    while (root != ~std::uint64_t{0} && multiplyHalves(root + 1, root + 1) <= Halves{high, low}) ++root;
    return root;
  }
};

#if defined(__SIZEOF_INT128__)
__extension__ typedef unsigned __int128 Native128;
__extension__ typedef __int128 NativeSigned128;

/// The compiler's own 128-bit integer.
struct NativeWords {
  using U128 = Native128;

  static constexpr U128 make(std::uint64_t high, std::uint64_t low) { return U128{high} << 64 | low; }
  static constexpr std::uint64_t high(U128 a) { return static_cast<std::uint64_t>(a >> 64); }
  static constexpr std::uint64_t low(U128 a) { return static_cast<std::uint64_t>(a); }
  static constexpr U128 multiply(std::uint64_t a, std::uint64_t b) { return U128{a} * b; }
  static constexpr U128 multiplySigned(std::int64_t a, std::int64_t b) {
    return static_cast<U128>(NativeSigned128{a} * b);
  }
};

/// The compiler's own division of 128-bit integers.
struct DivideByNative {
  static constexpr QuotientRemainder divide(std::uint64_t high, std::uint64_t low, std::uint64_t divisor) {
    const Native128 numerator = NativeWords::make(high, low);
    const auto quotient = static_cast<std::uint64_t>(numerator / divisor);
    return {quotient, low - quotient * divisor};
  }
};
inline constexpr bool kHasNativeWords = true;
#else
using NativeWords = PortableWords;
using DivideByNative = DivideByHalves;
inline constexpr bool kHasNativeWords = false;
#endif

#if defined(__x86_64__) && defined(__GNUC__)
/// The processor's division of 128 by 64 bits.
struct DivideByHardware {
  static constexpr QuotientRemainder divide(std::uint64_t high, std::uint64_t low, std::uint64_t divisor) {
    if (std::is_constant_evaluated()) return divideHalves({high, low}, divisor);
    QuotientRemainder result{};
    asm("divq %[divisor]"
        : "=a"(result.quotient), "=d"(result.remainder)
        : [divisor] "rm"(divisor), "a"(low), "d"(high)
        : "cc");
    return result;
  }
};
inline constexpr bool kHasHardwareDivide = true;
#else
using DivideByHardware = DivideByHalves;
inline constexpr bool kHasHardwareDivide = false;
#endif

/// One way to compute everything.
template <class WordsWay, class DivideWay, class RootWay>
struct Way {
  using Words = WordsWay;
  using Divide = DivideWay;
  using Root = RootWay;
};

/// Nothing but 64-bit integers.
using Portable = Way<PortableWords, DivideByHalves, RootByInteger>;

#if defined(SAMESTEP_FIXED_PORTABLE)
using Chosen = Portable;
#elif defined(__x86_64__) && defined(__GNUC__)
using Chosen = Way<NativeWords, DivideByHardware, RootByDouble>;
#elif defined(__SIZEOF_INT128__)
using Chosen = Way<NativeWords, DivideByDouble, RootByDouble>;
#else
using Chosen = Way<PortableWords, DivideByHalves, RootByInteger>;
#endif

}  // namespace samestep::way
