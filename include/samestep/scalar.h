// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdint>

#include <samestep/fixed.h>
#include <samestep/fixed_math.h>
#include <samestep/math.h>
#include <samestep/scaled.h>
#include <samestep/wide.h>

namespace samestep {

/// Traits that the engine must know of a number type beyond its functions. Specialised for each supported
/// type; any other type is refused by the concept Scalar.
template <class S>
struct ScalarTraits {
  static constexpr bool kSupported = false;
};

/// The tag that recordings and snapshots carry for the number type.
enum class ScalarKind : std::uint8_t { fixed = 1, float64 = 2 };

template <class Rep, int kFractionBits, class Overflow>
struct ScalarTraits<BasicFixed<Rep, kFractionBits, Overflow>> {
#ifdef SAMESTEP_NO_CHECKED
  static constexpr bool kSupported = std::same_as<Overflow, Wrapping>;
#else
  static constexpr bool kSupported = true;
#endif
  static constexpr ScalarKind kKind = ScalarKind::fixed;
  /// True if it is cheaper to multiply again than to keep a product in memory.
  static constexpr bool kCheapProducts = false;
};

#ifndef SAMESTEP_FIXED_ONLY
template <>
struct ScalarTraits<double> {
  static constexpr bool kSupported = true;
  static constexpr ScalarKind kKind = ScalarKind::float64;
  static constexpr bool kCheapProducts = true;
};
#endif

/// double, Fixed or CheckedFixed: the numbers the engine is built for (SAMESTEP_SCALARS, SAMESTEP_CHECKED).
template <class S>
concept Scalar = ScalarTraits<S>::kSupported;

/// numerator / denominator, rounded to the nearest S.
template <Scalar S>
[[gnu::always_inline]] constexpr S ratio(int numerator, int denominator) {
  return S(numerator) / S(denominator);
}

}  // namespace samestep
