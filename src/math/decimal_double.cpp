// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "base/require_ieee.h"
#include "samestep/decimal.h"

namespace samestep {
namespace {

constexpr std::uint64_t kImplicitBit = std::uint64_t{1} << 52;

/// A natural number of up to 5 248 bits. The longest text allowed needs 10^1526, or 5 070 bits.
class Natural {
 public:
  explicit Natural(std::uint64_t value) {
    for (; value != 0; value >>= 32) append(static_cast<std::uint32_t>(value));
  }

  bool isZero() const { return size_ == 0; }

  int bitLength() const { return size_ == 0 ? 0 : 32 * size_ - std::countl_zero(at(size_ - 1)); }

  void multiplyAdd(std::uint32_t factor, std::uint32_t addend) {
    std::uint64_t carry = addend;
    for (int i = 0; i < size_; ++i) {
      carry += std::uint64_t{at(i)} * factor;
      at(i) = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    if (carry != 0) append(static_cast<std::uint32_t>(carry));
  }

  void multiplyByPowerOfTen(int exponent) {
    for (; exponent >= 9; exponent -= 9) multiplyAdd(1'000'000'000, 0);
    for (; exponent > 0; --exponent) multiplyAdd(10, 0);
  }

  void shiftLeft(int bits) {
    if (size_ == 0) return;
    multiplyAdd(std::uint32_t{1} << (bits % 32), 0);
    const int words = bits / 32;
    if (words == 0) return;
    for (int i = size_ - 1; i >= 0; --i) at(i + words) = at(i);
    for (int i = 0; i < words; ++i) at(i) = 0;
    size_ += words;
  }

  Natural& operator+=(const Natural& other) {
    std::uint64_t carry = 0;
    const int count = std::max(size_, other.size_);
    while (size_ < count) append(0);
    for (int i = 0; i < count; ++i) {
      carry += std::uint64_t{at(i)} + (i < other.size_ ? other.at(i) : 0);
      at(i) = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    if (carry != 0) append(static_cast<std::uint32_t>(carry));
    return *this;
  }

  /// @param other  at most *this
  Natural& operator-=(const Natural& other) {
    std::uint64_t borrow = 0;
    for (int i = 0; i < size_; ++i) {
      const std::uint64_t difference = std::uint64_t{at(i)} - (i < other.size_ ? other.at(i) : 0) - borrow;
      at(i) = static_cast<std::uint32_t>(difference);
      borrow = difference >> 63;
    }
    while (size_ > 0 && at(size_ - 1) == 0) --size_;
    return *this;
  }

  std::strong_ordering operator<=>(const Natural& other) const {
    if (size_ != other.size_) return size_ <=> other.size_;
    for (int i = size_ - 1; i >= 0; --i) {
      if (at(i) != other.at(i)) return at(i) <=> other.at(i);
    }
    return std::strong_ordering::equal;
  }
  bool operator==(const Natural& other) const { return (*this <=> other) == 0; }

 private:
  std::uint32_t& at(int i) { return words_[static_cast<std::size_t>(i)]; }
  const std::uint32_t& at(int i) const { return words_[static_cast<std::size_t>(i)]; }
  void append(std::uint32_t word) { at(size_++) = word; }

  std::array<std::uint32_t, 164> words_;  // least significant first; only size_ of them are set
  int size_ = 0;
};

// ---- reading ----

/// A decimal token: digits * 10^exponent, without zeros at either end of digits.
struct Token {
  bool negative = false;
  std::array<char, kMaxDoubleDecimalLength> digits;
  int count = 0;
  int exponent = 0;
};

/// Takes characters off the front of a text.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  bool atEnd() const { return rest_.empty(); }
  bool atDigit() const { return !rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9'; }

  bool take(char wanted) {
    if (rest_.empty() || rest_.front() != wanted) return false;
    rest_.remove_prefix(1);
    return true;
  }

  int takeDigit() {
    const int digit = rest_.front() - '0';
    rest_.remove_prefix(1);
    return digit;
  }

  /// @return true for a minus
  bool takeSign() { return take('-') || (take('+'), false); }

 private:
  std::string_view rest_;
};

void appendDigit(Token& token, int digit) {
  if (token.count == 0 && digit == 0) return;
  token.digits[static_cast<std::size_t>(token.count++)] = static_cast<char>(digit);
}

bool readMantissa(Reader& reader, Token& token) {
  const bool whole = reader.atDigit();
  while (reader.atDigit()) appendDigit(token, reader.takeDigit());
  if (!reader.take('.') || !reader.atDigit()) return whole;
  for (; reader.atDigit(); --token.exponent) appendDigit(token, reader.takeDigit());
  return true;
}

bool readExponent(Reader& reader, Token& token) {
  if (!reader.take('e') && !reader.take('E')) return true;
  const bool negative = reader.takeSign();
  if (!reader.atDigit()) return false;
  // Far beyond what any mantissa of the longest text can make up for.
  constexpr int kEnough = 100'000;
  int exponent = 0;
  while (reader.atDigit()) exponent = std::min(exponent * 10 + reader.takeDigit(), kEnough);
  token.exponent += negative ? -exponent : exponent;
  return true;
}

bool readToken(std::string_view text, Token& token) {
  Reader reader(text);
  token.negative = reader.takeSign();
  if (!readMantissa(reader, token) || !readExponent(reader, token) || !reader.atEnd()) return false;
  for (; token.count > 0 && token.digits[static_cast<std::size_t>(token.count - 1)] == 0; --token.count)
    ++token.exponent;
  return true;
}

Natural digitsOf(const Token& token) {
  Natural number(0);
  std::uint32_t chunk = 0;
  std::uint32_t scale = 1;
  for (int i = 0; i < token.count; ++i) {
    chunk = chunk * 10 + static_cast<std::uint32_t>(token.digits[static_cast<std::size_t>(i)]);
    scale *= 10;
    if (scale == 1'000'000'000 || i + 1 == token.count) {
      if (number.isZero()) {
        number = Natural(chunk);
      } else {
        number.multiplyAdd(scale, chunk);
      }
      chunk = 0;
      scale = 1;
    }
  }
  return number;
}

/// The bits of the double nearest to numerator / denominator, both positive, ties to even; those of
/// infinity, or more, where it is too large.
std::uint64_t nearestRatio(Natural numerator, Natural denominator) {
  // 2^exponent <= ratio < 2^(exponent + 1), then 1 <= numerator / denominator < 2.
  int exponent = numerator.bitLength() - denominator.bitLength();
  if (exponent >= 0) {
    denominator.shiftLeft(exponent);
  } else {
    numerator.shiftLeft(-exponent);
  }
  if (numerator < denominator) {
    --exponent;
    numerator.shiftLeft(1);
  }

  // A subnormal has fewer bits; one below half the least of them has fewer than none.
  const int bits = std::min(53, exponent + 1075);
  if (bits < 0) return 0;
  std::uint64_t mantissa = 0;
  for (int i = 0; i < bits; ++i) {
    const bool bit = numerator >= denominator;
    if (bit) numerator -= denominator;
    numerator.shiftLeft(1);
    mantissa = mantissa << 1 | static_cast<std::uint64_t>(bit);
  }
  const auto rest = numerator <=> denominator;
  mantissa += rest > 0 || (rest == 0 && mantissa % 2 == 1);

  // The exponent field counts on from the mantissa's implicit bit, also where rounding carried into it.
  if (exponent < -1022) return mantissa;
  return (static_cast<std::uint64_t>(exponent + 1022) << 52) + mantissa;
}

std::uint64_t nearestDouble(const Token& token) {
  constexpr std::uint64_t kInfinityBits = std::uint64_t{2047} << 52;
  const int magnitude = token.count + token.exponent;  // the value is in [0.1, 1) * 10^magnitude
  if (token.count == 0 || magnitude < -324) return 0;
  if (magnitude > 309) return kInfinityBits;
  Natural numerator = digitsOf(token);
  Natural denominator(1);
  (token.exponent < 0 ? denominator : numerator).multiplyByPowerOfTen(std::abs(token.exponent));
  return std::min(nearestRatio(numerator, denominator), kInfinityBits);
}

// ---- writing ----

/// digits[0] . digits[1] ... * 10^exponent.
struct Digits {
  std::array<char, 20> digits;
  int count = 0;
  int exponent = 0;
};

/// Steele and White 1990 with exact integers: generates digits until what is left is within half the gap to a
/// neighbour.
/// @param bits  of a positive finite double
Digits shortestDigits(std::uint64_t bits) {
  const int field = static_cast<int>(bits >> 52);
  const std::uint64_t fraction = bits & (kImplicitBit - 1);
  const std::uint64_t mantissa = field == 0 ? fraction : fraction | kImplicitBit;
  const int exponent = std::max(field, 1) - 1075;
  const bool even = mantissa % 2 == 0;  // the reader rounds ties to even, so the interval's ends are its own
  const bool lowerGapIsHalf = fraction == 0 && field > 1;

  // value = rest / unit, half gaps below / unit and above / unit.
  Natural rest(mantissa);
  Natural unit(1);
  Natural below(1);
  rest.shiftLeft(1 + lowerGapIsHalf + std::max(exponent, 0));
  unit.shiftLeft(1 + lowerGapIsHalf + std::max(-exponent, 0));
  below.shiftLeft(std::max(exponent, 0));
  Natural above = below;
  above.shiftLeft(lowerGapIsHalf);

  // floor(log10(value)) or one less: 2^(length - 1) <= value < 2^length, and 1233 / 4096 is just under
  // log10(2).
  const int length = exponent + 64 - std::countl_zero(mantissa);
  int decimal = ((length - 1) * 1233 >> 12) - 1;
  if (decimal >= 0) {
    unit.multiplyByPowerOfTen(decimal);
  } else {
    rest.multiplyByPowerOfTen(-decimal);
    below.multiplyByPowerOfTen(-decimal);
    above.multiplyByPowerOfTen(-decimal);
  }
  const auto reaches = [&](const Natural& limit) {
    Natural top = rest;
    top += above;
    return even ? top >= limit : top > limit;
  };
  for (Natural tenUnits = unit;; ++decimal) {
    tenUnits = unit;
    tenUnits.multiplyAdd(10, 0);
    if (!reaches(tenUnits)) break;
    unit = tenUnits;
  }

  Digits result;
  result.exponent = decimal;
  while (true) {
    int digit = 0;
    for (; rest >= unit; ++digit) rest -= unit;
    const bool low = even ? rest <= below : rest < below;
    const bool high = reaches(unit);
    if (low || high) {
      Natural twice = rest;
      twice.shiftLeft(1);
      const auto middle = twice <=> unit;
      const bool roundUp = high && (!low || middle > 0 || (middle == 0 && digit % 2 == 1));
      result.digits[static_cast<std::size_t>(result.count++)] = static_cast<char>('0' + digit + roundUp);
      return result;
    }
    result.digits[static_cast<std::size_t>(result.count++)] = static_cast<char>('0' + digit);
    rest.multiplyAdd(10, 0);
    below.multiplyAdd(10, 0);
    above.multiplyAdd(10, 0);
  }
}

/// The longest text of a double: sign, "0.", six zeros, 17 digits; or 17 digits, point, "e-308".
struct ShortText {
  std::array<char, 32> characters{};
  std::size_t length = 0;

  void append(char c) { characters[length++] = c; }
  void append(std::string_view text) {
    for (const char c : text) append(c);
  }
  void append(int count, char c) {
    for (int i = 0; i < count; ++i) append(c);
  }
  std::string_view view() const { return {characters.data(), length}; }
};

void appendNumber(ShortText& text, int number) {
  if (number >= 10) appendNumber(text, number / 10);
  text.append(static_cast<char>('0' + number % 10));
}

void appendDigits(ShortText& text, const Digits& number) {
  const std::string_view digits(number.digits.data(), static_cast<std::size_t>(number.count));
  const int exponent = number.exponent;
  if (exponent < -7 || exponent >= 21) {
    text.append(digits.front());
    if (digits.size() > 1) text.append('.');
    text.append(digits.substr(1));
    text.append(exponent < 0 ? "e-" : "e");
    appendNumber(text, std::abs(exponent));
  } else if (exponent < 0) {
    text.append("0.");
    text.append(-exponent - 1, '0');
    text.append(digits);
  } else if (number.count <= exponent + 1) {
    text.append(digits);
    text.append(exponent + 1 - number.count, '0');
  } else {
    const auto whole = static_cast<std::size_t>(exponent + 1);
    text.append(digits.substr(0, whole));
    text.append('.');
    text.append(digits.substr(whole));
  }
}

ShortText textOf(double x) {
  const auto bits = __builtin_bit_cast(std::uint64_t, x);
  const std::uint64_t magnitude = bits << 1 >> 1;
  constexpr std::uint64_t kInfinity = std::uint64_t{2047} << 52;
  ShortText text;
  if (bits != magnitude && magnitude <= kInfinity) text.append('-');
  if (magnitude > kInfinity) {
    text.append("nan");
  } else if (magnitude == kInfinity) {
    text.append("inf");
  } else if (magnitude == 0) {
    text.append('0');
  } else {
    appendDigits(text, shortestDigits(magnitude));
  }
  return text;
}

}  // namespace

DecimalStatus parseDecimal(std::string_view text, double& out) {
  if (text.empty()) return DecimalStatus::empty;
  if (text.size() > kMaxDoubleDecimalLength) return DecimalStatus::tooLong;
  Token token;
  if (!readToken(text, token)) return DecimalStatus::notANumber;
  const std::uint64_t bits = nearestDouble(token);
  if (bits == std::uint64_t{2047} << 52) return DecimalStatus::outOfRange;
  out = __builtin_bit_cast(double, bits | std::uint64_t{token.negative} << 63);
  return DecimalStatus::ok;
}

std::string formatDecimal(double x) { return std::string(textOf(x).view()); }

/// Writes a number for the texts of errors, as far as there is room.
/// @return where it ended
char* writeDecimal(char* to, const char* end, double x) noexcept;
char* writeDecimal(char* to, const char* end, double x) noexcept {
  const ShortText text = textOf(x);
  for (const char c : text.view()) {
    if (to == end) break;
    *to++ = c;
  }
  return to;
}

}  // namespace samestep
