#pragma once

#include <string>
#include <string_view>

#include "samestep/decimal_status.h"
#include "samestep/fixed.h"
#include "samestep/raw_decimal.h"
#include "samestep/raw_parse_decimal.h"

namespace samestep {

/// The shortest decimal that parseDecimal reads back as x, and the nearest to x of that length: "-0.1".
/// Never an exponent, never a point without digits on both sides.
template <FixedNumber S>
std::string formatDecimal(S x) {
  const raw::DecimalText text = raw::formatDecimal(x.raw(), S::kBits);
  return std::string(text.characters.data(), static_cast<std::size_t>(text.length));
}

/// Reads [+-] digits [. digits] [e [+-] digits] with a digit on at least one side of the point and nothing
/// before or after; rounds to nearest, ties to even.
/// @param out  changed only where the result is ok
template <FixedNumber S>
constexpr DecimalStatus parseDecimal(std::string_view text, S& out) {
  std::int64_t bits = 0;
  const DecimalStatus status = raw::parseDecimal(text, S::kBits, bits);
  if (status != DecimalStatus::ok) return status;
  if (bits < S::lowest().raw() || bits > S::max().raw()) return DecimalStatus::outOfRange;
  out = S::fromRaw(static_cast<typename S::Raw>(bits));
  return DecimalStatus::ok;
}

/// A literal that is no number calls this: it is not constexpr, so that the compiler stops there.
void aFixedLiteralMustBeADecimalNumberInTheRangeOfFixed();

namespace literals {

/// A Fixed from an exact decimal: 0.1_fixed. Text that is no decimal or does not fit is a compile error.
consteval Fixed operator""_fixed(const char* text) {
  Fixed result;
  if (parseDecimal(std::string_view(text), result) != DecimalStatus::ok) {
    aFixedLiteralMustBeADecimalNumberInTheRangeOfFixed();
  }
  return result;
}

}  // namespace literals
}  // namespace samestep
