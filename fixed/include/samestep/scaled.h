#pragma once

#include <bit>
#include <compare>
#include <cstdint>

#include "samestep/fixed.h"
#include "samestep/wide.h"

namespace samestep {

/// A number of 63 significant bits and huge range, for masses, moments and their inverses: 1 / (1e9 kg m^2)
/// is 4 units of Fixed but exact to 63 bits here. The value is mantissa * 2^exponent, with |mantissa| in
/// [2^62, 2^63), or 0 with exponent 0: equal values have equal bits. Each operation rounds once, to nearest,
/// ties to even. x / 0 saturates and 0 / 0 is 0, as for S.
template <FixedNumber S>
class ScaledFixed {
 public:
  /// Beyond these a result saturates, or is 0. No product of a thousand numbers of S gets there.
  static constexpr std::int64_t kMaxExponent = std::int64_t{1} << 30;
  static constexpr std::int64_t kMinExponent = -kMaxExponent;

  /// Zero.
  constexpr ScaledFixed() = default;

  /// Exact.
  explicit constexpr ScaledFixed(S x)
      : ScaledFixed(rounded(x.raw() < 0, 0, raw::magnitude(x.raw()), -S::kBits)) {}

  /// Rounded once, to 63 bits.
  explicit constexpr ScaledFixed(WideFixed<S> x) {
    const Halves size = sign(x) < 0 ? Halves{0, 0} - Halves{x.high(), x.low()} : Halves{x.high(), x.low()};
    *this = rounded(sign(x) < 0, size.high, size.low, -2 * S::kBits);
  }

  /// The number with these parts, as mantissa() and exponent() gave them.
  /// @return zero where they are none that a ScaledFixed can have
  static constexpr ScaledFixed fromParts(std::int64_t mantissa, std::int64_t exponent) {
    return isValid(mantissa, exponent) ? ScaledFixed(mantissa, exponent) : ScaledFixed();
  }
  static constexpr bool isValid(std::int64_t mantissa, std::int64_t exponent) {
    if (mantissa == 0) return exponent == 0;
    return raw::magnitude(mantissa) >> 62 == 1 && exponent >= kMinExponent && exponent <= kMaxExponent;
  }
  constexpr std::int64_t mantissa() const { return mantissa_; }
  constexpr std::int64_t exponent() const { return exponent_; }

  static constexpr ScaledFixed max() { return saturated(false); }

  friend constexpr bool operator==(ScaledFixed, ScaledFixed) = default;
  friend constexpr std::strong_ordering operator<=>(ScaledFixed a, ScaledFixed b) {
    const int aSign = sign(a), bSign = sign(b);
    if (aSign != bSign || aSign == 0) return aSign <=> bSign;
    if (a.exponent_ != b.exponent_)
      return aSign > 0 ? a.exponent_ <=> b.exponent_ : b.exponent_ <=> a.exponent_;
    return a.mantissa_ <=> b.mantissa_;
  }
  /// -1, 0 or 1.
  friend constexpr int sign(ScaledFixed a) { return a.mantissa_ > 0 ? 1 : a.mantissa_ < 0 ? -1 : 0; }

  friend constexpr ScaledFixed operator-(ScaledFixed a) { return {-a.mantissa_, a.exponent_}; }
  friend constexpr ScaledFixed abs(ScaledFixed a) { return a.mantissa_ < 0 ? -a : a; }

  friend constexpr ScaledFixed operator+(ScaledFixed a, ScaledFixed b) {
    if (a.mantissa_ == 0) return b;
    if (b.mantissa_ == 0) return a;
    if (a.exponent_ < b.exponent_) return b + a;
    const std::int64_t apart = a.exponent_ - b.exponent_;
    const Halves large{raw::magnitude(a.mantissa_), 0};
    Halves small{raw::magnitude(b.mantissa_), 0};
    if (apart >= 127) {
      small = {0, 1};
    } else {
      // Bits shifted out are kept as one: far below the rounding position, only their presence counts.
      const Halves kept = small >> static_cast<int>(apart);
      const bool lost = (kept << static_cast<int>(apart)) != small;
      small = {kept.high, kept.low | (lost ? 1u : 0u)};
    }
    const bool aNegative = a.mantissa_ < 0;
    const bool sameSign = aNegative == (b.mantissa_ < 0);
    const bool smallIsLarger = !sameSign && small > large;
    const Halves sum = sameSign ? large + small : smallIsLarger ? small - large : large - small;
    return rounded(aNegative != smallIsLarger, sum.high, sum.low, a.exponent_ - 64);
  }
  friend constexpr ScaledFixed operator-(ScaledFixed a, ScaledFixed b) { return a + -b; }

  friend constexpr ScaledFixed operator*(ScaledFixed a, ScaledFixed b) {
    const auto product = Words::multiply(raw::magnitude(a.mantissa_), raw::magnitude(b.mantissa_));
    return rounded((a.mantissa_ < 0) != (b.mantissa_ < 0), Words::high(product), Words::low(product),
                   a.exponent_ + b.exponent_);
  }

