// SPDX-License-Identifier: MIT
#include "study/chart_axis.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace samestep {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> labels(const LogAxis& axis) {
  std::vector<std::string> found;
  for (const LogAxis::Tick& tick : axis.ticks()) {
    if (!tick.label.empty()) found.push_back(tick.label);
  }
  return found;
}

TEST(ChartAxisTest, DecimalLogIsThatOfTheStandardLibrary) {
  for (const double x : {1e-12, 3e-5, 0.1, 0.999, 1.0, 2.0, 9.99, 10.0, 12345.6, 7e9}) {
    EXPECT_NEAR(decimalLog(x), std::log10(x), 1e-9) << x;
  }
}

TEST(ChartAxisTest, PowersOfTenAreLabelledWhereThreeAreOnTheAxis) {
  EXPECT_THAT(labels(LogAxis(0.004, 30)), ElementsAre("0.01", "0.1", "1", "10"));
}

TEST(ChartAxisTest, AShortAxisHasMoreLabels) {
  EXPECT_THAT(labels(LogAxis(0.3, 11)), ElementsAre("0.5", "1", "2", "5", "10"));
  EXPECT_THAT(labels(LogAxis(0.01, 0.03)), ElementsAre("0.01", "0.02", "0.03"));
}

TEST(ChartAxisTest, SmallAndLargePowersAreWrittenShort) {
  EXPECT_THAT(labels(LogAxis(1e-7, 1e-5)), ElementsAre("1e-7", "1e-6", "1e-5"));
  EXPECT_THAT(labels(LogAxis(1e4, 1e6)), ElementsAre("10000", "100000", "1e+06"));
}

TEST(ChartAxisTest, TicksRiseAndStandWhereTheirValuesDo) {
  const LogAxis axis(0.02, 7);
  double last = 0;
  for (const LogAxis::Tick& tick : axis.ticks()) {
    EXPECT_GT(tick.value, last);
    EXPECT_GE(axis.place(tick.value), 0);
    EXPECT_LE(axis.place(tick.value), 1);
    last = tick.value;
  }
  EXPECT_NEAR(axis.place(1) - axis.place(0.1), axis.place(0.5) - axis.place(0.05), 1e-9);
}

TEST(ChartAxisTest, TheRangeHasRoomAndWhatIsOutsideIsHeldAtTheEnd) {
  const LogAxis axis(0.1, 10);

  EXPECT_GT(axis.place(0.1), 0);
  EXPECT_LT(axis.place(10), 1);
  EXPECT_NEAR(axis.place(1), 0.5, 1e-9);
  EXPECT_EQ(axis.place(0), 0);
  EXPECT_EQ(axis.place(1e-9), 0);
  EXPECT_EQ(axis.place(1e9), 1);
}

TEST(ChartAxisTest, OneValueMakesAnAxisAroundIt) {
  const LogAxis axis(2, 2);

  EXPECT_NEAR(axis.place(2), 0.5, 1e-9);
  EXPECT_GE(labels(axis).size(), 2u);
}

}  // namespace
}  // namespace samestep
