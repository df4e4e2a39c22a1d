// SPDX-License-Identifier: MIT
#include "study/tune.h"

#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samestep/scene.h>

#include "support/scalars.h"

namespace samestep {
namespace {

using ::testing::HasSubstr;

ChartPoint point(int count, double millisecondsPerStep, double error) {
  ChartPoint made;
  made.count = count;
  made.milliseconds = 60 * millisecondsPerStep;
  made.error = error;
  return made;
}

Chart example() {
  Chart chart;
  chart.scene = "heap";
  chart.kind = "rest";
  chart.lines = {
      {"soft", "fixed", "substeps", {point(1, 2, 0.5), point(4, 4, 0.02)}},
      {"impulses", "double", "iterations", {point(2, 1, 0.4), point(4, 3, 0.1), point(8, 5, 0.01)}}};
  chart.lines[1].solver = SolverKind::sequentialImpulses;
  return chart;
}

TEST(TuneTest, FindsTheCheapestSettingOfAnError) {
  const Chart chart = example();

  EXPECT_EQ(tune(chart, {.error = 0.45}).found.point, &chart.lines[1].points[0]);
  EXPECT_EQ(tune(chart, {.error = 0.05}).found.point, &chart.lines[0].points[1]);
  EXPECT_EQ(tune(chart, {.error = 0.01}).found.point, &chart.lines[1].points[2]);
}

TEST(TuneTest, FindsTheMostAccurateSettingOfABudget) {
  const Chart chart = example();

  EXPECT_EQ(tune(chart, {.budget = 4.5}).found.point, &chart.lines[0].points[1]);
  EXPECT_EQ(tune(chart, {.budget = 3.5}).found.point, &chart.lines[1].points[1]);
}

TEST(TuneTest, SaysTheNearestWhereNothingReachesTheGoal) {
  const Chart chart = example();

  const Tuned accurate = tune(chart, {.error = 0.001});
  EXPECT_EQ(accurate.found.point, nullptr);
  EXPECT_EQ(accurate.nearest.point, &chart.lines[1].points[2]);
  const Tuned quick = tune(chart, {.budget = 0.5});
  EXPECT_EQ(quick.found.point, nullptr);
  EXPECT_EQ(quick.nearest.point, &chart.lines[1].points[0]);
  EXPECT_EQ(tune(chart, {.error = 0.05, .budget = 3}).found.point, nullptr);
}

TEST(TuneTest, LeavesOutWhatFailed) {
  Chart chart = example();
  chart.lines[1].points[0].failure = "too fast";
  EXPECT_EQ(tune(chart, {.error = 0.45}).found.point, &chart.lines[1].points[1]);
  for (ChartLine& line : chart.lines) {
    for (ChartPoint& one : line.points) one.failure = "too fast";
  }

  const Tuned none = tune(chart, {.error = 1});
  EXPECT_EQ(none.found.point, nullptr);
  EXPECT_EQ(none.nearest.point, nullptr);
}

TEST(TuneTest, KnowsTheDefaultSettings) {
  const Chart chart = example();

  EXPECT_EQ(tune(chart, {.error = 0.05}).usual.point, &chart.lines[0].points[1]);
  EXPECT_EQ(tune(chart, {.error = 0.01}).usual.point, nullptr);  // none in double
}

TEST(TuneTest, AGoalHasABoundThatIsANumber) {
  EXPECT_THROW(tune(example(), {}), std::invalid_argument);
  EXPECT_THROW(tune(example(), {.error = -1}), std::invalid_argument);
  EXPECT_THROW(tune(example(), {.budget = std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
}

template <class S>
class TunedSettingsTest : public ::testing::Test {};
TYPED_TEST_SUITE(TunedSettingsTest, AllScalars);

TYPED_TEST(TunedSettingsTest, WhatIsWrittenIsWhatASpaceTakes) {
  Chart chart = example();
  chart.lines[0].precision = ContactPrecision::fast;
  chart.lines[0].stepsPerSecond = 120;
  Space<TypeParam> space;

  EXPECT_EQ(useSettings(space, settingsJson(chart, {&chart.lines[1], &chart.lines[1].points[2]}), "a.json"),
            60u);
  EXPECT_EQ(space.settings().solver, SolverKind::sequentialImpulses);
  EXPECT_EQ(space.settings().iterations, 8);
  EXPECT_EQ(useSettings(space, settingsJson(chart, {&chart.lines[0], &chart.lines[0].points[0]}), "a.json"),
            120u);
  EXPECT_EQ(space.settings().solver, SolverKind::softStep);
  EXPECT_EQ(space.settings().precision, ContactPrecision::fast);
  EXPECT_EQ(space.settings().substeps, 1);
}

TYPED_TEST(TunedSettingsTest, SettingsThatAreRefusedChangeNothing) {
  Space<TypeParam> space;
  const std::uint64_t before = space.hash();

  for (const char* text :
       {R"({"settings": {"iterations": 3, "substeps": 0}})", R"({"settings": {"steps": 3}})",
        R"({"stepsPerSecond": 0, "settings": {"iterations": 3}})", "[]", "null", "{"}) {
    try {
      useSettings(space, text, "mine.json");
      FAIL() << text;
    } catch (const SceneError& error) {
      EXPECT_THAT(error.what(), HasSubstr("mine.json"));
    }
    EXPECT_EQ(space.hash(), before) << text;
  }
}

TYPED_TEST(TunedSettingsTest, StandInForThoseOfAScene) {
  SceneSource source = SceneSource::find("pyramid:3");
  source.useSettings(R"({"scalar": "fixed", "stepsPerSecond": 120, "settings": {"substeps": 7}})",
                     "mine.json");
  const Scene<TypeParam> scene(source);

  EXPECT_EQ(scene.space().settings().substeps, 7);
  EXPECT_EQ(scene.timeStep(), ratio<TypeParam>(1, 120));
}

}  // namespace
}  // namespace samestep
