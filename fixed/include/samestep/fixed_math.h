#pragma once

#include <bit>
#include <cstdint>

#include "samestep/fixed.h"
#include "samestep/raw_functions.h"

namespace samestep {

/// sqrt(x) to nearest; 0 for a negative x (reported for checked numbers).
template <FixedNumber S>
constexpr S sqrt(S x) {
  if constexpr (S::kChecks) {
    if (x < S()) raw::report("sqrt", S::kBits, {x.raw()});
  }
  return S::fromRaw(static_cast<typename S::Raw>(raw::squareRoot<way::Chosen, S::kBits>(x.raw())));
}

/// The length of (x, y) to nearest, at any size; saturates.
template <class Rep, int kFractionBits, class Overflow>
constexpr BasicFixed<Rep, kFractionBits, Overflow> length(BasicFixed<Rep, kFractionBits, Overflow> x,
                                                          BasicFixed<Rep, kFractionBits, Overflow> y) {
  using S = BasicFixed<Rep, kFractionBits, Overflow>;
  const raw::Quotient result = raw::length<way::Chosen>(x.raw(), y.raw(), S::max().raw());
  if constexpr (S::kChecks) {
    if (!result.fits) raw::report("length", S::kBits, {x.raw(), y.raw()});
  }
  return S::fromRaw(static_cast<Rep>(result.raw));
}

/// (x, y) / length(x, y), each component to nearest, right at every length down to one raw unit; (0, 0) of
/// the zero vector.
template <FixedNumber S>
constexpr Components<S> normalize(S x, S y) {
  const raw::RawComponents unit = raw::normalize<way::Chosen, S::kBits>(x.raw(), y.raw());
  return {S::fromRaw(static_cast<typename S::Raw>(unit.x)), S::fromRaw(static_cast<typename S::Raw>(unit.y))};
}

/// The functions below are for Q32.32. Each is one integer algorithm with the same intermediate widths on
/// every machine, at most 1 unit of the last place off.
template <class S>
concept Q32 = FixedNumber<S> && S::kBits == 32 && sizeof(typename S::Raw) == 8;

/// Sine and cosine of an angle in radians, any angle.
template <Q32 S>
constexpr SinCos<S> sincos(S angle) {
  const raw::RawSinCos result = raw::sincos<way::Chosen>(angle.raw());
  return {S::fromRaw(result.sin), S::fromRaw(result.cos)};
}

/// The angle of (x, y) in (-pi, pi], radians; 0 of the zero vector.
template <Q32 S>
constexpr S atan2(S y, S x) {
  return S::fromRaw(raw::atan2<way::Chosen>(y.raw(), x.raw()));
}

/// 2^x; saturates.
template <Q32 S>
constexpr S exp2(S x) {
  const raw::Quotient result = raw::exp2<way::Chosen>(x.raw());
  if constexpr (S::kChecks) {
    if (!result.fits) raw::report("exp2", S::kBits, {x.raw()});
  }
  return S::fromRaw(result.raw);
}

/// e^x; saturates.
template <Q32 S>
constexpr S exp(S x) {
  const raw::Quotient result = raw::exp<way::Chosen>(x.raw());
  if constexpr (S::kChecks) {
    if (!result.fits) raw::report("exp", S::kBits, {x.raw()});
  }
  return S::fromRaw(result.raw);
}

/// The binary logarithm; the lowest value where x <= 0 (reported for checked numbers).
template <Q32 S>
constexpr S log2(S x) {
  if constexpr (S::kChecks) {
    if (x <= S()) raw::report("log2", S::kBits, {x.raw()});
  }
  return S::fromRaw(raw::log2<way::Chosen>(x.raw()));
}

/// base^exponent; saturates. base^0 is 1 for every base; 0^exponent is 0 for a positive exponent and the
/// largest value for a negative one. 0 for a negative base (reported for checked numbers).
template <Q32 S>
constexpr S pow(S base, S exponent) {
  const raw::Quotient result = raw::pow<way::Chosen>(base.raw(), exponent.raw());
  if constexpr (S::kChecks) {
    if (!result.fits) raw::report("pow", S::kBits, {base.raw(), exponent.raw()});
  }
  return S::fromRaw(result.raw);
}

}  // namespace samestep
