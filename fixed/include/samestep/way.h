#pragma once

#include <bit>
#include <compare>
#include <cstdint>
#include <type_traits>

#include "samestep/expects.h"
#include "samestep/halves.h"
#include "samestep/near_double.h"
#include "samestep/way_root.h"

#if defined(_MSC_VER)
#error "Samestep needs gcc or clang; on Windows those of MinGW-w64, since MSVC and clang-cl are not supported"
#endif

/// The ways a machine may compute what the exact result defines. All of them give the same bits; every way
/// this compiler can build is compiled and compared by the tests. Only this file and near_double.h ask
/// which compiler or processor they meet.
namespace samestep::way {

/// whole + high:low / 2^kBits to nearest, ties to even, modulo 2^64.
template <int kBits>
constexpr std::int64_t roundedShift(std::uint64_t high, std::uint64_t low, std::uint64_t whole) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
  const std::uint64_t floor = (high << (64 - kBits) | low >> kBits) + whole;
  // Less than half of a unit is added, and a little more to an odd floor, so that a tie carries.
  return static_cast<std::int64_t>(floor + (((low & kMask) + (kMask >> 1) + (floor & 1)) >> kBits));
}

/// 128-bit words in two halves: needs nothing but 64-bit integers.
struct PortableWords {
  using U128 = Halves;

  static constexpr U128 make(std::uint64_t high, std::uint64_t low) { return {high, low}; }
  static constexpr std::uint64_t high(U128 a) { return a.high; }
  static constexpr std::uint64_t low(U128 a) { return a.low; }
  static constexpr U128 multiply(std::uint64_t a, std::uint64_t b) { return multiplyHalves(a, b); }
  /// a b / 2^33 for b at most 2^32: half the work of a full product.
  static constexpr std::uint64_t multiplyShort(std::uint64_t a, std::uint64_t b) {
    return ((a >> 32) * b + ((a & 0xffffffff) * b >> 32)) >> 1;
  }
  static constexpr U128 multiplySigned(std::int64_t a, std::int64_t b) {
    Halves product = multiplyHalves(static_cast<std::uint64_t>(a), static_cast<std::uint64_t>(b));
    product.high -= (static_cast<std::uint64_t>(a >> 63) & static_cast<std::uint64_t>(b)) +
                    (static_cast<std::uint64_t>(b >> 63) & static_cast<std::uint64_t>(a));
    return product;
  }

  /// The sum of products of Q32.32 numbers, modulo 2^64 units, with its fraction apart. Keeps only the bits
  /// that reach the result: three 64-bit products each, no carries.
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
    /// Rounds to nearest, ties to even.
    constexpr std::int64_t rounded() const {
      const std::uint64_t floor =
          whole_ + static_cast<std::uint64_t>(static_cast<std::int64_t>(fraction_) >> 32);
      const auto rest = static_cast<std::uint32_t>(fraction_) | static_cast<std::uint32_t>(floor & 1);
      return static_cast<std::int64_t>(floor + (rest > 0x80000000 ? 1 : 0));
    }

   private:
    static constexpr std::uint64_t kMask = 0xffffffff;
    struct Parts {
      std::uint64_t whole, fraction;
    };
    /// a b 2^-32 is a's upper half times b, and its lower half times both halves of b.
    static constexpr Parts product(std::int64_t a, std::int64_t b) {
      const auto aHigh = static_cast<std::uint64_t>(a >> 32), aLow = static_cast<std::uint64_t>(a) & kMask;
      const auto bHigh = static_cast<std::uint64_t>(b >> 32), bLow = static_cast<std::uint64_t>(b) & kMask;
      const std::uint64_t lowest = aLow * bLow;
      return {aHigh * static_cast<std::uint64_t>(b) + aLow * bHigh + (lowest >> 32), lowest & kMask};
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
  constexpr void plus(std::int64_t c) { whole_ += static_cast<std::uint64_t>(c); }
  /// Rounds to nearest, ties to even.
  constexpr std::int64_t rounded() const {
    if constexpr (kBits == 0) {
      return static_cast<std::int64_t>(Words::low(sum_) + whole_);
    } else if constexpr (kBits == 32) {
      return Words::rounded32(sum_, whole_);
    } else {
      return roundedShift<kBits>(Words::high(sum_), Words::low(sum_), whole_);
    }
  }

 private:
  typename Words::U128 sum_ = {};
  std::uint64_t whole_ = 0;
};

template <>
class Sum<PortableWords, 32> : public PortableWords::Sum32 {};

/// 128 by 64 bits with 64-bit divisions only.
struct DivideByHalves {
  static constexpr QuotientRemainder divide(std::uint64_t high, std::uint64_t low, std::uint64_t divisor) {
    return divideHalves({high, low}, divisor);
  }
  /// floor(n 2^48 / d), n < d / 4, d < 2^62.
  static constexpr std::uint64_t fraction48(std::uint64_t n, std::uint64_t d) {
    return divide(n >> 16, n << 48, d).quotient;
  }
};

/// Quotients of numbers from an estimate in double, made exact by integers: for processors that have a fast
/// floating divide but none of 128 by 64 bits. Any rounding mode and contraction gives the same quotient,
/// because the estimate is only required to be near.
struct DivideByDouble : DivideByHalves {
  static constexpr double kMaxQuotient = 1125899906842624.0;  // 2^50: the estimate is within one unit
  static constexpr std::uint64_t kMaxDivisor = std::uint64_t{1} << 61;  // twice the remainder fits

