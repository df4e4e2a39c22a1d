#pragma once

#include <bit>
#include <cstdint>
#include <type_traits>

#include "samestep/way.h"

/// The algebra on raw bits, once for every way. Rounding is to nearest, ties to even, everywhere.
namespace samestep::raw {

/// x or -x without a branch.
constexpr std::int64_t negatedIf(bool negate, std::uint64_t x) {
  const std::uint64_t mask = 0 - static_cast<std::uint64_t>(negate);
  return static_cast<std::int64_t>((x ^ mask) - mask);
}

/// |x| as an unsigned number, also of the lowest.
constexpr std::uint64_t magnitude(std::int64_t x) {
  return static_cast<std::uint64_t>(negatedIf(x < 0, static_cast<std::uint64_t>(x)));
}

struct FromDouble {
  std::int64_t raw;
  bool fits;
};

/// value * 2^bits to nearest, from the bits of the double: no floating arithmetic that flags could change.
constexpr FromDouble fromDouble(double value, int bits, std::int64_t least, std::int64_t most) {
  // Emscripten's library has no std::bit_cast.
  const auto pattern = __builtin_bit_cast(std::uint64_t, value);
  const bool negative = pattern >> 63 != 0;
  const int biased = static_cast<int>(pattern >> 52 & 0x7ff);
  const std::uint64_t fraction = pattern & ((std::uint64_t{1} << 52) - 1);
  if (biased == 0x7ff && fraction != 0) return {0, false};
  const std::uint64_t mantissa = biased == 0 ? fraction : fraction | std::uint64_t{1} << 52;
  const int shift = (biased == 0 ? 1 : biased) - 1075 + bits;
  std::uint64_t size = 0;
  if (shift > 11) {
    if (mantissa != 0) return {negative ? least : most, false};
  } else if (shift >= 0) {
    size = mantissa << shift;
  } else if (shift >= -54) {
    const int down = -shift;
    const std::uint64_t floor = mantissa >> down;
    const std::uint64_t rest = mantissa - (floor << down);
    const std::uint64_t half = std::uint64_t{1} << (down - 1);
    size = floor + (rest > half || (rest == half && (floor & 1) != 0) ? 1 : 0);
  }
  const std::uint64_t limit = negative ? magnitude(least) : magnitude(most);
  if (size > limit) return {negative ? least : most, false};
  return {negatedIf(negative, size), true};
}

/// A sum of products of raw numbers, in units of 2^-2bits modulo 2^(64+bits) or more, rounded once.
template <class Way, int kBits>
using ProductSum = way::Sum<typename Way::Words, kBits>;

/// Sum without the modulus, to learn whether it fits.
template <int kBits>
class ExactSum {
 public:
  constexpr void plus(std::int64_t a, std::int64_t b) {
    const Halves product = way::PortableWords::multiplySigned(a, b);
    floors_ = floors_ + shiftedDown(product);
    rests_ += product.low & kMask;
  }
  constexpr void minus(std::int64_t a, std::int64_t b) {
    const Halves product = Halves{} - way::PortableWords::multiplySigned(a, b);
    floors_ = floors_ + shiftedDown(product);
    rests_ += product.low & kMask;
  }
  constexpr void plus(std::int64_t c) { floors_ = floors_ + extended(c); }

  /// True if the rounded sum lies in [least, most].
  constexpr bool fits(std::int64_t least, std::int64_t most) const {
    const Halves floor = floors_ + Halves{0, rests_ >> kBits};
    const std::uint64_t rest = rests_ & kMask;
    const std::uint64_t half = kBits == 0 ? 1 : (kMask >> 1) + 1;
    const bool up = rest > half || (rest == half && (floor.low & 1) != 0);
    const Halves rounded = floor + Halves{0, up ? 1u : 0u};
    return biased(rounded) >= biased(extended(least)) && biased(rounded) <= biased(extended(most));
  }

 private:
  static constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;

  static constexpr Halves extended(std::int64_t x) {
    return {static_cast<std::uint64_t>(x >> 63), static_cast<std::uint64_t>(x)};
  }
  static constexpr Halves shiftedDown(Halves x) {
    const Halves shifted = x >> kBits;
    const auto high = static_cast<std::uint64_t>(static_cast<std::int64_t>(x.high) >> kBits);
    return {high, shifted.low};
  }
  /// Order of two's complement as order of unsigned.
  static constexpr Halves biased(Halves x) { return {x.high ^ std::uint64_t{1} << 63, x.low}; }

