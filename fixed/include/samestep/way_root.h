#pragma once

#include <bit>
#include <cstdint>
#include <type_traits>

#include "samestep/expects.h"
#include "samestep/halves.h"
#include "samestep/near_double.h"

/// Square roots, lengths and directions: from integers alone, or from an estimate in double.
namespace samestep::way {

/// The distance from a rounding boundary below which an estimated component of a unit vector is decided
/// exactly, in units of 2^-kGuardBits of the last place. The estimates are off by less than 8.
inline constexpr int kGuardBits = 20;
inline constexpr std::uint64_t kGuardMargin = 64;

/// Estimates of |x| / length and |y| / length with kGuardBits more bits than the result.
struct UnitEstimate {
  std::uint64_t x, y;
};

/// Square roots without floating point.
struct RootByInteger {
  /// The largest integer whose square is at most high:low, by halving the problem (P. Zimmermann, Karatsuba
  /// Square Root, 1999).
  static constexpr std::uint64_t floorRoot(std::uint64_t high, std::uint64_t low) {
    if (high == 0 && low == 0) return 0;
    const int zeros = high != 0 ? std::countl_zero(high) : 64 + std::countl_zero(low);
    const Halves n = Halves{high, low} << (zeros & ~1);
    const Root upper = root64(n.high);
    // One bit less than the dividend's 65 makes it fit.
    const std::uint64_t dividend = upper.rest << 31 | n.low >> 33;
    const std::uint64_t quotient = dividend / upper.root;
    const std::uint64_t left = dividend % upper.root << 1 | (n.low >> 32 & 1);
    std::uint64_t root = (upper.root << 32) + quotient;
    const Halves rest =
        Halves{left >> 32, left << 32 | (n.low & 0xffffffff)} - multiplyHalves(quotient, quotient);
    if (rest.high >> 63 != 0) --root;
    return root >> zeros / 2;
  }

  /// The root of high:low to nearest; never a tie.
  static constexpr std::uint64_t roundedRoot(std::uint64_t high, std::uint64_t low) {
    const std::uint64_t root = floorRoot(high, low);
    const Halves rest = Halves{high, low} - multiplyHalves(root, root);
    return root + (rest > Halves{0, root} ? 1 : 0);
  }

  /// sqrt(x 2^kBits) to nearest, x > 0.
  template <int kBits>
  static constexpr std::uint64_t squareRoot(std::int64_t x) {
    const Halves n = Halves{0, static_cast<std::uint64_t>(x)} << kBits;
    return roundedRoot(n.high, n.low);
  }

  /// sqrt(x^2 + y^2) to nearest, not both 0.
  template <class Words>
  static constexpr std::uint64_t length(std::int64_t x, std::int64_t y) {
    const auto square = Words::multiplySigned(x, x) + Words::multiplySigned(y, y);
    return roundedRoot(Words::high(square), Words::low(square));
  }

  /// The direction of (x, y), not both 0.
  template <int kBits>
  static constexpr UnitEstimate unit(std::int64_t x, std::int64_t y) {
    expects((x | y) != 0);
    // At 62 bits the root of the sum of squares has 63, and its error does not count.
    const auto size = [](std::int64_t v) {
      return v < 0 ? 0 - static_cast<std::uint64_t>(v) : static_cast<std::uint64_t>(v);
    };
    const int zeros = std::countl_zero(size(x) | size(y));
    const std::uint64_t xScaled = size(x) << zeros >> 2, yScaled = size(y) << zeros >> 2;
    const Halves square = multiplyHalves(xScaled, xScaled) + multiplyHalves(yScaled, yScaled);
    const std::uint64_t root = floorRoot(square.high, square.low);
    const auto component = [&](std::uint64_t v) {
      const Halves scaled = Halves{0, v} << (kBits + kGuardBits);
      return v >= root ? std::uint64_t{1} << (kBits + kGuardBits) : divideHalves(scaled, root).quotient;
    };
    return {component(xScaled), component(yScaled)};
  }

