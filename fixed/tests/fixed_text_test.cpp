#include "samestep/fixed_text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <string>

#include "samestep/fixed_io.h"
#include "test_random.h"

namespace samestep {
namespace {

using namespace literals;

constexpr std::int64_t kMost = 0x7fffffffffffffff;

std::int64_t parsed(std::string_view text) {
  Fixed out = Fixed::fromRaw(12345);
  EXPECT_EQ(parseDecimal(text, out), DecimalStatus::ok) << text;
  return out.raw();
}

DecimalStatus statusOf(std::string_view text) {
  Fixed out = Fixed::fromRaw(12345);
  const DecimalStatus status = parseDecimal(text, out);
  if (status != DecimalStatus::ok) {
    EXPECT_EQ(out.raw(), 12345) << text;
  }
  return status;
}

static_assert(0.5_fixed == Fixed::fromRaw(std::int64_t{1} << 31));
static_assert(-2147483647.75_fixed ==
              -Fixed::fromRaw((std::int64_t{0x7fffffff} << 32) + (std::int64_t{3} << 30)));
static_assert(2147483647.9999999997671693563461304_fixed == Fixed::max());

TEST(FixedTextTest, EveryFormattedNumberReadsBack) {
  Random random;
  for (int i = 0; i < 200'000; ++i) {
    const Fixed x = Fixed::fromRaw(random.anySize());
    ASSERT_EQ(parsed(formatDecimal(x)), x.raw()) << formatDecimal(x);
  }
  for (const std::int64_t bits :
       {kMost, -kMost - 1, -kMost, std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}}) {
    EXPECT_EQ(parsed(formatDecimal(Fixed::fromRaw(bits))), bits);
  }
}

TEST(FixedTextTest, FormattedNumbersAreShortestForEveryFractionOf12Bits) {
  using Small = BasicFixed<std::int16_t, 12, Wrapping>;
  for (int bits = 1; bits < 4096; ++bits) {
    const Small x = Small::fromRaw(static_cast<std::int16_t>(bits));
    const std::string text = formatDecimal(x);
    Small back;
    ASSERT_EQ(parseDecimal(text, back), DecimalStatus::ok);
    ASSERT_EQ(back, x);
    // No decimal with one digit less reads back the same: the two around x are the nearest of that length.
    const int digits = static_cast<int>(text.size()) - 3;
    if (digits < 0) continue;
    std::int64_t scale = 1;
    for (int i = 0; i < digits; ++i) scale *= 10;
    for (const std::int64_t near : {bits * scale / 4096, bits * scale / 4096 + 1}) {
      std::string shorter = std::to_string(near);
      if (near >= scale) {
        shorter = "1.0";
      } else {
        shorter = "0." +
                  std::string(static_cast<std::size_t>(digits) - (digits == 0 ? 0 : shorter.size()), '0') +
                  shorter;
      }
      if (digits == 0) shorter = std::to_string(near);
      ASSERT_EQ(parseDecimal(shorter, back), DecimalStatus::ok) << shorter;
      ASSERT_NE(back, x) << text << " and shorter " << shorter;
    }
  }
}

TEST(FixedTextTest, InputIsRoundedOnceAtAnyLength) {
  // Half of a unit and a little less or more, 200 digits away.
  const std::string half = "0.000000000116415321826934814453125";
  EXPECT_EQ(parsed(half), 0);
  EXPECT_EQ(parsed(half + std::string(200, '0') + "1"), 1);
  EXPECT_EQ(parsed("-" + half + std::string(200, '0') + "1"), -1);
  EXPECT_EQ(parsed("0.000000000349245965480804443359375"), 2);  // 3/2 units: to even
  EXPECT_EQ(parsed("0.00000000034924596548080444335937" + std::string(200, '4')), 1);
}

TEST(FixedTextTest, ReadsEveryPermittedForm) {
  EXPECT_EQ(parsed("1"), Fixed(1).raw());
  EXPECT_EQ(parsed("+1."), Fixed(1).raw());
  EXPECT_EQ(parsed("-.5"), Fixed(-0.5).raw());
  EXPECT_EQ(parsed("-0"), 0);
  EXPECT_EQ(parsed("000012.50000"), Fixed(12.5).raw());
  EXPECT_EQ(parsed("125e-1"), Fixed(12.5).raw());
  EXPECT_EQ(parsed("0.000125E+5"), Fixed(12.5).raw());
  EXPECT_EQ(parsed("1e-999999999999"), 0);
  EXPECT_EQ(parsed("0e999999999999"), 0);
  EXPECT_EQ(parsed("0.00000000000000000000000000000000000000012e40"), Fixed(1.2).raw());
  EXPECT_EQ(parsed("-2147483648"), Fixed::lowest().raw());
}

TEST(FixedTextTest, RefusesWhatIsNoNumberInRange) {
  EXPECT_EQ(statusOf(""), DecimalStatus::empty);
  for (const char* text :
       {"-", "+", ".", "e5", "1e", "1e+", "1.2.3", " 1", "1 ", "0x10", "nan", "inf", "1,5", "--1"}) {
    EXPECT_EQ(statusOf(text), DecimalStatus::notANumber) << text;
  }
  for (const char* text : {"2147483648", "2147483647.9999999999", "-2147483648.0000000002", "1e10", "1e20",
                           "1e999999999", "99999999999999999999999999"}) {
    EXPECT_EQ(statusOf(text), DecimalStatus::outOfRange) << text;
  }
  EXPECT_EQ(statusOf(std::string(513, '0')), DecimalStatus::tooLong);
  EXPECT_EQ(parsed(std::string(512, '0')), 0);
}

TEST(FixedTextTest, StreamsWriteAndReadTheSameText) {
  std::stringstream stream;
  stream << Fixed(-12.25) << ' ' << Fixed::epsilon();
  EXPECT_EQ(stream.str(), "-12.25 0.0000000002");
  Fixed first, second;
  stream >> first >> second;
  EXPECT_EQ(first, Fixed(-12.25));
  EXPECT_EQ(second, Fixed::epsilon());
  std::stringstream bad("12x");
  bad >> first;
  EXPECT_TRUE(bad.fail());
}

}  // namespace
}  // namespace samestep