  Halves floors_;
  std::uint64_t rests_ = 0;
};

struct Quotient {
  std::int64_t raw;
  bool fits;
};

/// high:low / divisor to nearest, ties to even, with a sign; saturates to [least, most].
template <class Way>
constexpr Quotient roundedQuotient(std::uint64_t high, std::uint64_t low, std::uint64_t divisor,
                                   bool negative, std::int64_t least, std::int64_t most) {
  // This is also taken where the divisor is 0. Guards the division from a quotient of more than 64 bits.
  if (high >= divisor) [[unlikely]] {
    if (divisor == 0 && high == 0 && low == 0) return {0, false};
    return {negative ? least : most, false};
  }
  const QuotientRemainder result = Way::Divide::divide(high, low, divisor);
  const std::uint64_t left = divisor - result.remainder;
  const std::uint64_t up = result.remainder + (result.quotient & 1) > left ? 1 : 0;
  const std::uint64_t limit = magnitude(negative ? least : most);
  if (result.quotient >= limit) [[unlikely]] {
    const bool fits = result.quotient == limit && up == 0;
    return {negative ? least : most, fits};
  }
  const std::uint64_t size = result.quotient + up;
  return {negatedIf(negative, size), true};
}

/// a 2^kShift / b by the division of 128 by 64 bits.
template <class Way, int kShift>
constexpr Quotient longDivide(std::int64_t a, std::int64_t b, std::int64_t least, std::int64_t most) {
  const std::uint64_t n = magnitude(a);
  // A shift above 64 is that of a reciprocal, where a is 1.
  constexpr int kAbove = kShift > 64 ? kShift - 64 : 0;
  constexpr int kBelow = kShift > 0 && kShift < 64 ? 64 - kShift : 0;
  const std::uint64_t high = kShift >= 64 ? n << kAbove : kShift == 0 ? 0 : n >> kBelow;
  const std::uint64_t low = kShift >= 64 ? 0 : n << kShift % 64;
  return roundedQuotient<Way>(high, low, magnitude(b), (a ^ b) < 0, least, most);
}

/// Divides where an estimate does not do; kept out of the way of the usual case.
template <class Way, int kShift>
[[gnu::noinline, gnu::cold]] constexpr Quotient farDivide(std::int64_t a, std::int64_t b, std::int64_t least,
                                                          std::int64_t most) {
  return longDivide<Way, kShift>(a, b, least, most);
}

/// a 2^kShift / b.
template <class Way, int kShift>
constexpr Quotient divide(std::int64_t a, std::int64_t b, std::int64_t least, std::int64_t most) {
  if constexpr (std::is_base_of_v<way::DivideByDouble, typename Way::Divide> && kShift <= 64) {
    constexpr double kScale =
        kShift == 64 ? 18446744073709551616.0 : static_cast<double>(std::uint64_t{1} << kShift % 64);
    const std::uint64_t d = magnitude(b);
    if (d - 1 < way::DivideByDouble::kMaxDivisor - 1 && !std::is_constant_evaluated()) {
      const double signedEstimate = way::nearDouble(a) * kScale / way::nearDouble(b);
      const double estimate = signedEstimate < 0 ? -signedEstimate : signedEstimate;
      if (estimate < way::DivideByDouble::kMaxQuotient) [[likely]] {
        // Only the low half of the numerator is needed.
        const std::uint64_t low = kShift == 64 ? 0 : magnitude(a) << kShift % 64;
        const std::uint64_t size = way::DivideByDouble::rounded(estimate, low, d);
        const bool negative = (a ^ b) < 0;
        if (size > magnitude(most)) [[unlikely]] {
          const bool fits = negative && size == magnitude(least);
          return {negative ? least : most, fits};
        }
        return {negatedIf(negative, size), true};
      }
    }
    return farDivide<Way, kShift>(a, b, least, most);
  } else {
    return longDivide<Way, kShift>(a, b, least, most);
  }
}

/// a b / c.
template <class Way>
constexpr Quotient mulDiv(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t least,
                          std::int64_t most) {
  using Words = typename Way::Words;
  const auto product = Words::multiply(magnitude(a), magnitude(b));
  return roundedQuotient<Way>(Words::high(product), Words::low(product), magnitude(c),
                              ((a < 0) != (b < 0)) != (c < 0), least, most);
}

/// sqrt(x / 2^kBits) in units of 2^-kBits; 0 for a negative x.
template <class Way, int kBits>
constexpr std::int64_t squareRoot(std::int64_t x) {
  if (x <= 0) return 0;
  return static_cast<std::int64_t>(Way::Root::template squareRoot<kBits>(x));
}

/// sqrt(x^2 + y^2); saturates to `most`.
template <class Way>
constexpr Quotient length(std::int64_t x, std::int64_t y, std::int64_t most) {
  if ((x | y) == 0) [[unlikely]]
    return {0, true};
  const std::uint64_t root = Way::Root::template length<typename Way::Words>(x, y);
  if (root > magnitude(most)) return {most, false};
  return {static_cast<std::int64_t>(root), true};
}

/// True if (2k+1)^2 square >= x^2 2^(2 bits + 2), that is if x 2^bits / sqrt(square) <= k + 1/2. 256-bit
/// numbers as four digits; never equal unless both are 0 (see normalizedComponent).
constexpr bool atMostHalfAbove(std::uint64_t k, Halves square, std::uint64_t x, int bits) {
  const auto add = [](std::uint64_t(&sum)[4], int at, std::uint64_t value) {
    for (; at < 4 && value != 0; ++at) {
      sum[at] += value;
      value = sum[at] < value ? 1 : 0;
    }
  };
  const auto addProduct = [&](std::uint64_t(&sum)[4], int at, std::uint64_t a, std::uint64_t b) {
    const Halves product = multiplyHalves(a, b);
    add(sum, at, product.low);
    add(sum, at + 1, product.high);
  };
  const std::uint64_t odd = 2 * k + 1;
  const Halves oddSquare = multiplyHalves(odd, odd);
  std::uint64_t left[4] = {};
  addProduct(left, 0, oddSquare.low, square.low);
  addProduct(left, 1, oddSquare.low, square.high);
  addProduct(left, 1, oddSquare.high, square.low);
  addProduct(left, 2, oddSquare.high, square.high);
  const Halves xSquare = multiplyHalves(x, x);
  const int shift = 2 * bits + 2;
  const int digits = shift / 64;
  std::uint64_t right[4] = {};
  const Halves low = Halves{0, xSquare.low} << shift % 64;
  const Halves high = Halves{0, xSquare.high} << shift % 64;
  add(right, digits, low.low);
  add(right, digits + 1, low.high);
  add(right, digits + 1, high.low);
  if (digits + 2 < 4) add(right, digits + 2, high.high);
  for (int i = 3; i > 0; --i) {
    if (left[i] != right[i]) return left[i] > right[i];
  }
  return left[0] >= right[0];
}

/// `above` or one less: whichever is nearer to |component| 2^bits / sqrt(x^2 + y^2), known to lie between.
[[gnu::noinline, gnu::cold]] constexpr std::uint64_t exactUnitComponent(std::uint64_t above, std::int64_t x,
                                                                        std::int64_t y,
                                                                        std::int64_t component, int bits) {
  const std::uint64_t xSize = magnitude(x), ySize = magnitude(y);
  const Halves square = multiplyHalves(xSize, xSize) + multiplyHalves(ySize, ySize);
  return atMostHalfAbove(above - 1, square, magnitude(component), bits) ? above - 1 : above;
}

/// x 2^bits / sqrt(square) to nearest, from an estimate with kGuardBits more bits. Next to a rounding
/// boundary the exact comparison decides. There is no tie: it would need an odd prime or a second factor 2
/// in the hypotenuse of a primitive Pythagorean triple to divide a leg.
constexpr std::uint64_t unitComponent(std::uint64_t estimate, std::int64_t x, std::int64_t y,
                                      std::int64_t component, int bits) {
  constexpr std::uint64_t kHalf = std::uint64_t{1} << (way::kGuardBits - 1);
  const std::uint64_t shifted = estimate + kHalf + way::kGuardMargin;
  const std::uint64_t above = shifted >> way::kGuardBits;
  if ((shifted & (2 * kHalf - 1)) >= 2 * way::kGuardMargin || above == 0) [[likely]]
    return above;
  return exactUnitComponent(above, x, y, component, bits);
}

struct RawComponents {
  std::int64_t x, y;

  friend constexpr bool operator==(RawComponents, RawComponents) = default;
};

/// (x, y) / length(x, y), each component to nearest; (0, 0) of (0, 0).
template <class Way, int kBits>
constexpr RawComponents normalize(std::int64_t x, std::int64_t y) {
  if ((x | y) == 0) [[unlikely]]
    return {0, 0};
  const way::UnitEstimate estimate = Way::Root::template unit<kBits>(x, y);
  const auto xUnit = static_cast<std::int64_t>(unitComponent(estimate.x, x, y, x, kBits));
  const auto yUnit = static_cast<std::int64_t>(unitComponent(estimate.y, x, y, y, kBits));
  return {x < 0 ? -xUnit : xUnit, y < 0 ? -yUnit : yUnit};
}

}  // namespace samestep::raw
