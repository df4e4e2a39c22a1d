// SPDX-License-Identifier: MIT
// Decimal text of double against MPFR and the standard library's own shortest text.
#include <gtest/gtest.h>
#include <mpfr.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

#include "samestep/decimal.h"

namespace samestep {
namespace {

constexpr std::uint64_t kInfinityBits = std::uint64_t{2047} << 52;

/// The bits of the nearest double, by MPFR within the exponents of double.
std::uint64_t referenceBits(const std::string& text) {
  const mpfr_exp_t least = mpfr_get_emin();
  const mpfr_exp_t largest = mpfr_get_emax();
  mpfr_set_emin(-1073);
  mpfr_set_emax(1024);
  mpfr_t number;
  mpfr_init2(number, 53);
  const int direction = mpfr_strtofr(number, text.c_str(), nullptr, 10, MPFR_RNDN);
  mpfr_subnormalize(number, direction, MPFR_RNDN);
  const double result = mpfr_get_d(number, MPFR_RNDN);
  mpfr_clear(number);
  mpfr_set_emin(least);
  mpfr_set_emax(largest);
  return std::bit_cast<std::uint64_t>(result);
}

void expectNearest(const std::string& text) {
  const std::uint64_t reference = referenceBits(text);
  double number = 0.0;
  const DecimalStatus status = parseDecimal(text, number);
  if ((reference & kInfinityBits) == kInfinityBits) {
    ASSERT_EQ(status, DecimalStatus::outOfRange) << text;
  } else {
    ASSERT_EQ(status, DecimalStatus::ok) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(number), reference) << text;
    ASSERT_EQ(number, std::strtod(text.c_str(), nullptr)) << text;
  }
}

/// Exact digits of the middle between a positive double and the next.
std::string midpoint(std::uint64_t bits) {
  mpfr_t middle, next;
  mpfr_init2(middle, 64);
  mpfr_init2(next, 64);
  mpfr_set_d(middle, std::bit_cast<double>(bits), MPFR_RNDN);
  mpfr_set_d(next, std::bit_cast<double>(bits + 1), MPFR_RNDN);
  mpfr_add(middle, middle, next, MPFR_RNDN);
  mpfr_div_2ui(middle, middle, 1, MPFR_RNDN);
  mpfr_exp_t exponent = 0;
  char* digits = mpfr_get_str(nullptr, &exponent, 10, 800, middle, MPFR_RNDN);
  std::string text = digits;
  mpfr_free_str(digits);
  mpfr_clear(middle);
  mpfr_clear(next);
  text.erase(text.find_last_not_of('0') + 1);
  return text.insert(1, ".") + "e" + std::to_string(exponent - 1);
}

TEST(DecimalAccuracyTest, RandomNumbersOfEveryLengthAreRoundedOnce) {
  std::mt19937_64 random(20261122);
  for (int i = 0; i < 100'000; ++i) {
    const int digits = 1 + static_cast<int>(random() % (i % 10 == 0 ? 800 : 25));
    std::string text = i % 2 == 0 ? "-" : "";
    for (int d = 0; d < digits; ++d) {
      if (d == 1) text += '.';
      text += static_cast<char>('0' + random() % 10);
    }
    const int range = i % 3 == 0 ? 20 : 340;
    text += "e" + std::to_string(static_cast<int>(random() % static_cast<unsigned>(2 * range)) - range);
    ASSERT_NO_FATAL_FAILURE(expectNearest(text));
  }
}

TEST(DecimalAccuracyTest, MidpointsGoToEvenAndTheirNeighboursToTheirSide) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    // Every fourth one subnormal.
    const std::uint64_t bits = random() % (i % 4 == 0 ? std::uint64_t{1} << 52 : kInfinityBits - 1);
    const std::string middle = midpoint(bits);
    const auto mantissaEnd = middle.find('e');
    std::string above = middle;
    above.insert(mantissaEnd, "0000000001");
    std::string below = middle;  // its last digit is not 0
    --below[mantissaEnd - 1];
    below.insert(mantissaEnd, "9999999999");
    for (const std::string& text : {middle, above, below}) ASSERT_NO_FATAL_FAILURE(expectNearest(text));
    double number = 0.0;
    parseDecimal(middle, number);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(number), bits + bits % 2);
    parseDecimal(above, number);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(number), bits + 1);
    parseDecimal(below, number);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(number), bits);
  }
}

TEST(DecimalAccuracyTest, TheMiddleBeyondTheLargestIsOutOfRange) {
  const std::string digits =
      "1797693134862315807937289714053034150799341327100378269361737789804449682927647509466490";
  expectNearest("1.7976931348623157e308");
  expectNearest("1.79769313486231580793e308");
  expectNearest("1.79769313486231580794e308");
  expectNearest(digits + "e221");
  expectNearest("2e308");
}

TEST(DecimalAccuracyTest, TextIsAsShortAndAsNearAsTheStandardLibrarys) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200'000; ++i) {
    std::uint64_t bits = random() & ~(std::uint64_t{1} << 63);
    if (i % 5 == 0) bits &= ~((std::uint64_t{1} << 52) - 1);  // powers of two
    if (i % 5 == 1) bits &= (std::uint64_t{1} << 52) - 1;     // subnormals
    if (i % 5 == 2)
      bits = std::bit_cast<std::uint64_t>(static_cast<double>(bits >> (random() % 63)) / 1000.0);
    const auto number = std::bit_cast<double>(bits);
    if (!std::isfinite(number) || number == 0.0) continue;

    std::array<char, 64> shortest;
    const auto end = std::to_chars(shortest.data(), shortest.data() + shortest.size(), number,
                                   std::chars_format::scientific)
                         .ptr;
    // Brought to the same notation: d[.d...]e[-]dd and ours both become digits and exponent.
    const auto digitsAndExponent = [](const std::string& text) {
      const auto e = text.find('e');
      std::string mantissa = text.substr(0, e);
      int exponent = e == std::string::npos ? 0 : std::stoi(text.substr(e + 1));
      const auto point = mantissa.find('.');
      if (point != std::string::npos) {
        exponent -= static_cast<int>(mantissa.size() - point - 1);
        mantissa.erase(point, 1);
      }
      mantissa.erase(0, mantissa.find_first_not_of('0'));
      const auto last = mantissa.find_last_not_of('0');
      exponent += static_cast<int>(mantissa.size() - last - 1);
      mantissa.erase(last + 1);
      return mantissa + "e" + std::to_string(exponent);
    };
    ASSERT_EQ(digitsAndExponent(formatDecimal(number)), digitsAndExponent(std::string(shortest.data(), end)));
  }
}

}  // namespace
}  // namespace samestep
