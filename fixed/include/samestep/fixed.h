#pragma once

#include <bit>
#include <compare>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <typeindex>  // The smallest header with std::hash.
#include <utility>

#include "samestep/expects.h"
#include "samestep/fixed_checked.h"
#include "samestep/raw_algebra.h"
#include "samestep/scalar_results.h"

namespace samestep {

/// A binary fixed-point number: an integer of type Rep in units of 2^-kFractionBits.
///
/// Results of + - and unary minus are exact; those of * / and of the functions below are the exact result
/// rounded once to nearest, ties to even. Where a result does not fit: sums and products wrap modulo the
/// size of Rep, quotients and conversions saturate, x / 0 is the largest or lowest value by the sign of x,
/// and 0 / 0 is 0. With Overflow = Checked each of these is reported first; see fixed_checked.h.
/// Everything is constexpr, and the same bits on every machine.
template <class Rep, int kFractionBits, class Overflow>
class BasicFixed {
  static_assert(std::signed_integral<Rep> && sizeof(Rep) <= 8);
  static_assert(kFractionBits >= 0 && kFractionBits <= 62 &&
                kFractionBits < 8 * static_cast<int>(sizeof(Rep)));

 public:
  using Raw = Rep;
  using OverflowPolicy = Overflow;
  static constexpr int kBits = kFractionBits;
  static constexpr bool kChecks = Overflow::kChecks;

  /// Zero.
  constexpr BasicFixed() = default;

  /// The integer itself; saturates.
  template <std::integral I>
  requires(!std::same_as<I, bool>) explicit constexpr BasicFixed(I value) {
    constexpr std::int64_t kMost = kMaxRaw >> kFractionBits;
    constexpr std::int64_t kLeast = kMinRaw >> kFractionBits;
    const bool above = std::cmp_greater(value, kMost);
    const bool below = std::cmp_less(value, kLeast);
    if constexpr (kChecks) {
      if (above || below) raw::report("fromInteger", 0, {static_cast<std::int64_t>(value)});
    }
    raw_ = above   ? static_cast<Rep>(kMaxRaw)
           : below ? static_cast<Rep>(kMinRaw)
                   : static_cast<Rep>(static_cast<std::uint64_t>(value) << kFractionBits);
  }

  /// The nearest value, ties to even; saturates; NaN gives 0.
  explicit constexpr BasicFixed(double value) {
    const raw::FromDouble read = raw::fromDouble(value, kFractionBits, kMinRaw, kMaxRaw);
    if constexpr (kChecks) {
      if (!read.fits) raw::report("fromDouble", kFractionBits, {read.raw});
    }
    raw_ = static_cast<Rep>(read.raw);
  }

  /// The back door to the representation, with raw(): the value is bits / 2^kFractionBits.
  static constexpr BasicFixed fromRaw(Rep bits) {
    BasicFixed result;
    result.raw_ = bits;
    return result;
  }
  constexpr Rep raw() const { return raw_; }

  /// The value nearest to numerator / denominator; saturates like a quotient.
  static constexpr BasicFixed ratio(std::int64_t numerator, std::int64_t denominator) {
    const raw::Quotient result =
        raw::divide<way::Chosen, kFractionBits>(numerator, denominator, kMinRaw, kMaxRaw);
    if constexpr (kChecks) {
      if (!result.fits) raw::report("ratio", 0, {numerator, denominator});
    }
    return fromRaw(static_cast<Rep>(result.raw));
  }

  static constexpr BasicFixed max() { return fromRaw(static_cast<Rep>(kMaxRaw)); }
  static constexpr BasicFixed lowest() { return fromRaw(static_cast<Rep>(kMinRaw)); }
  /// One unit of the last place.
  static constexpr BasicFixed epsilon() { return fromRaw(Rep{1}); }

  /// Exact up to 53 significant bits, then to nearest.
  explicit constexpr operator double() const {
    return static_cast<double>(raw_) / static_cast<double>(std::uint64_t{1} << kFractionBits);
  }
  /// Rounds toward zero, modulo 2^32.
  explicit constexpr operator int() const {
    const std::int64_t wide = raw_;
    const auto size = wide < 0 ? 0 - static_cast<std::uint64_t>(wide) : static_cast<std::uint64_t>(wide);
    const std::uint64_t whole = size >> kFractionBits;
    return static_cast<int>(static_cast<std::int64_t>(wide < 0 ? 0 - whole : whole));
  }

  friend constexpr bool operator==(BasicFixed, BasicFixed) = default;
  friend constexpr auto operator<=>(BasicFixed, BasicFixed) = default;