  friend constexpr ScaledFixed operator/(ScaledFixed a, ScaledFixed b) {
    if (b.mantissa_ == 0) {
      if constexpr (S::kChecks) raw::report("scaledDivide", 0, {a.mantissa_, b.mantissa_});
      return a.mantissa_ == 0 ? ScaledFixed() : saturated(a.mantissa_ < 0);
    }
    const std::uint64_t n = raw::magnitude(a.mantissa_);
    const QuotientRemainder result =
        way::Chosen::Divide::divide(n >> 1, n << 63, raw::magnitude(b.mantissa_));
    // One more bit, and a remainder as one further bit, decide the rounding.
    const Halves digits = Halves{0, result.quotient} << 2;
    return rounded((a.mantissa_ < 0) != (b.mantissa_ < 0), digits.high,
                   digits.low | halfRemainder(result.remainder, raw::magnitude(b.mantissa_)),
                   a.exponent_ - b.exponent_ - 65);
  }
  friend constexpr ScaledFixed reciprocal(ScaledFixed a) { return one() / a; }

  constexpr ScaledFixed& operator+=(ScaledFixed b) { return *this = *this + b; }
  constexpr ScaledFixed& operator-=(ScaledFixed b) { return *this = *this - b; }
  constexpr ScaledFixed& operator*=(ScaledFixed b) { return *this = *this * b; }
  constexpr ScaledFixed& operator/=(ScaledFixed b) { return *this = *this / b; }

 private:
  using Words = way::Chosen::Words;

  constexpr ScaledFixed(std::int64_t mantissa, std::int64_t exponent)
      : mantissa_(mantissa), exponent_(exponent) {}

  static constexpr ScaledFixed one() { return {std::int64_t{1} << 62, -62}; }
  static constexpr ScaledFixed saturated(bool negative) {
    constexpr std::int64_t kMost = (~std::uint64_t{0} >> 1);
    return {negative ? -kMost : kMost, kMaxExponent};
  }

  /// 0 for nothing left, 1 below half of the divisor, 2 for half, 3 above.
  static constexpr std::uint64_t halfRemainder(std::uint64_t remainder, std::uint64_t divisor) {
    if (remainder == 0) return 0;
    const std::uint64_t left = divisor - remainder;
    return remainder < left ? 1 : remainder == left ? 2 : 3;
  }

  /// high:low * 2^exponent.
  static constexpr ScaledFixed rounded(bool negative, std::uint64_t high, std::uint64_t low,
                                       std::int64_t exponent) {
    if (high == 0 && low == 0) return {};
    const Halves value{high, low};
    const int zeros = high != 0 ? std::countl_zero(high) : 64 + std::countl_zero(low);
    // 128 bits with the top bit set; the upper 63 stay.
    const Halves top = value << zeros;
    std::uint64_t mantissa = top.high >> 1;
    std::int64_t scale = exponent - zeros + 65;
    const bool half = (top.high & 1) != 0;
    if (half && (top.low != 0 || (mantissa & 1) != 0)) ++mantissa;
    if (mantissa >> 63 != 0) {
      mantissa >>= 1;
      ++scale;
    }
    if (scale > kMaxExponent) {
      if constexpr (S::kChecks)
        raw::report("scaledOverflow", 0, {static_cast<std::int64_t>(mantissa), scale});
      return saturated(negative);
    }
    if (scale < kMinExponent) return {};
    const auto size = static_cast<std::int64_t>(mantissa);
    return {negative ? -size : size, scale};
  }

  std::int64_t mantissa_ = 0;
  std::int64_t exponent_ = 0;
};

template <FixedNumber S>
struct ScaledOf<S> {
  using type = ScaledFixed<S>;
};

/// Exact.
template <FixedNumber S>
constexpr ScaledFixed<S> toScaled(S x) {
  return ScaledFixed<S>(x);
}

/// Rounded once, to 63 bits.
template <FixedNumber S>
constexpr ScaledFixed<S> toScaled(WideFixed<S> x) {
  return ScaledFixed<S>(x);
}

/// Rounds to nearest, ties to even; saturates.
template <FixedNumber S>
constexpr S toScalar(ScaledFixed<S> x) {
  const std::int64_t shift = -S::kBits - x.exponent();
  const bool negative = x.mantissa() < 0;
  const std::uint64_t size = raw::magnitude(x.mantissa());
  const S limit = negative ? S::lowest() : S::max();
  std::uint64_t units = 0;
  bool fits = true;
  if (x.mantissa() == 0 || shift > 64) {
    return S();
  } else if (shift > 0) {
    // The shift is up to 64: everything may be shifted out, and half a unit is still a tie.
    const std::uint64_t floor = shift == 64 ? 0 : size >> shift;
    const std::uint64_t rest = shift == 64 ? size : size << (64 - shift) >> (64 - shift);
    const std::uint64_t half = std::uint64_t{1} << (shift - 1);
    units = floor + (rest > half || (rest == half && (floor & 1) != 0) ? 1 : 0);
  } else if (shift >= -1) {
    units = size << -shift;
  } else {
    fits = false;
  }
  fits = fits && units <= raw::magnitude(limit.raw());
  if constexpr (S::kChecks) {
    if (!fits) raw::report("toScalar", 0, {x.mantissa(), x.exponent()});
  }
  if (!fits) return limit;
  return S::fromRaw(static_cast<typename S::Raw>(negative ? 0 - units : units));
}

}  // namespace samestep
