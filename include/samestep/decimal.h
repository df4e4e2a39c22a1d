// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <string>
#include <string_view>

#include "samestep/decimal_status.h"
#include "samestep/fixed_text.h"

/// Decimal text of double, and by inclusion of fixed-point numbers: exact in both directions and the same
/// under every locale and standard library.
namespace samestep {

/// The longest text that parseDecimal reads into a double, in characters: room for every double, and for
/// every midpoint between two of them, written out in full.
inline constexpr int kMaxDoubleDecimalLength = 1200;

/// Reads [+-] digits [. digits] [(e|E) [+-] digits] with a digit on at least one side of the point, the whole
/// of text, and rounds it once: to the nearest double, ties to even. What is too small becomes a subnormal or
/// a zero of its sign.
/// @return ok; tooLong; empty; notANumber (also for inf, nan, hex and any space); outOfRange where the
///         nearest double would be infinite. Unless ok, out stays as it was.
DecimalStatus parseDecimal(std::string_view text, double& out);
template <std::same_as<double> S>
DecimalStatus parseDecimal(std::string_view text, S& out) {
  double& number = out;
  return parseDecimal(text, number);
}

/// The shortest decimal that parseDecimal reads back as x, and of those the nearest to x. Plain digits for
/// 1e-7 <= |x| < 1e21, else with an exponent ("1.5e-9"); a whole number has no point; -0 is "-0".
/// @param x  finite; otherwise the text is "inf", "-inf" or "nan", which parseDecimal refuses
std::string formatDecimal(double x);

}  // namespace samestep
