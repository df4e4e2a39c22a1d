// SPDX-License-Identifier: MIT
#include "study/chart.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace samestep {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ChartPoint point(int count, double milliseconds, double error) {
  ChartPoint made;
  made.count = count;
  made.milliseconds = made.fastest = made.slowest = milliseconds;
  made.error = made.overlap = made.lowQuartile = made.highQuartile = error;
  return made;
}

Chart example() {
  Chart chart;
  chart.scene = "heap";
  chart.kind = "rest";
  chart.measure = {"How far they are off."};
  chart.lines = {{"slow", "fixed", "substeps", {point(1, 2, 0.5), point(2, 4, 0.02)}},
                 {"quick", "double", "iterations", {point(2, 1, 0.4), point(4, 3, 0.1), point(8, 5, 0.1)}}};
  markFront(chart);
  return chart;
}

std::vector<int> countsOnFront(const Chart& chart) {
  std::vector<int> counts;
  for (const FrontPoint& mark : frontOf(chart)) counts.push_back(mark.point->count);
  return counts;
}

int times(const std::string& text, const std::string& part) {
  int found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(ChartTest, FrontHoldsWhatNothingFasterMatchesFastestFirst) {
  EXPECT_EQ(countsOnFront(example()), (std::vector<int>{2, 4, 2}));
  EXPECT_EQ(frontOf(example())[2].line->method, "slow");
}

TEST(ChartTest, FrontLeavesOutWhatIsSlowerAndLessThanAHundredthBetter) {
  Chart chart;
  chart.lines = {{"a", "double", "substeps", {point(1, 1, 1), point(2, 2, 0.995), point(3, 3, 0.98)}}};
  markFront(chart);

  EXPECT_EQ(countsOnFront(chart), (std::vector<int>{1, 3}));
}

TEST(ChartTest, OfTwoEquallyFastTheMoreAccurateIsOnTheFront) {
  Chart chart;
  chart.lines = {{"a", "double", "substeps", {point(1, 1, 1), point(2, 1, 0.5)}}};
  markFront(chart);

  EXPECT_EQ(countsOnFront(chart), std::vector<int>{2});
}

TEST(ChartTest, APerfectResultEndsTheFront) {
  Chart chart;
  chart.lines = {{"a", "double", "substeps", {point(1, 1, 0.1), point(2, 2, 0), point(3, 3, 0)}}};
  markFront(chart);

  EXPECT_EQ(countsOnFront(chart), (std::vector<int>{1, 2}));
}

TEST(ChartTest, CsvHasAHeaderAndARowForEachPoint) {
  const std::string csv = chartCsv(example());

  EXPECT_THAT(csv, ::testing::StartsWith("scene,method,scalar,steps_per_second,unit,count,ms_per_second,"));
  EXPECT_EQ(times(csv, "\n"), 6);
  EXPECT_THAT(csv, HasSubstr("\nheap,slow,fixed,60,substeps,2,4,4,4,0.02,0.02,0.02,0.02,0,rest,yes,\n"));
  EXPECT_THAT(csv, HasSubstr("\nheap,slow,fixed,60,substeps,1,2,2,2,0.5,0.5,0.5,0.5,0,rest,no,\n"));
}

TEST(ChartTest, CsvQuotesASceneWithACommaInItsName) {
  Chart chart = example();
  chart.scene = "a,\"b\"";

  EXPECT_THAT(chartCsv(chart), HasSubstr("\n\"a,\"\"b\"\"\",slow,"));
}

TEST(ChartTest, PictureHasALinePerMethodAndARingPerPointOfTheFront) {
  const std::string svg = drawChart(example());

  EXPECT_EQ(times(svg, "<polyline"), 2);
  // And one in the legend.
  EXPECT_EQ(times(svg, "r=\"8\""), 4);
  for (const char* words : {"heap", "How far they are off.", "slow", "quick", "time per simulated second, ms",
                            "error, m", "prefers-color-scheme: dark", "</svg>"}) {
    EXPECT_THAT(svg, HasSubstr(words));
  }
}

TEST(ChartTest, PictureShowsHowFarTheReferenceIsOffWhereThatIsOnTheAxis) {
  Chart chart = example();
  EXPECT_THAT(drawChart(chart), Not(HasSubstr("reference may be")));
  chart.resolution = 0.05;
  EXPECT_THAT(drawChart(chart), HasSubstr("reference may be"));
  chart.resolution = 1e-9;
  EXPECT_THAT(drawChart(chart), Not(HasSubstr("reference may be")));
}

TEST(ChartTest, WhatFailedIsNoPointOfTheFrontAndACrossInThePicture) {
  Chart chart = example();
  EXPECT_THAT(drawChart(chart), Not(HasSubstr("a step failed")));
  chart.lines[1].points[0].failure = "too fast, at 3 m";
  chart.lines[1].points[0].milliseconds = 0;
  markFront(chart);

  EXPECT_EQ(countsOnFront(chart), (std::vector<int>{1, 4, 2}));
  EXPECT_THAT(drawChart(chart), HasSubstr("a step failed"));
  EXPECT_THAT(chartCsv(chart), HasSubstr(",no,\"too fast, at 3 m\"\n"));
}

TEST(ChartTest, PictureHasABarFromQuartileToQuartile) {
  Chart chart = example();
  const int before = times(drawChart(chart), "<path class=\"line0\"");
  chart.lines[0].points[0].highQuartile = 0.6;

  EXPECT_EQ(times(drawChart(chart), "<path class=\"line0\""), before + 1);
}

TEST(ChartTest, PictureShowsTheBudgetOfAStepWhereThatIsOnTheAxis) {
  Chart chart = example();
  EXPECT_THAT(drawChart(chart), Not(HasSubstr("16 ms a step")));
  chart.lines[0].points[0].milliseconds = 2000;
  EXPECT_THAT(drawChart(chart), HasSubstr("16 ms a step"));
}

TEST(ChartTest, PictureEscapesWhatItIsGiven) {
  Chart chart = example();
  chart.scene = "a<b&c";

  EXPECT_THAT(drawChart(chart), HasSubstr("a&lt;b&amp;c"));
  EXPECT_THAT(drawChart(chart), Not(HasSubstr("a<b")));
}

TEST(ChartTest, PictureOfPerfectResultsCanBeDrawn) {
  Chart chart;
  chart.lines = {{"a", "double", "substeps", {point(1, 1, 0)}}};
  markFront(chart);

  EXPECT_THAT(drawChart(chart), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace samestep
