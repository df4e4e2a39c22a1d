#pragma once

#include <cstdint>

/// Plain answers for small analogues of the fixed-point number, where everything fits in 64 bits.
namespace samestep {

/// n / d to nearest, ties to even; d not 0.
constexpr std::int64_t roundedQuotientOf(std::int64_t n, std::int64_t d) {
  if (d < 0) return roundedQuotientOf(-n, -d);
  std::int64_t floor = n / d;
  if (floor * d > n) --floor;
  const std::int64_t twice = 2 * (n - floor * d);
  return floor + (twice > d || (twice == d && floor % 2 != 0) ? 1 : 0);
}

/// Quotient held in [least, most]; n / 0 is the end on n's side, and 0 / 0 is 0.
constexpr std::int64_t saturatedQuotientOf(std::int64_t n, std::int64_t d, std::int64_t least,
                                           std::int64_t most) {
  if (d == 0) return n == 0 ? 0 : n < 0 ? least : most;
  const std::int64_t quotient = roundedQuotientOf(n, d);
  return quotient < least ? least : quotient > most ? most : quotient;
}

/// True if root is the integer nearest to sqrt(square).
constexpr bool isNearestRoot(std::int64_t root, std::int64_t square) {
  return root >= 0 && root * root - root < square + (root == 0 ? 1 : 0) && square <= root * root + root;
}

/// True if unit is the integer nearest to scale x / sqrt(x^2 + y^2).
constexpr bool isNearestComponent(std::int64_t unit, std::int64_t x, std::int64_t y, std::int64_t scale) {
  if ((unit < 0) != (x < 0) && unit != 0) return false;
  const std::int64_t size = unit < 0 ? -unit : unit;
  const std::int64_t square = x * x + y * y;
  const std::int64_t twiceSquared = 4 * scale * scale * x * x;
  const std::int64_t below = 2 * size - 1, above = 2 * size + 1;
  return (size == 0 || below * below * square <= twiceSquared) && twiceSquared <= above * above * square;
}

}  // namespace samestep
