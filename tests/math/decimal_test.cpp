// SPDX-License-Identifier: MIT
#include "samestep/decimal.h"

#include <gtest/gtest.h>

#include <bit>
#include <clocale>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace samestep {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kLeast = std::numeric_limits<double>::denorm_min();
constexpr double kLeastNormal = std::numeric_limits<double>::min();

/// The bits of what text is read as; fails the test unless the status is ok.
std::uint64_t parsedBits(const std::string& text) {
  double number = 0.0;
  EXPECT_EQ(parseDecimal(text, number), DecimalStatus::ok) << text;
  return std::bit_cast<std::uint64_t>(number);
}

double parsed(const std::string& text) { return std::bit_cast<double>(parsedBits(text)); }

DecimalStatus status(const std::string& text) {
  double untouched = 7.25;
  const DecimalStatus result = parseDecimal(text, untouched);
  if (result != DecimalStatus::ok) {
    EXPECT_EQ(untouched, 7.25) << text;
  }
  return result;
}

TEST(ParseDecimalTest, ReadsEveryPartOfANumber) {
  EXPECT_EQ(parsed("0"), 0.0);
  EXPECT_EQ(parsed("7"), 7.0);
  EXPECT_EQ(parsed("+7"), 7.0);
  EXPECT_EQ(parsed("-7"), -7.0);
  EXPECT_EQ(parsed("007"), 7.0);
  EXPECT_EQ(parsed("12.5"), 12.5);
  EXPECT_EQ(parsed("0.000125"), 0.000125);
  EXPECT_EQ(parsed("125e-6"), 0.000125);
  EXPECT_EQ(parsed("1.25E+2"), 125.0);
  EXPECT_EQ(parsed("1.25e002"), 125.0);
  EXPECT_EQ(parsed("100000e-5"), 1.0);
  EXPECT_EQ(parsedBits("-0"), std::uint64_t{1} << 63);
  EXPECT_EQ(parsedBits("-0.00e7"), std::uint64_t{1} << 63);
}

// A scene must not be readable in one scalar and refused in another.
TEST(ParseDecimalTest, NeedsADigitOnOneSideOfThePointOnlyAsFixedDoes) {
  for (const auto& [text, value] : {std::pair(".5", 0.5), std::pair("-.5", -0.5), std::pair("5.", 5.0),
                                    std::pair("1.e2", 100.0), std::pair("+.25E1", 2.5)}) {
    EXPECT_EQ(parsed(text), value);
    Fixed number;
    EXPECT_EQ(parseDecimal(std::string_view(text), number), DecimalStatus::ok) << text;
    EXPECT_EQ(number, Fixed(value));
  }
}

TEST(ParseDecimalTest, RefusesWhatIsNotANumber) {
  for (const char* text : {"+",    "-",        ".",   "-.",    ".e5",   "e5",    "1e",  "1e+",     "1e-",
                           "1..2", "1.2.3",    "--1", "+-1",   " 1",    "1 ",    "1,5", "0x10",    "inf",
                           "-inf", "Infinity", "nan", "1e5.0", "1e5e5", "1_000", "1f",  "\xd9\xa1"}) {
    EXPECT_EQ(status(text), DecimalStatus::notANumber) << text;
  }
  EXPECT_EQ(status(std::string("1\0", 2)), DecimalStatus::notANumber);
}

TEST(ParseDecimalTest, TellsEmptyTooLongAndOutOfRange) {
  EXPECT_EQ(status(""), DecimalStatus::empty);
  EXPECT_EQ(status(std::string(kMaxDoubleDecimalLength + 1, '1')), DecimalStatus::tooLong);
  EXPECT_EQ(status(std::string(kMaxDoubleDecimalLength, '1')), DecimalStatus::outOfRange);
  EXPECT_EQ(status("1e309"), DecimalStatus::outOfRange);
  EXPECT_EQ(status("-1e99999999999999999999"), DecimalStatus::outOfRange);
  EXPECT_EQ(status("1.7976931348623159e308"), DecimalStatus::outOfRange);
}

TEST(ParseDecimalTest, ReadsTheLongestTexts) {
  EXPECT_EQ(parsed("0." + std::string(kMaxDoubleDecimalLength - 2, '0')), 0.0);
  EXPECT_EQ(parsed("0." + std::string(kMaxDoubleDecimalLength - 2, '3')), 1.0 / 3.0);
  EXPECT_EQ(parsed(std::string(kMaxDoubleDecimalLength - 6, '9') + "e-1194"), 1.0);
  EXPECT_EQ(parsed("1" + std::string(1000, '0') + "e-1000"), 1.0);
  EXPECT_EQ(parsed("0." + std::string(1000, '0') + "1e1001"), 1.0);
  EXPECT_EQ(parsed(std::string(kMaxDoubleDecimalLength - 6, '9') + "e-1517"), 1e-323);
}

