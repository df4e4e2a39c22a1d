#pragma once

#include <compare>
#include <cstdint>

#include "samestep/fixed.h"

namespace samestep {

/// An exact sum of products of two S, held in 128 bits at twice S's fraction bits. For decisions: the sign of
/// an area, the order of two projections. Exact as long as no sum leaves 2^127 units; for Fixed that is any
/// two products of differences below 2^30 m. Beyond, it wraps (reported for checked numbers).
template <FixedNumber S, class Words = way::Chosen::Words>
class WideFixed {
 public:
  /// Zero.
  constexpr WideFixed() = default;

  static constexpr WideFixed fromProduct(S a, S b) {
    return WideFixed(Words::multiplySigned(a.raw(), b.raw()));
  }
  static constexpr WideFixed fromHalves(std::uint64_t high, std::uint64_t low) {
    return WideFixed(Words::make(high, low));
  }
  /// The two halves of the two's complement, in units of 2^-2kBits.
  constexpr std::uint64_t high() const { return Words::high(bits_); }
  constexpr std::uint64_t low() const { return Words::low(bits_); }

  friend constexpr bool operator==(WideFixed a, WideFixed b) { return a.bits_ == b.bits_; }
  friend constexpr std::strong_ordering operator<=>(WideFixed a, WideFixed b) {
    const auto order = static_cast<std::int64_t>(a.high()) <=> static_cast<std::int64_t>(b.high());
    return order != 0 ? order : a.low() <=> b.low();
  }

  friend constexpr WideFixed operator+(WideFixed a, WideFixed b) {
    const WideFixed sum(a.bits_ + b.bits_);
    if constexpr (S::kChecks) {
      if (sign(a) == sign(b) && sign(a) != 0 && sign(sum) != sign(a)) reportTop("wideAdd", a, b);
    }
    return sum;
  }
  friend constexpr WideFixed operator-(WideFixed a) { return WideFixed(Words::make(0, 0) - a.bits_); }
  friend constexpr WideFixed operator-(WideFixed a, WideFixed b) {
    const WideFixed difference(a.bits_ - b.bits_);
    if constexpr (S::kChecks) {
      if (sign(a) * sign(b) < 0 && sign(difference) != sign(a)) reportTop("wideSubtract", a, b);
    }
    return difference;
  }
  constexpr WideFixed& operator+=(WideFixed b) { return *this = *this + b; }
  constexpr WideFixed& operator-=(WideFixed b) { return *this = *this - b; }

  /// Times 2^by, by in 0 to 127; high bits are lost.
  friend constexpr WideFixed operator<<(WideFixed a, int by) { return WideFixed(a.bits_ << by); }
  /// Divided by 2^by toward minus infinity, by in 0 to 127.
  friend constexpr WideFixed operator>>(WideFixed a, int by) {
    // The complement of a negative number is not negative, so that a logical shift serves both.
    const auto ones = static_cast<std::int64_t>(a.high()) < 0 ? ~std::uint64_t{0} : std::uint64_t{0};
    const auto shifted = Words::make(a.high() ^ ones, a.low() ^ ones) >> by;
    return fromHalves(Words::high(shifted) ^ ones, Words::low(shifted) ^ ones);
  }

  /// -1, 0 or 1.
  friend constexpr int sign(WideFixed a) {
    if (static_cast<std::int64_t>(a.high()) < 0) return -1;
    return (a.high() | a.low()) != 0 ? 1 : 0;
  }

  /// The value to nearest, ties to even; wraps like a sum of products.
  friend constexpr S toScalar(WideFixed a) {
    constexpr int kShift = S::kBits;
    const WideFixed floor = a >> kShift;
    const std::uint64_t mask = (std::uint64_t{1} << kShift) - 1;
    const std::uint64_t rest = a.low() & mask;
    const std::uint64_t half = kShift == 0 ? 1 : (mask >> 1) + 1;
    const std::uint64_t up = rest > half || (rest == half && (floor.low() & 1) != 0) ? 1 : 0;
    const WideFixed rounded = floor + fromHalves(0, up);
    const S result = S::fromRaw(static_cast<typename S::Raw>(rounded.low()));
    if constexpr (S::kChecks) {
      const std::int64_t kept = result.raw();
      if (rounded != fromHalves(static_cast<std::uint64_t>(kept >> 63), static_cast<std::uint64_t>(kept))) {
        raw::report("toScalar", 0,
                    {static_cast<std::int64_t>(rounded.high()), static_cast<std::int64_t>(rounded.low())});
      }
    }
    return result;
  }

 private:
  explicit constexpr WideFixed(typename Words::U128 bits) : bits_(bits) {}

  static void reportTop(const char* operation, WideFixed a, WideFixed b) {
    raw::report(operation, 0, {static_cast<std::int64_t>(a.high()), static_cast<std::int64_t>(b.high())});
  }

  typename Words::U128 bits_ = {};
};

template <FixedNumber S>
struct WideOf<S> {
  using type = WideFixed<S>;
};

/// a b, exactly.
template <FixedNumber S>
constexpr WideFixed<S> exactProduct(S a, S b) {
  return WideFixed<S>::fromProduct(a, b);
}
/// a b + c d, exactly.
template <FixedNumber S>
constexpr WideFixed<S> exactDot(S a, S b, S c, S d) {
  return exactProduct(a, b) + exactProduct(c, d);
}
/// a b - c d, exactly.
template <FixedNumber S>
constexpr WideFixed<S> exactCross(S a, S b, S c, S d) {
  return exactProduct(a, b) - exactProduct(c, d);
}

}  // namespace samestep
