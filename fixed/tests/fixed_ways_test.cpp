// Every way this compiler can build gives the same bits, on edges and random numbers.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "samestep/raw_functions.h"
#include "test_random.h"

namespace samestep {
namespace {

constexpr std::int64_t kMost = 0x7fffffffffffffff, kLeast = -kMost - 1;
constexpr int kRandomPairs = 300'000;

std::vector<std::int64_t> edges() {
  std::vector<std::int64_t> result = {0, kMost, kLeast, kLeast + 1};
  for (int bit = 0; bit < 63; bit += 1) {
    for (const std::int64_t offset : {-1, 0, 1}) {
      const std::int64_t x = (std::int64_t{1} << bit) + offset;
      result.push_back(x);
      result.push_back(-x);
    }
  }
  return result;
}

/// Calls check(a, b) on all pairs of edges and on random pairs.
template <class Check>
void forPairs(Check check) {
  const std::vector<std::int64_t> special = edges();
  for (const std::int64_t a : special) {
    for (const std::int64_t b : special) check(a, b);
  }
  Random random;
  for (int i = 0; i < kRandomPairs; ++i) {
    const std::int64_t a = random.anySize();
    const std::int64_t b = random.anySize();
    check(a, b);
  }
}

template <class Way>
class FixedWaysTest : public ::testing::Test {};
using Ways = ::testing::Types<way::Hardware, way::Native, way::Portable,
                              way::Way<way::NativeWords, way::DivideByDouble, way::RootByDouble>>;
TYPED_TEST_SUITE(FixedWaysTest, Ways);

using Reference = way::IntegerOnly;

bool operator==(const raw::Quotient& a, const raw::Quotient& b) { return a.raw == b.raw && a.fits == b.fits; }

template <class Way>
std::int64_t sumOfFour(std::int64_t a, std::int64_t b) {
  way::Sum<typename Way::Words, 32> sum;
  sum.plus(a, b);
  sum.minus(b, b);
  sum.plus(a ^ 5, b ^ 9);
  sum.minus(a, a);
  sum.plus(b >> 3);
  return sum.rounded();
}

template <class Way>
constexpr std::int64_t product(std::int64_t a, std::int64_t b) {
  way::Sum<typename Way::Words, 32> sum;
  sum.plus(a, b);
  return sum.rounded();
}

template <class Way>
std::int64_t productOfOtherBits(std::int64_t a, std::int64_t b) {
  way::Sum<typename Way::Words, 20> sum;
  sum.plus(a, b);
  sum.plus(a);
  return sum.rounded();
}

TYPED_TEST(FixedWaysTest, SumsOfProductsAgree) {
  forPairs([](std::int64_t a, std::int64_t b) {
    ASSERT_EQ(product<TypeParam>(a, b), product<Reference>(a, b)) << a << ' ' << b;
    ASSERT_EQ(sumOfFour<TypeParam>(a, b), sumOfFour<Reference>(a, b)) << a << ' ' << b;
    ASSERT_EQ(productOfOtherBits<TypeParam>(a, b), productOfOtherBits<Reference>(a, b)) << a << ' ' << b;
  });
}

TYPED_TEST(FixedWaysTest, QuotientsAgree) {
  forPairs([](std::int64_t a, std::int64_t b) {
    ASSERT_TRUE(
        (raw::divide<TypeParam, 32>(a, b, kLeast, kMost) == raw::divide<Reference, 32>(a, b, kLeast, kMost)))
        << a << ' ' << b;
    ASSERT_TRUE(
        (raw::divide<TypeParam, 64>(1, b, kLeast, kMost) == raw::divide<Reference, 64>(1, b, kLeast, kMost)))
        << b;
    ASSERT_TRUE((raw::mulDiv<TypeParam>(a, b, a ^ b, kLeast, kMost) ==
                 raw::mulDiv<Reference>(a, b, a ^ b, kLeast, kMost)))
        << a << ' ' << b;
  });
}

TYPED_TEST(FixedWaysTest, RootsAgree) {
  forPairs([](std::int64_t a, std::int64_t b) {
    ASSERT_EQ((raw::squareRoot<TypeParam, 32>(a)), (raw::squareRoot<Reference, 32>(a))) << a;
    ASSERT_TRUE(raw::length<TypeParam>(a, b, kMost) == raw::length<Reference>(a, b, kMost)) << a << ' ' << b;
    ASSERT_EQ((raw::normalize<TypeParam, 32>(a, b)), (raw::normalize<Reference, 32>(a, b))) << a << ' ' << b;
  });
}

TYPED_TEST(FixedWaysTest, FunctionsAgree) {
  forPairs([](std::int64_t a, std::int64_t b) {
    ASSERT_EQ(raw::sincos<TypeParam>(a), raw::sincos<Reference>(a)) << a;
    ASSERT_EQ(raw::atan2<TypeParam>(a, b), raw::atan2<Reference>(a, b)) << a << ' ' << b;
    ASSERT_TRUE(raw::exp2<TypeParam>(a) == raw::exp2<Reference>(a)) << a;
    ASSERT_TRUE(raw::exp<TypeParam>(a) == raw::exp<Reference>(a)) << a;
    ASSERT_EQ(raw::log2<TypeParam>(a), raw::log2<Reference>(a)) << a;
    ASSERT_TRUE(raw::pow<TypeParam>(a, b) == raw::pow<Reference>(a, b)) << a << ' ' << b;
  });
}

TYPED_TEST(FixedWaysTest, LongDivisionLeavesItsRemainder) {
  Random random;
  for (int i = 0; i < kRandomPairs; ++i) {
    const std::uint64_t divisor = (random.next() >> random.next() % 64) | 1;
    const std::uint64_t high = random.next() % divisor, low = random.next();
    const QuotientRemainder result = TypeParam::Divide::divide(high, low, divisor);
    ASSERT_LT(result.remainder, divisor);
    ASSERT_EQ(multiplyHalves(result.quotient, divisor) + (Halves{0, result.remainder}), (Halves{high, low}));
  }
}

// Compile-time evaluation takes the integer way, run time the chosen one.
TEST(FixedWaysTest, CompileTimeAgreesWithRunTime) {
  constexpr std::int64_t kX = 7297352569, kY = -13743895347;
  constexpr raw::RawSinCos kSinCos = raw::sincos<way::Chosen>(kX);
  constexpr raw::RawComponents kUnit = raw::normalize<way::Chosen, 32>(kX, kY);
  constexpr std::int64_t kRoot = raw::squareRoot<way::Chosen, 32>(kX);
  constexpr std::int64_t kQuotient = raw::divide<way::Chosen, 32>(kX, kY, kLeast, kMost).raw;
  constexpr std::int64_t kProduct = product<way::Chosen>(kX, kY);
  volatile std::int64_t xAtRunTime = kX, yAtRunTime = kY;
  const std::int64_t x = xAtRunTime, y = yAtRunTime;
  EXPECT_EQ(raw::sincos<way::Chosen>(x), kSinCos);
  EXPECT_EQ((raw::normalize<way::Chosen, 32>(x, y)), kUnit);
  EXPECT_EQ((raw::squareRoot<way::Chosen, 32>(x)), kRoot);
  EXPECT_EQ((raw::divide<way::Chosen, 32>(x, y, kLeast, kMost).raw), kQuotient);
  EXPECT_EQ(product<way::Chosen>(x, y), kProduct);
}

}  // namespace
}  // namespace samestep