  friend constexpr BasicFixed operator+(BasicFixed a, BasicFixed b) {
    const auto sum = wrap(static_cast<std::uint64_t>(a.raw_) + static_cast<std::uint64_t>(b.raw_));
    if constexpr (kChecks) {
      if ((b.raw_ < 0) != (sum.raw_ < a.raw_)) raw::report("add", kFractionBits, {a.raw_, b.raw_});
    }
    return sum;
  }
  friend constexpr BasicFixed operator-(BasicFixed a, BasicFixed b) {
    const auto difference = wrap(static_cast<std::uint64_t>(a.raw_) - static_cast<std::uint64_t>(b.raw_));
    if constexpr (kChecks) {
      if ((b.raw_ > 0) != (difference.raw_ < a.raw_))
        raw::report("subtract", kFractionBits, {a.raw_, b.raw_});
    }
    return difference;
  }
  friend constexpr BasicFixed operator-(BasicFixed a) {
    if constexpr (kChecks) {
      if (a == lowest()) raw::report("negate", kFractionBits, {a.raw_});
    }
    return wrap(0 - static_cast<std::uint64_t>(a.raw_));
  }
  friend constexpr BasicFixed operator*(BasicFixed a, BasicFixed b) {
    return rounded<false>("multiply", 0, a.raw_, b.raw_);
  }
  friend constexpr BasicFixed operator/(BasicFixed a, BasicFixed b) {
    const raw::Quotient result = raw::divide<way::Chosen, kFractionBits>(a.raw_, b.raw_, kMinRaw, kMaxRaw);
    if constexpr (kChecks) {
      if (!result.fits) raw::report("divide", kFractionBits, {a.raw_, b.raw_});
    }
    return fromRaw(static_cast<Rep>(result.raw));
  }
  constexpr BasicFixed& operator+=(BasicFixed b) { return *this = *this + b; }
  constexpr BasicFixed& operator-=(BasicFixed b) { return *this = *this - b; }
  constexpr BasicFixed& operator*=(BasicFixed b) { return *this = *this * b; }
  constexpr BasicFixed& operator/=(BasicFixed b) { return *this = *this / b; }

  /// a b + c, rounded once.
  friend constexpr BasicFixed mulAdd(BasicFixed a, BasicFixed b, BasicFixed c) {
    return rounded<true>("mulAdd", c.raw_, a.raw_, b.raw_);
  }
  /// a b + c d, rounded once.
  friend constexpr BasicFixed dot(BasicFixed a, BasicFixed b, BasicFixed c, BasicFixed d) {
    return rounded<false>("dot", 0, a.raw_, b.raw_, c.raw_, d.raw_);
  }
  /// a b - c d, rounded once.
  friend constexpr BasicFixed cross(BasicFixed a, BasicFixed b, BasicFixed c, BasicFixed d) {
    raw::ProductSum<way::Chosen, kFractionBits> sum;
    sum.plus(a.raw_, b.raw_);
    sum.minus(c.raw_, d.raw_);
    if constexpr (kChecks) {
      raw::ExactSum<kFractionBits> exact;
      exact.plus(a.raw_, b.raw_);
      exact.minus(c.raw_, d.raw_);
      if (!exact.fits(kMinRaw, kMaxRaw)) {
        raw::report("cross", kFractionBits, {a.raw_, b.raw_, c.raw_, d.raw_});
      }
    }
    return wrap(static_cast<std::uint64_t>(sum.rounded()));
  }
  /// a0 b0 + a1 b1 + a2 b2, rounded once.
  friend constexpr BasicFixed dot3(BasicFixed a0, BasicFixed b0, BasicFixed a1, BasicFixed b1, BasicFixed a2,
                                   BasicFixed b2) {
    return rounded<false>("dot3", 0, a0.raw_, b0.raw_, a1.raw_, b1.raw_, a2.raw_, b2.raw_);
  }
  /// a0 b0 + a1 b1 + a2 b2 + a3 b3, rounded once.
  friend constexpr BasicFixed dot4(BasicFixed a0, BasicFixed b0, BasicFixed a1, BasicFixed b1, BasicFixed a2,
                                   BasicFixed b2, BasicFixed a3, BasicFixed b3) {
    return rounded<false>("dot4", 0, a0.raw_, b0.raw_, a1.raw_, b1.raw_, a2.raw_, b2.raw_, a3.raw_, b3.raw_);
  }
  /// a b / c, rounded once; saturates like a quotient.
  friend constexpr BasicFixed mulDiv(BasicFixed a, BasicFixed b, BasicFixed c) {
    const raw::Quotient result = raw::mulDiv<way::Chosen>(a.raw_, b.raw_, c.raw_, kMinRaw, kMaxRaw);
    if constexpr (kChecks) {
      if (!result.fits) raw::report("mulDiv", kFractionBits, {a.raw_, b.raw_, c.raw_});
    }
    return fromRaw(static_cast<Rep>(result.raw));
  }
  /// Remainder of a after taking away whole multiples of b, toward zero: exact, smaller in size than b, with
  /// the sign of a; 0 for b = 0.
  friend constexpr BasicFixed remainder(BasicFixed a, BasicFixed b) {
    if constexpr (kChecks) {
      if (b.raw_ == 0) raw::report("remainder", kFractionBits, {a.raw_, b.raw_});
    }
    // The lowest value by -1 unit has a quotient that does not fit.
    if (b.raw_ == 0 || b.raw_ == -1) return BasicFixed();
    return fromRaw(static_cast<Rep>(a.raw_ % b.raw_));
  }
  /// 1 / x, rounded once; saturates like a quotient, and 1 / 0 is the largest value.
  friend constexpr BasicFixed reciprocal(BasicFixed x) {
    const raw::Quotient result = raw::divide<way::Chosen, 2 * kFractionBits>(1, x.raw_, kMinRaw, kMaxRaw);
    if constexpr (kChecks) {
      if (!result.fits) raw::report("reciprocal", kFractionBits, {x.raw_});
    }
    return fromRaw(static_cast<Rep>(result.raw));
  }

