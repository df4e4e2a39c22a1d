#pragma once

namespace samestep {

/// Result of parseDecimal. Anything but `ok` leaves the output as it was.
enum class DecimalStatus : unsigned char {
  ok,
  empty,       ///< no characters at all
  notANumber,  ///< not [+-] digits [. digits] [e [+-] digits]
  outOfRange,  ///< a number that rounds to none of the type's
  tooLong,     ///< more than kMaxDecimalLength characters
};

/// The longest text that parseDecimal reads, in characters.
inline constexpr int kMaxDecimalLength = 512;

}  // namespace samestep
