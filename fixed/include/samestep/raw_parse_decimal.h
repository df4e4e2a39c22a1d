#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "samestep/decimal_status.h"

/// Reads decimals as numbers given as raw bits and a count of fraction bits; fixed_text.h is the interface.
namespace samestep::raw {

/// Digits of a number and the place of its point, as parseDecimal reads them before it rounds.
struct DecimalDigits {
  std::array<unsigned char, kMaxDecimalLength> digits{};  ///< without zeros in front
  int count = 0;
  int point = 0;  ///< the value is 0.d1 d2 d3 ... times 10^point
  bool negative = false;
};

constexpr bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Reads [+-] digits [. digits] [e [+-] digits]; a digit must stand before or after the point.
constexpr DecimalStatus readDigits(std::string_view text, DecimalDigits& out) {
  if (text.empty()) return DecimalStatus::empty;
  if (text.size() > kMaxDecimalLength) return DecimalStatus::tooLong;
  std::size_t at = 0;
  const auto peek = [&] { return at < text.size() ? text[at] : '\0'; };
  if (peek() == '+' || peek() == '-') out.negative = text[at++] == '-';
  bool seenDigit = false;
  bool seenPoint = false;
  for (; isDigit(peek()) || (peek() == '.' && !seenPoint); ++at) {
    if (peek() == '.') {
      seenPoint = true;
      continue;
    }
    seenDigit = true;
    const auto digit = static_cast<unsigned char>(peek() - '0');
    const bool leadingZero = digit == 0 && out.count == 0;
    if (!leadingZero) out.digits[static_cast<std::size_t>(out.count++)] = digit;
    if (!seenPoint && !leadingZero) ++out.point;
    if (seenPoint && leadingZero) --out.point;
  }
  if (!seenDigit) return DecimalStatus::notANumber;
  if (peek() == 'e' || peek() == 'E') {
    ++at;
    const bool down = peek() == '-';
    if (peek() == '+' || peek() == '-') ++at;
    if (!isDigit(peek())) return DecimalStatus::notANumber;
    int exponent = 0;
    for (; isDigit(peek()); ++at) {
      // Larger than any count of digits can undo.
      if (exponent < 100000) exponent = exponent * 10 + (peek() - '0');
    }
    out.point += down ? -exponent : exponent;
  }
  return at == text.size() ? DecimalStatus::ok : DecimalStatus::notANumber;
}

/// The nearest multiple of 2^-bits to the text, ties to even, as raw bits.
/// @param bits  0 to 62
constexpr DecimalStatus parseDecimal(std::string_view text, int bits, std::int64_t& out) {
  DecimalDigits number;
  const DecimalStatus status = readDigits(text, number);
  if (status != DecimalStatus::ok) return status;
  if (number.count == 0 || number.point < -20) {
    // Below 10^-20, which is less than half of any unit.
    out = 0;
    return DecimalStatus::ok;
  }
  if (number.point > 19) return DecimalStatus::outOfRange;
  std::uint64_t whole = 0;
  int at = 0;
  for (; at < number.point; ++at) {
    whole = whole * 10 + (at < number.count ? number.digits[static_cast<std::size_t>(at)] : 0u);
  }
  if (whole > (~std::uint64_t{0} >> (bits + 1)) + 1) return DecimalStatus::outOfRange;
  // The fraction's binary digits by repeated doubling of its decimal ones: exact at any length.
  std::array<unsigned char, kMaxDecimalLength + 20> fraction{};
  int length = 0;
  for (int zeros = number.point; zeros < 0; ++zeros) fraction[static_cast<std::size_t>(length++)] = 0;
  for (; at < number.count; ++at) {
    fraction[static_cast<std::size_t>(length++)] = number.digits[static_cast<std::size_t>(at)];
  }
  const auto doubled = [&] {
    unsigned carry = 0;
    for (int i = length - 1; i >= 0; --i) {
      const unsigned value = fraction[static_cast<std::size_t>(i)] * 2u + carry;
      carry = value >= 10 ? 1 : 0;
      fraction[static_cast<std::size_t>(i)] = static_cast<unsigned char>(value - 10 * carry);
    }
    while (length > 0 && fraction[static_cast<std::size_t>(length - 1)] == 0) --length;
    return carry;
  };
  std::uint64_t size = whole;
  for (int bit = 0; bit < bits; ++bit) size = size << 1 | doubled();
  const unsigned half = doubled();
  const bool beyondHalf = length > 0;
  size += half & (beyondHalf || (size & 1) != 0 ? 1u : 0u);
  const std::uint64_t limit = (~std::uint64_t{0} >> 1) + (number.negative ? 1u : 0u);
  if (size > limit) return DecimalStatus::outOfRange;
  out = static_cast<std::int64_t>(number.negative ? 0 - size : size);
  return DecimalStatus::ok;
}

}  // namespace samestep::raw