  friend constexpr BasicFixed abs(BasicFixed x) { return x.raw_ < 0 ? -x : x; }
  friend constexpr BasicFixed min(BasicFixed a, BasicFixed b) { return b < a ? b : a; }
  friend constexpr BasicFixed max(BasicFixed a, BasicFixed b) { return a < b ? b : a; }
  /// x held within [low, high].
  friend constexpr BasicFixed clamp(BasicFixed x, BasicFixed low, BasicFixed high) {
    expects(low <= high);
    return x < low ? low : high < x ? high : x;
  }
  /// There is no infinity and no NaN.
  friend constexpr bool isFinite(BasicFixed) { return true; }

 private:
  static constexpr std::int64_t kMaxRaw = std::numeric_limits<Rep>::max();
  static constexpr std::int64_t kMinRaw = std::numeric_limits<Rep>::min();

  static constexpr BasicFixed wrap(std::uint64_t bits) { return fromRaw(static_cast<Rep>(bits)); }

  template <class Total, class... Rest>
  static constexpr void addProducts(Total& total, std::int64_t a, std::int64_t b, Rest... rest) {
    total.plus(a, b);
    if constexpr (sizeof...(rest) > 0) addProducts(total, rest...);
  }

  /// The sum of the addend and the products of the factors taken two by two, rounded once.
  template <bool kHasAddend, class... Factors>
  static constexpr BasicFixed rounded(const char* operation, std::int64_t addend, Factors... factors) {
    raw::ProductSum<way::Chosen, kFractionBits> sum;
    addProducts(sum, factors...);
    sum.plus(addend);
    if constexpr (kChecks) {
      raw::ExactSum<kFractionBits> exact;
      addProducts(exact, factors...);
      exact.plus(addend);
      if (!exact.fits(kMinRaw, kMaxRaw)) {
        if constexpr (kHasAddend) {
          raw::report(operation, kFractionBits, {factors..., addend});
        } else {
          raw::report(operation, kFractionBits, {factors...});
        }
      }
    }
    return wrap(static_cast<std::uint64_t>(sum.rounded()));
  }

  Rep raw_ = 0;
};

/// The number of the engine: Q32.32, range +-2^31, unit 2^-32.
using Fixed = BasicFixed<std::int64_t, 32, Wrapping>;
/// Number with every overflow reported.
using CheckedFixed = BasicFixed<std::int64_t, 32, Checked>;

template <class T>
inline constexpr bool kIsFixed = false;
template <class Rep, int kFractionBits, class Overflow>
inline constexpr bool kIsFixed<BasicFixed<Rep, kFractionBits, Overflow>> = true;

/// Any BasicFixed.
template <class T>
concept FixedNumber = kIsFixed<T>;

}  // namespace samestep

template <class Rep, int kFractionBits, class Overflow>
class std::numeric_limits<samestep::BasicFixed<Rep, kFractionBits, Overflow>> {
  using S = samestep::BasicFixed<Rep, kFractionBits, Overflow>;

 public:
  static constexpr bool is_specialized = true;
  static constexpr bool is_signed = true;
  static constexpr bool is_integer = false;
  static constexpr bool is_exact = true;
  static constexpr bool has_infinity = false;
  static constexpr bool has_quiet_NaN = false;
  static constexpr bool has_signaling_NaN = false;
  static constexpr bool is_iec559 = false;
  static constexpr bool is_bounded = true;
  static constexpr bool is_modulo = !S::kChecks;
  static constexpr bool traps = false;
  static constexpr std::float_round_style round_style = std::round_to_nearest;
  static constexpr int radix = 2;
  static constexpr int digits = std::numeric_limits<Rep>::digits;
  static constexpr int digits10 = std::numeric_limits<Rep>::digits10;
  static constexpr S min() { return S::epsilon(); }
  static constexpr S max() { return S::max(); }
  static constexpr S lowest() { return S::lowest(); }
  static constexpr S epsilon() { return S::epsilon(); }
  static constexpr S round_error() { return S::fromRaw(static_cast<Rep>(Rep{1} << (kFractionBits - 1))); }
};

template <class Rep, int kFractionBits, class Overflow>
// not in results: for containers of a game's own, nothing here asks for it.
struct std::hash<samestep::BasicFixed<Rep, kFractionBits, Overflow>> {
  std::size_t operator()(samestep::BasicFixed<Rep, kFractionBits, Overflow> x) const noexcept {
    return std::hash<Rep>{}(x.raw());  // not in results: see above
  }
};