  /// The quotient of a numerator with these low 64 bits to nearest, ties to even, of magnitudes.
  static constexpr std::uint64_t rounded(double estimate, std::uint64_t low, std::uint64_t d) {
    expects(d < kMaxDivisor && estimate < kMaxQuotient);
    // The quotient is the nearest to the estimate, so that the remainder's place says all: within 3/2 of d
    // either way.
    const auto quotient = static_cast<std::uint64_t>(static_cast<std::int64_t>(estimate + 0.5));
    // The remainder is small, so that its low 64 bits are all of it.
    const auto twice = static_cast<std::int64_t>(2 * (low - quotient * d));
    const auto divisor = static_cast<std::int64_t>(d);
    const auto odd = static_cast<std::int64_t>(quotient & 1);
    return quotient + (twice + odd > divisor ? 1u : 0u) - (twice - odd < -divisor ? 1u : 0u);
  }

  static constexpr std::uint64_t fraction48(std::uint64_t n, std::uint64_t d) {
    if (std::is_constant_evaluated()) return DivideByHalves::fraction48(n, d);
    const auto divisor = static_cast<std::int64_t>(d);
    const auto quotient = static_cast<std::int64_t>(nearDouble(static_cast<std::int64_t>(n)) *
                                                    281474976710656.0 / nearDouble(divisor));
    const auto rest = static_cast<std::int64_t>((n << 48) - static_cast<std::uint64_t>(quotient) * d);
    return static_cast<std::uint64_t>(quotient + (rest >= divisor ? 1 : 0) - (rest < 0 ? 1 : 0));
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
  static constexpr std::uint64_t multiplyShort(std::uint64_t a, std::uint64_t b) {
    return high(multiply(a, b << 31));
  }
  static constexpr U128 multiplySigned(std::int64_t a, std::int64_t b) {
#if !defined(__clang__)
    // gcc 12 otherwise stores the sign-extended factor to the stack, though nothing ever reads it.
    if (!std::is_constant_evaluated()) asm("" : "+r"(b));
#endif
    return static_cast<U128>(NativeSigned128{a} * b);
  }
  static constexpr std::int64_t rounded32(U128 sum, std::uint64_t whole) {
    return roundedShift<32>(high(sum), low(sum), whole);
  }
};

/// The compiler's own division of 128-bit integers.
struct DivideByNative {
  static constexpr QuotientRemainder divide(std::uint64_t high, std::uint64_t low, std::uint64_t divisor) {
    const Native128 numerator = NativeWords::make(high, low);
    const auto quotient = static_cast<std::uint64_t>(numerator / divisor);
    return {quotient, low - quotient * divisor};
  }
  static constexpr std::uint64_t fraction48(std::uint64_t n, std::uint64_t d) {
    return static_cast<std::uint64_t>((Native128{n} << 48) / d);
  }
};
inline constexpr bool kHasNativeWords = true;
#else
using NativeWords = PortableWords;
using DivideByNative = DivideByHalves;
inline constexpr bool kHasNativeWords = false;
#endif

#if defined(__x86_64__) && defined(__GNUC__)
/// Native words with the rounding shift in four instructions.
struct HardwareWords : NativeWords {
  static constexpr std::int64_t rounded32(U128 sum, std::uint64_t whole) {
    if (std::is_constant_evaluated()) return NativeWords::rounded32(sum, whole);
    std::uint64_t upper = high(sum), lower = low(sum);
    asm("btq $32, %[parity]\n\t"
        "adcq $0x7fffffff, %[lower]\n\t"
        "adcq $0, %[upper]\n\t"
        "shrdq $32, %[upper], %[lower]"
        : [lower] "+r"(lower), [upper] "+r"(upper)
        : [parity] "r"(lower + (whole << 32))
        : "cc");
    return static_cast<std::int64_t>(lower + whole);
  }
};

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
  static constexpr std::uint64_t fraction48(std::uint64_t n, std::uint64_t d) {
    return divide(n >> 16, n << 48, d).quotient;
  }
};
inline constexpr bool kHasHardwareDivide = true;
#else
using HardwareWords = NativeWords;
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

/// Way without a 128-bit integer, but with floating point.
using Portable = Way<PortableWords, DivideByDouble, RootByDouble>;
/// Nothing but 64-bit integers.
using IntegerOnly = Way<PortableWords, DivideByHalves, RootByInteger>;
/// The compiler's 128-bit integers throughout.
using Native = Way<NativeWords, DivideByNative, RootByDouble>;
/// The processor's own division.
using Hardware = Way<HardwareWords, DivideByHardware, RootByDouble>;

#if defined(SAMESTEP_FIXED_INTEGER_ONLY)
using Chosen = IntegerOnly;
#elif defined(SAMESTEP_FIXED_PORTABLE)
using Chosen = Portable;
#elif defined(__x86_64__) && defined(__GNUC__)
using Chosen = Hardware;
#elif defined(__SIZEOF_INT128__)
using Chosen = Way<NativeWords, DivideByDouble, RootByDouble>;
#elif defined(__SSE2__) || defined(__wasm__) || (defined(__ARM_FP) && (__ARM_FP & 8) != 0)
using Chosen = Portable;
#else
using Chosen = IntegerOnly;
#endif

}  // namespace samestep::way