TEST(ParseDecimalTest, RoundsTiesToEven) {
  EXPECT_EQ(parsed("9007199254740993"), 9007199254740992.0);
  EXPECT_EQ(parsed("9007199254740995"), 9007199254740996.0);
  EXPECT_EQ(parsed("9007199254740993.0000000000000000000000000000000000000001"), 9007199254740994.0);
  EXPECT_EQ(parsed("9007199254740992.9999999999999999999999999999999999999999"), 9007199254740992.0);
}

TEST(ParseDecimalTest, ReadsTheEndsOfTheRange) {
  EXPECT_EQ(parsed("1.7976931348623157e308"), kLargest);
  EXPECT_EQ(parsed("1.7976931348623158079e308"), kLargest);
  EXPECT_EQ(parsed("2.2250738585072014e-308"), kLeastNormal);
  EXPECT_EQ(parsed("2.2250738585072011e-308"), std::bit_cast<double>((std::uint64_t{1} << 52) - 1));
  EXPECT_EQ(parsed("4.9e-324"), kLeast);
  EXPECT_EQ(parsed("2.4703282292062328e-324"), kLeast);
  EXPECT_EQ(parsed("2.4703282292062327e-324"), 0.0);
  EXPECT_EQ(parsedBits("-1e-400"), std::uint64_t{1} << 63);
  EXPECT_EQ(parsed("1e-99999999999999999999"), 0.0);
  EXPECT_EQ(parsed("0e99999999999999999999"), 0.0);
}

TEST(ParseDecimalTest, IsWithinReachOfGenericCode) {
  double number = 0.0;
  EXPECT_EQ(parseDecimal<double>("1.5", number), DecimalStatus::ok);
  EXPECT_EQ(number, 1.5);
}

TEST(FormatDecimalTest, WritesTheShortestText) {
  const std::vector<std::pair<double, const char*>> cases = {
      {0.0, "0"},
      {-0.0, "-0"},
      {1.0, "1"},
      {-1.5, "-1.5"},
      {0.1, "0.1"},
      {0.3, "0.3"},
      {0.1 + 0.2, "0.30000000000000004"},
      {1.0 / 3.0, "0.3333333333333333"},
      {100.0, "100"},
      {123456789.0, "123456789"},
      {1e20, "100000000000000000000"},
      {123456789012345680000.0, "123456789012345680000"},
      {1e21, "1e21"},
      {1.5e300, "1.5e300"},
      {1e-7, "0.0000001"},
      {9.5e-8, "9.5e-8"},
      {9007199254740993.0, "9007199254740992"},
      {5e-324, "5e-324"},
      {kLargest, "1.7976931348623157e308"},
      {kLeastNormal, "2.2250738585072014e-308"},
      {9.5367431640625e-7, "0.00000095367431640625"},
      {0x1p-1022 - 0x1p-1074, "2.225073858507201e-308"},
      {2e-323, "2e-323"},
      {1e23, "1e23"},
  };
  for (const auto& [number, text] : cases) EXPECT_EQ(formatDecimal(number), text);
}

TEST(FormatDecimalTest, NamesWhatIsNotFinite) {
  EXPECT_EQ(formatDecimal(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(formatDecimal(-std::numeric_limits<double>::infinity()), "-inf");
  EXPECT_EQ(formatDecimal(std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(DecimalTest, EveryDoubleReadsBackTheSame) {
  std::mt19937_64 random(20261122);
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t bits = random();
    if ((bits >> 52 & 2047) == 2047) continue;
    const std::string text = formatDecimal(std::bit_cast<double>(bits));
    ASSERT_EQ(parsedBits(text), bits) << text;
    ASSERT_LE(text.size(), 26u) << text;
  }
}

TEST(DecimalTest, PowersOfTwoAndTheirNeighboursReadBackTheSame) {
  for (int exponent = -1074; exponent < 1024; ++exponent) {
    const std::uint64_t power = exponent < -1022 ? std::uint64_t{1} << (exponent + 1074)
                                                 : static_cast<std::uint64_t>(exponent + 1023) << 52;
    for (const std::uint64_t bits : {power - 1, power, power + 1}) {
      const std::string text = formatDecimal(std::bit_cast<double>(bits));
      ASSERT_EQ(parsedBits(text), bits) << text;
    }
  }
}

// A locale with a decimal comma, where there is one, changes nothing.
TEST(DecimalTest, LocaleHasNoSay) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "German"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  }
  EXPECT_EQ(parsed("1.5"), 1.5);
  EXPECT_EQ(status("1,5"), DecimalStatus::notANumber);
  EXPECT_EQ(formatDecimal(1234.5), "1234.5");
  std::setlocale(LC_ALL, before.c_str());
}

}  // namespace
}  // namespace samestep