 private:
  struct Root {
    std::uint64_t root, rest;
  };
  static constexpr Root root32(std::uint64_t n) {
    expects(n >= std::uint64_t{1} << 30);
    std::uint64_t root = 0, rest = 0;
    for (int shift = 30; shift >= 0; shift -= 2) {
      rest = rest << 2 | (n >> shift & 3);
      const std::uint64_t trial = root << 2 | 1;
      root <<= 1;
      if (rest >= trial) {
        rest -= trial;
        root |= 1;
      }
    }
    return {root, rest};
  }
  static constexpr Root root64(std::uint64_t n) {
    expects(n >= std::uint64_t{1} << 62);
    const Root upper = root32(n >> 32);
    const std::uint64_t dividend = upper.rest << 16 | (n >> 16 & 0xffff);
    const std::uint64_t quotient = dividend / (2 * upper.root), left = dividend % (2 * upper.root);
    std::uint64_t root = (upper.root << 16) + quotient;
    auto rest =
        static_cast<std::int64_t>(left << 16 | (n & 0xffff)) - static_cast<std::int64_t>(quotient * quotient);
    if (rest < 0) {
      rest += static_cast<std::int64_t>(2 * root - 1);
      --root;
    }
    return {root, static_cast<std::uint64_t>(rest)};
  }
};

/// Square roots from a double estimate, made exact by integers. The estimate is only required to be within
/// a quarter of a unit, which leaves a factor of two and more for rounding modes and contraction.
struct RootByDouble {
  /// sqrt(x 2^kBits) to nearest, x > 0.
  template <int kBits>
  static constexpr std::uint64_t squareRoot(std::int64_t x) {
    if (kBits > 32 || std::is_constant_evaluated()) return RootByInteger::squareRoot<kBits>(x);
    constexpr double kScale = static_cast<double>(std::uint64_t{1} << kBits);
    const auto root = static_cast<std::int64_t>(__builtin_sqrt(nearDouble(x) * kScale) + 0.5);
    return corrected(root, (static_cast<std::uint64_t>(x) << kBits));
  }

  /// sqrt(x^2 + y^2) to nearest, not both 0.
  template <class Words>
  static constexpr std::uint64_t length(std::int64_t x, std::int64_t y) {
    if (!std::is_constant_evaluated()) {
      const double xd = nearDouble(x), yd = nearDouble(y);
      const double estimate = __builtin_sqrt(xd * xd + yd * yd) + 0.5;
      if (estimate < 281474976710656.0) [[likely]] {  // 2^48
        const auto xBits = static_cast<std::uint64_t>(x), yBits = static_cast<std::uint64_t>(y);
        return corrected(static_cast<std::int64_t>(estimate), xBits * xBits + yBits * yBits);
      }
    }
    return farLength<Words>(x, y);
  }

  /// The direction of (x, y), not both 0.
  template <int kBits>
  static constexpr UnitEstimate unit(std::int64_t x, std::int64_t y) {
    expects((x | y) != 0);
    if (kBits > 32 || std::is_constant_evaluated()) return RootByInteger::unit<kBits>(x, y);
    constexpr double kScale = static_cast<double>(std::uint64_t{1} << (kBits + kGuardBits));
    const double xd = nearDouble(x), yd = nearDouble(y);
    const double inverse = kScale / __builtin_sqrt(xd * xd + yd * yd);
    const auto component = [&](double v) {
      const auto scaled = static_cast<std::int64_t>(v * inverse);
      return static_cast<std::uint64_t>(scaled < 0 ? -scaled : scaled);
    };
    return {component(xd), component(yd)};
  }

 private:
  /// Beyond what the estimate can do; kept out of the way of the usual case.
  template <class Words>
  [[gnu::noinline, gnu::cold]] static constexpr std::uint64_t farLength(std::int64_t x, std::int64_t y) {
    return RootByInteger::length<Words>(x, y);
  }

  /// The integer nearest to sqrt(n) from one at most one off, below 2^48, and the low half of n.
  static constexpr std::uint64_t corrected(std::int64_t root, std::uint64_t low) {
    const auto rest =
        static_cast<std::int64_t>(low - static_cast<std::uint64_t>(root) * static_cast<std::uint64_t>(root));
    return static_cast<std::uint64_t>(root + (rest > root ? 1 : 0) - (rest <= -root ? 1 : 0));
  }
};

}  // namespace samestep::way
