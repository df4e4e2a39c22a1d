// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <limits>

#include "samestep/fixed.h"
#include "samestep/fixed_math.h"
#include "samestep/local.h"
#include "samestep/scalar_results.h"
#include "samestep/scaled.h"
#include "samestep/wide.h"

/// The functions of layer 0 on double, and by inclusion those on fixed-point numbers: they have the same
/// names, so that everything above is written once. On double each is one fixed sequence of IEEE-754
/// operations: the same bits from every compiler that neither contracts nor reorders them. The short ones are
/// inlined without exception, so that no client's copy can take the place of the library's at link time; the
/// long ones live in the library.
///
/// Outside their domain they follow IEEE-754 (infinities, one quiet NaN of fixed bits); the engine never
/// calls them there.
namespace samestep {

/// a * b + c. Two roundings on double, one on Fixed.
[[gnu::always_inline]] constexpr double mulAdd(double a, double b, double c) { return a * b + c; }

/// a * b + c * d.
[[gnu::always_inline]] constexpr double dot(double a, double b, double c, double d) { return a * b + c * d; }

/// a * b - c * d.
[[gnu::always_inline]] constexpr double cross(double a, double b, double c, double d) {
  return a * b - c * d;
}

/// a0 * b0 + a1 * b1 + a2 * b2, from left to right.
[[gnu::always_inline]] constexpr double dot3(double a0, double b0, double a1, double b1, double a2,
                                             double b2) {
  return a0 * b0 + a1 * b1 + a2 * b2;
}

/// a0 * b0 + a1 * b1 + a2 * b2 + a3 * b3, from left to right.
[[gnu::always_inline]] constexpr double dot4(double a0, double b0, double a1, double b1, double a2, double b2,
                                             double a3, double b3) {
  return a0 * b0 + a1 * b1 + a2 * b2 + a3 * b3;
}

/// a * b / c.
[[gnu::always_inline]] constexpr double mulDiv(double a, double b, double c) { return a * b / c; }

/// Remainder of x after taking away whole multiples of y, toward zero: smaller in size than y, with the sign
/// of x. Exact: y is doubled up to the size of x and taken away on the way back, and every step of that is
/// exact. Takes one pass per binary digit of x / y.
[[gnu::always_inline]] constexpr double remainder(double x, double y) {
  const bool domain = x - x == 0.0 && (y < 0.0 || y > 0.0);
  if (!domain) return std::numeric_limits<double>::quiet_NaN();
  const double size = y < 0.0 ? -y : y;
  double left = x < 0.0 ? -x : x;
  if (left < size) return x;
  double part = size;
  while (part <= left - part) part += part;
  for (; part >= size; part *= 0.5) {
    if (left >= part) left -= part;
    if (part == size) break;
  }
  return x < 0.0 ? -left : left;
}

/// 1 / x.
[[gnu::always_inline]] constexpr double reciprocal(double x) { return 1.0 / x; }

/// The square root, correctly rounded; 0 for a negative x.
[[gnu::always_inline]] inline double sqrt(double x) { return x < 0.0 ? 0.0 : __builtin_sqrt(x); }

/// Neither infinite nor NaN.
[[gnu::always_inline]] constexpr bool isFinite(double x) {
  return x >= -0x1.fffffffffffffp+1023 && x <= 0x1.fffffffffffffp+1023;
}

/// The absolute value: -x where x < 0, else x itself (so -0 stays).
template <class S>
[[gnu::always_inline]] constexpr S abs(S x) {
  return x < S(0) ? -x : x;
}

/// The lesser; a where they are equal.
template <class S>
[[gnu::always_inline]] constexpr S min(S a, S b) {
  return b < a ? b : a;
}

/// The greater; a where they are equal.
template <class S>
[[gnu::always_inline]] constexpr S max(S a, S b) {
  return a < b ? b : a;
}

/// x held within [low, high], for low <= high. MIS: fclamp
template <class S>
[[gnu::always_inline]] constexpr S clamp(S x, S low, S high) {
  return x < low ? low : (high < x ? high : x);
}

/// The length of (x, y), within 2 ulp; neither squares that overflow nor ones that vanish spoil it.
double length(double x, double y);

/// (x, y) / length(x, y); (0, 0) for (0, 0).
Components<double> normalize(double x, double y);

/// Sine and cosine of an angle in radians, each at most 1 ulp off for every finite angle.
SinCos<double> sincos(double angle);

/// The angle of the point (x, y), in (-pi, pi], with the signs IEEE-754 asks for at zeros; at most 1 ulp off.
double atan2(double y, double x);

/// e to the power x; at most 1 ulp off.
double exp(double x);

/// 2 to the power x; at most 1 ulp off, exact for whole x.
double exp2(double x);

/// The binary logarithm of x >= 0; at most 1 ulp off, exact for powers of two.
double log2(double x);

/// base >= 0 to the power exponent; at most 1 ulp off. pow(0, 0) = 1.
double pow(double base, double exponent);

/// a * b, for decisions. Exact on Fixed; plain on double.
[[gnu::always_inline]] constexpr double exactProduct(double a, double b) { return a * b; }

/// a * b + c * d, for decisions. Exact on Fixed; plain on double.
[[gnu::always_inline]] constexpr double exactDot(double a, double b, double c, double d) {
  return a * b + c * d;
}

/// a * b - c * d, for decisions. Exact on Fixed; plain on double.
[[gnu::always_inline]] constexpr double exactCross(double a, double b, double c, double d) {
  return a * b - c * d;
}

/// These do on double what localPlace, localUnit, localLength and localDot do on Fixed: the number itself,
/// and plain arithmetic.
[[gnu::always_inline]] constexpr double localPlace(double difference) { return difference; }
[[gnu::always_inline]] constexpr double localUnit(double component) { return component; }
[[gnu::always_inline]] constexpr double localLength(double length) { return length; }
[[gnu::always_inline]] constexpr double localDot(double x, double y, double nx, double ny) {
  return x * nx + y * ny;
}

/// -1, 0 or 1.
[[gnu::always_inline]] constexpr int sign(double w) { return (0.0 < w) - (w < 0.0); }

/// The number a Wide or Scaled stands for: on double, itself.
[[gnu::always_inline]] constexpr double toScalar(double w) { return w; }
template <std::same_as<double> S>
[[gnu::always_inline]] constexpr S toScalar(S w) {
  return w;
}

/// Number with room for masses and their inverses: on double, itself.
[[gnu::always_inline]] constexpr double toScaled(double x) { return x; }

}  // namespace samestep
