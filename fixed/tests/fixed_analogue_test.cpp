// The algebra on small analogues of the type, the same templates over 8 bits: every pair of values, every
// triple for the fused operations, against plain integers. fixed_pairs does every pair of 16 bits.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>

#include "samestep/fixed_math.h"
#include "small_reference.h"

namespace samestep {
namespace {

using Tiny = BasicFixed<std::int8_t, 4, Wrapping>;

constexpr int kLeast = -128, kMost = 127;

Tiny tiny(int bits) { return Tiny::fromRaw(static_cast<std::int8_t>(bits)); }

template <class Check>
void forPairs(Check check) {
  for (int a = kLeast; a <= kMost; ++a) {
    for (int b = kLeast; b <= kMost; ++b) check(a, b);
  }
}

TEST(FixedAnalogueTest, SumsWrapAndFormAGroup) {
  forPairs([](int a, int b) {
    ASSERT_EQ((tiny(a) + tiny(b)).raw(), static_cast<std::int8_t>(a + b));
    ASSERT_EQ((tiny(a) - tiny(b)).raw(), static_cast<std::int8_t>(a - b));
    ASSERT_EQ(tiny(a) + tiny(b), tiny(b) + tiny(a));
    ASSERT_EQ(tiny(a) + tiny(b) - tiny(b), tiny(a));
    ASSERT_EQ(-(tiny(a) - tiny(b)), tiny(b) - tiny(a));
  });
}

TEST(FixedAnalogueTest, SumsAreAssociativeForEveryTriple) {
  forPairs([](int a, int b) {
    for (int c = kLeast; c <= kMost; ++c) {
      ASSERT_EQ((tiny(a) + tiny(b)) + tiny(c), tiny(a) + (tiny(b) + tiny(c)));
    }
  });
}

TEST(FixedAnalogueTest, ProductsAreTheExactOnesRounded) {
  forPairs([](int a, int b) {
    const std::int64_t exact = roundedQuotientOf(a * b, 16);
    ASSERT_EQ((tiny(a) * tiny(b)).raw(), static_cast<std::int8_t>(exact)) << a << ' ' << b;
    ASSERT_EQ(tiny(a) * tiny(b), tiny(b) * tiny(a));
    ASSERT_EQ(tiny(a) * Tiny(1), tiny(a));
    // Rounding is symmetric.
    if (a != kLeast) {
      ASSERT_EQ(-tiny(a) * tiny(b), -(tiny(a) * tiny(b)));
    }
  });
}

TEST(FixedAnalogueTest, FusedSumsAreRoundedOnceForEveryTriple) {
  forPairs([](int a, int b) {
    for (int c = kLeast; c <= kMost; ++c) {
      ASSERT_EQ(mulAdd(tiny(a), tiny(b), tiny(c)).raw(),
                static_cast<std::int8_t>(roundedQuotientOf(a * b + 16 * c, 16)));
      ASSERT_EQ(dot(tiny(a), tiny(b), tiny(c), tiny(a)).raw(),
                static_cast<std::int8_t>(roundedQuotientOf(a * b + c * a, 16)));
      ASSERT_EQ(cross(tiny(a), tiny(b), tiny(c), tiny(b)).raw(),
                static_cast<std::int8_t>(roundedQuotientOf(a * b - c * b, 16)));
      ASSERT_EQ(dot4(tiny(a), tiny(b), tiny(c), tiny(a), tiny(b), tiny(b), tiny(c), tiny(c)).raw(),
                static_cast<std::int8_t>(roundedQuotientOf(a * b + c * a + b * b + c * c, 16)));
    }
  });
}

TEST(FixedAnalogueTest, MulDivIsRoundedOnceForEveryTriple) {
  forPairs([](int a, int b) {
    for (int c = kLeast; c <= kMost; ++c) {
      ASSERT_EQ(mulDiv(tiny(a), tiny(b), tiny(c)).raw(), saturatedQuotientOf(a * b, c, kLeast, kMost));
    }
  });
}

TEST(FixedAnalogueTest, QuotientsAreTheExactOnesRoundedOrSaturated) {
  forPairs([](int a, int b) {
    ASSERT_EQ((tiny(a) / tiny(b)).raw(), saturatedQuotientOf(a * 16, b, kLeast, kMost)) << a << ' ' << b;
  });
  for (int a = kLeast; a <= kMost; ++a) {
    ASSERT_EQ(reciprocal(tiny(a)).raw(), saturatedQuotientOf(256, a, kLeast, kMost));
  }
}

TEST(FixedAnalogueTest, OrderIsThatOfTheBits) {
  forPairs([](int a, int b) {
    ASSERT_EQ(tiny(a) <=> tiny(b), a <=> b);
    ASSERT_EQ(min(tiny(a), tiny(b)).raw(), a < b ? a : b);
    ASSERT_EQ(max(tiny(a), tiny(b)).raw(), a < b ? b : a);
  });
}

TEST(FixedAnalogueTest, RootsAreTheNearest) {
  for (int a = 0; a <= kMost; ++a) ASSERT_TRUE(isNearestRoot(sqrt(tiny(a)).raw(), a * 16)) << a;
  forPairs([](int a, int b) {
    const int found = length(tiny(a), tiny(b)).raw();
    const int square = a * a + b * b;
    // Saturated where the root rounds to more than fits.
    if (square > kMost * kMost + kMost) {
      ASSERT_EQ(found, kMost);
    } else {
      ASSERT_TRUE(isNearestRoot(found, square)) << a << ' ' << b;
    }
  });
}

TEST(FixedAnalogueTest, UnitVectorsAreTheNearest) {
  forPairs([](int a, int b) {
    const Components<Tiny> unit = normalize(tiny(a), tiny(b));
    if (a == 0 && b == 0) {
      ASSERT_EQ(unit, (Components<Tiny>{}));
      return;
    }
    ASSERT_TRUE(isNearestComponent(unit.x.raw(), a, b, 16)) << a << ' ' << b;
    ASSERT_TRUE(isNearestComponent(unit.y.raw(), b, a, 16)) << a << ' ' << b;
  });
}

TEST(FixedAnalogueTest, CheckedReportsExactlyWhatDoesNotFit) {
  using CheckedTiny = BasicFixed<std::int8_t, 4, Checked>;
  static int reports;
  const OverflowHandler before = setOverflowHandler([](const OverflowReport&) { ++reports; });
  const auto checked = [](int bits) { return CheckedTiny::fromRaw(static_cast<std::int8_t>(bits)); };
  const auto reported = [](auto operation) {
    reports = 0;
    const auto result = operation();
    return std::pair(reports != 0, static_cast<int>(result.raw()));
  };
  const auto outside = [](std::int64_t x) { return x < kLeast || x > kMost; };
  forPairs([&](int a, int b) {
    const auto sum = reported([&] { return checked(a) + checked(b); });
    ASSERT_EQ(sum.first, outside(a + b)) << a << ' ' << b;
    const auto difference = reported([&] { return checked(a) - checked(b); });
    ASSERT_EQ(difference.first, outside(a - b)) << a << ' ' << b;
    const auto product = reported([&] { return checked(a) * checked(b); });
    ASSERT_EQ(product.first, outside(roundedQuotientOf(a * b, 16))) << a << ' ' << b;
    ASSERT_EQ(product.second, (tiny(a) * tiny(b)).raw());
    const auto crossed = reported([&] { return cross(checked(a), checked(b), checked(b), checked(b)); });
    ASSERT_EQ(crossed.first, outside(roundedQuotientOf(a * b - b * b, 16))) << a << ' ' << b;
    const auto quotient = reported([&] { return checked(a) / checked(b); });
    ASSERT_EQ(quotient.first, b == 0 || outside(roundedQuotientOf(a * 16, b))) << a << ' ' << b;
    ASSERT_EQ(quotient.second, (tiny(a) / tiny(b)).raw());
  });
  setOverflowHandler(before);
}

}  // namespace
}  // namespace samestep
