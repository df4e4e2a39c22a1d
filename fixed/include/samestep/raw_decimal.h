#pragma once

#include <array>
#include <cstdint>

#include "samestep/halves.h"

/// Writes numbers given as raw bits and a count of fraction bits as decimals; fixed_text.h is the interface.
namespace samestep::raw {

/// Room for the longest decimal of a 64-bit fixed-point number: sign, 19 digits, point, 63 digits.
struct DecimalText {
  std::array<char, 88> characters{};
  int length = 0;

  constexpr void append(char c) { characters[static_cast<std::size_t>(length++)] = c; }
};

constexpr void appendInteger(DecimalText& text, std::uint64_t value, int leastDigits) {
  std::array<char, 20> digits{};
  int count = 0;
  while (value != 0 || count < leastDigits) {
    digits[static_cast<std::size_t>(count++)] = static_cast<char>('0' + value % 10);
    value /= 10;
  }
  while (count > 0) text.append(digits[static_cast<std::size_t>(--count)]);
}

/// The shortest decimal nearer to value / 2^bits than to any neighbour, and the nearest of its length.
/// @param bits  0 to 62
constexpr DecimalText formatDecimal(std::int64_t value, int bits) {
  DecimalText text;
  const bool negative = value < 0;
  const std::uint64_t size =
      negative ? 0 - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
  const std::uint64_t one = std::uint64_t{1} << bits;
  const std::uint64_t fraction = size & (one - 1);
  if (negative) text.append('-');
  appendInteger(text, size >> bits, 1);
  if (fraction == 0) return text;
  std::uint64_t scale = 1;
  for (int digits = 1;; ++digits) {
    scale *= 10;
    const Halves scaled = multiplyHalves(fraction, scale);
    // Nearest multiple of 10^-digits, and its distance in units of 2^-bits 10^-digits.
    const std::uint64_t decimal = ((scaled + Halves{0, one >> 1}) >> bits).low;
    const Halves back = Halves{0, decimal} << bits;
    const std::uint64_t distance = (back > scaled ? back - scaled : scaled - back).low;
    if (2 * distance < scale || (2 * distance == scale && size % 2 == 0)) {
      text.append('.');
      appendInteger(text, decimal, digits);
      return text;
    }
  }
}

}  // namespace samestep::raw
