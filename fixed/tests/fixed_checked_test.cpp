#include "samestep/fixed_checked.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "samestep/fixed_math.h"
#include "samestep/high_water.h"
#include "samestep/scaled.h"
#include "samestep/wide.h"

namespace samestep {
namespace {

using C = CheckedFixed;

/// The text of the report that the operation makes, or nothing.
template <class Operation>
std::string reportOf(Operation operation) {
  try {
    static_cast<void>(operation());
  } catch (const FixedOverflow& overflow) {
    return overflow.what();
  }
  return "";
}

TEST(FixedCheckedTest, EveryOperationNamesItselfAndItsOperands) {
  const C large(2000000000);
  EXPECT_EQ(reportOf([&] { return large + large; }), "add(2000000000, 2000000000)");
  EXPECT_EQ(reportOf([&] { return -large - large; }), "subtract(-2000000000, 2000000000)");
  EXPECT_EQ(reportOf([&] { return -C::lowest(); }), "negate(-2147483648)");
  EXPECT_EQ(reportOf([&] { return large * C(-2); }), "multiply(2000000000, -2)");
  EXPECT_EQ(reportOf([&] { return large / C(0.5); }), "divide(2000000000, 0.5)");
  EXPECT_EQ(reportOf([&] { return C(1) / C(); }), "divide(1, 0)");
  EXPECT_EQ(reportOf([&] { return reciprocal(C::epsilon()); }), "reciprocal(0.0000000002)");
  EXPECT_EQ(reportOf([&] { return mulAdd(C(1), large, large); }), "mulAdd(1, 2000000000, 2000000000)");
  EXPECT_EQ(reportOf([&] { return dot(C(1), large, C(1), large); }), "dot(1, 2000000000, 1, 2000000000)");
  EXPECT_EQ(reportOf([&] { return cross(C(1), large, C(-1), large); }),
            "cross(1, 2000000000, -1, 2000000000)");
  EXPECT_EQ(reportOf([&] { return mulDiv(large, C(4), C(2)); }), "mulDiv(2000000000, 4, 2)");
  EXPECT_EQ(reportOf([&] { return sqrt(C(-4)); }), "sqrt(-4)");
  EXPECT_EQ(reportOf([&] { return length(large, large); }), "length(2000000000, 2000000000)");
  EXPECT_EQ(reportOf([&] { return log2(C()); }), "log2(0)");
  EXPECT_EQ(reportOf([&] { return exp(C(22)); }), "exp(22)");
  EXPECT_EQ(reportOf([&] { return exp2(C(31)); }), "exp2(31)");
  EXPECT_EQ(reportOf([&] { return pow(C(-2), C(2)); }), "pow(-2, 2)");
  EXPECT_EQ(reportOf([&] { return pow(C(), C(-1)); }), "pow(0, -1)");
  EXPECT_EQ(reportOf([&] { return C(3e9); }), "fromDouble(2147483647.9999999998)");
  EXPECT_EQ(reportOf([&] { return C(std::numeric_limits<double>::quiet_NaN()); }), "fromDouble(0)");
  EXPECT_EQ(reportOf([&] { return C(std::int64_t{3000000000}); }), "fromInteger(3000000000)");
  EXPECT_NE(reportOf([&] { return toScalar(exactDot(large, large, large, large)); }), "");
  EXPECT_NE(reportOf([&] { return toScalar<C>(toScaled(large) * toScaled(large)); }), "");
}

TEST(FixedCheckedTest, ResultsThatFitAreNotReported) {
  const C large(2000000000);
  // The terms leave the range, their sum does not.
  EXPECT_EQ(reportOf([&] { return cross(large, C(3), large, C(3)); }), "");
  EXPECT_EQ(reportOf([&] { return dot(large, large, large, -large); }), "");
  EXPECT_EQ(reportOf([&] { return mulDiv(large, large, large); }), "");
  EXPECT_EQ(reportOf([&] { return C::lowest() * C(1); }), "");
  EXPECT_EQ(reportOf([&] { return exp2(C(-40)); }), "");
}

TEST(FixedCheckedTest, AHandlerThatReturnsGetsTheWrappingResult) {
  static int reports;
  reports = 0;
  const OverflowHandler before = setOverflowHandler([](const OverflowReport&) { ++reports; });
  const C sum = C(2000000000) + C(2000000000);
  setOverflowHandler(before);
  EXPECT_EQ(reports, 1);
  EXPECT_EQ(sum.raw(), (Fixed(2000000000) + Fixed(2000000000)).raw());
}

TEST(HighWaterTest, KeepsTheLargestMagnitudeByNameInOrderOfFirstUse) {
  highWaterTable().clear();
  highWater<C>("impulse", C(3));
  highWater<C>("mass", C(1));
  highWater<C>("impulse", C(-5));
  highWater<C>("impulse", C(4));
  highWater<Fixed>("ignored", Fixed(9));
  highWater<double>("ignored", 9.0);
  const auto marks = highWaterTable().marks();
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_EQ(marks[0].name, "impulse");
  EXPECT_EQ(marks[0].value(), 5.0);
  EXPECT_EQ(marks[0].count, 3u);
  EXPECT_EQ(marks[1].name, "mass");
}

}  // namespace
}  // namespace samestep
