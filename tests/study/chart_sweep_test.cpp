// SPDX-License-Identifier: MIT
#include "study/chart_sweep.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/method.h"

namespace samestep {
namespace {

using ::testing::HasSubstr;

Chart sweep(const SceneSource& source, std::uint64_t steps) {
  SweepOptions options;
  options.steps = steps;
  options.rounds = 1;
  options.leastSeconds = 0;
  return sweepScene(source, options);
}

/// On the ground, whose top is at 1 m.
SceneSource fallingBall() {
  return SceneSource::fromText(R"({"samestep": 1, "settings": {"gravity": [0, -10]}, "bodies": [
      {"type": "static", "shapes": [{"box": [20, 2]}]},
      {"position": [0, 2], "shapes": [{"circle": 0.5, "density": 1}]}]})",
                               "ball.json");
}

TEST(ChartSweepTest, RunsEveryMethodWithEveryCount) {
  const Chart chart = sweep(SceneSource::find("pyramid:3"), 12);

  ASSERT_EQ(chart.lines.size(), methods().size());
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    const ChartLine& line = chart.lines[i];
    EXPECT_EQ(line.method, methods()[i].name);
    ASSERT_EQ(line.points.size(), methods()[i].counts.size());
    for (std::size_t k = 0; k < line.points.size(); ++k) {
      EXPECT_EQ(line.points[k].count, methods()[i].counts[k]);
      EXPECT_GT(line.points[k].milliseconds, 0);
    }
  }
  EXPECT_FALSE(frontOf(chart).empty());
}

TEST(ChartSweepTest, TheSoftStepHasALineForEachKernel) {
  SweepOptions options;
  options.steps = 12;
  options.rounds = 1;
  options.leastSeconds = 0;
  options.kernels = {KernelTarget::portable, KernelTarget::best};
  const Chart chart = sweepScene(SceneSource::find("pyramid:3"), options);

  std::size_t expected = 0;
  for (const Method& method : methods()) {
    const bool soft = method.solver == SolverKind::softStep;
    const ChartLine& line = chart.lines.at(expected);
    EXPECT_EQ(line.method, std::string(method.name) + (soft ? " (portable)" : ""));
    if (soft) {
      const ChartLine& best = chart.lines.at(expected + 1);
      EXPECT_EQ(best.method, std::string(method.name) + " (best)");
      for (std::size_t k = 0; k < line.points.size(); ++k) {
        EXPECT_EQ(line.points[k].error, best.points[k].error);
      }
    }
    expected += soft ? 2 : 1;
  }
  EXPECT_EQ(chart.lines.size(), expected);
}

TEST(ChartSweepTest, ErrorsAreTheSameInEveryRunOfTheProgram) {
  const SceneSource source = SceneSource::find("bounce");
  const Chart a = sweep(source, 90);
  const Chart b = sweep(source, 90);

  for (std::size_t i = 0; i < a.lines.size(); ++i) {
    for (std::size_t k = 0; k < a.lines[i].points.size(); ++k) {
      EXPECT_EQ(a.lines[i].points[k].error, b.lines[i].points[k].error);
    }
  }
}

TEST(ChartSweepTest, AnExactAnswerIsWhatErrorsAreMeasuredBy) {
  const Chart chart = sweep(SceneSource::find("pyramid:2"), 6);

  EXPECT_EQ(chart.kind, "exact");
  EXPECT_THAT(chart.measure[0], HasSubstr("exact answer"));
}

TEST(ChartSweepTest, AUsersSceneOfTheSameNameHasNoExactAnswer) {
  const SceneSource source = SceneSource::fromText(R"({"samestep": 1, "bodies": [
      {"velocity": [1, 0], "shapes": [{"circle": 0.5, "density": 1}]}]})",
                                                   "incline");

  EXPECT_EQ(sweep(source, 12).kind, "reference");
}

TEST(ChartSweepTest, WithoutAnExactAnswerItIsARunThatConverged) {
  const Chart chart = sweep(fallingBall(), 60);

  EXPECT_EQ(chart.kind, "reference");
  EXPECT_THAT(chart.measure[0], HasSubstr("converged run"));
  EXPECT_LT(chart.resolution, 0.01);
  // The ball falls 0.5 m: a step's length of its way at the most.
  EXPECT_LT(chart.lines[0].points.back().error, 0.05);
}

TEST(ChartSweepTest, WithoutARunThatConvergesItIsOverlapAndDriftOfAHeapAtRest) {
  const Chart chart = sweep(SceneSource::find("soup:60"), 330);

  EXPECT_EQ(chart.kind, "rest");
  EXPECT_THAT(chart.measure[1], HasSubstr("overlap"));
  EXPECT_THAT(chart.measure[1], HasSubstr("drift"));
}

TEST(ChartSweepTest, WithoutRestItIsOverlap) {
  // The heap of the last test while it falls.
  const Chart chart = sweep(SceneSource::find("soup:60"), 120);

  EXPECT_EQ(chart.kind, "overlap");
  EXPECT_THAT(chart.measure[1], HasSubstr("overlap"));
  EXPECT_EQ(chart.measure[1].find("drift"), std::string::npos);
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) EXPECT_GT(point.error, 0);
  }
}

TEST(ChartSweepTest, MoreStepsThanAnExactAnswerHoldsAreRefused) {
  EXPECT_THROW(sweep(SceneSource::find("incline"), 181), std::runtime_error);
}

TEST(ChartSweepTest, EveryMethodHasALineForEachStepSize) {
  SweepOptions options;
  options.steps = 60;
  options.rounds = 1;
  options.leastSeconds = 0;
  options.halvings = {-1, 0, 2};
  const Chart chart = sweepScene(SceneSource::find("projectile"), options);

  ASSERT_EQ(chart.lines.size(), 3 * methods().size());
  EXPECT_EQ(chart.lines[0].method, std::string(methods()[0].name) + " at 1/30 s");
  EXPECT_EQ(chart.lines[0].stepsPerSecond, 30);
  EXPECT_EQ(chart.lines[1].method, methods()[0].name);
  EXPECT_EQ(chart.lines[1].stepsPerSecond, 60);
  EXPECT_EQ(chart.lines[2].stepsPerSecond, 240);
  // Impulses fall by whole steps, so that their error goes with the step's length.
  EXPECT_GT(chart.lines[0].points.back().error, 1.5 * chart.lines[1].points.back().error);
  EXPECT_GT(chart.lines[1].points.back().error, 2 * chart.lines[2].points.back().error);
}

TEST(ChartSweepTest, AStepSizeOfASceneWithEventsIsItsOwn) {
  SweepOptions options;
  options.halvings = {1};

  EXPECT_THROW(sweepScene(SceneSource::find("arena"), options), std::runtime_error);
}

/// Errors of the soft step in the first scalar of the build, by rising substeps.
std::vector<double> softErrors(const char* scene, std::uint64_t steps) {
  const Chart chart = sweep(SceneSource::find(scene), steps);
  for (const ChartLine& line : chart.lines) {
    if (line.solver != SolverKind::softStep) continue;
    std::vector<double> errors;
    for (const ChartPoint& point : line.points) errors.push_back(point.error);
    return errors;
  }
  return {};
}

// Halved from each count of substeps to its double, to a fifth.
TEST(ChartSweepTest, ErrorsOfTheSoftStepFallWithTheSubsteps) {
  for (const char* scene : {"slide", "roll", "conveyor", "incline", "pyramid:12"}) {
    const std::vector<double> errors = softErrors(scene, 120);
    ASSERT_EQ(errors.size(), 5u);
    for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_LT(errors[i], 0.6 * errors[i - 1]) << scene << i;
  }
}

TEST(ChartSweepTest, FreeFlightOfTheSoftStepIsExactWithAnySubsteps) {
  for (const double error : softErrors("projectile", 120)) EXPECT_LT(error, 1e-6);
}

TEST(ChartSweepTest, ErrorsWithoutAnAnswerAreMediansOfStarts) {
  SweepOptions options;
  options.steps = 120;
  options.rounds = 1;
  options.leastSeconds = 0;
  options.starts = 3;
  const Chart chart = sweepScene(SceneSource::find("soup:60"), options);

  EXPECT_THAT(chart.measure[1], HasSubstr("3 starts"));
  bool differ = false;
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) {
      EXPECT_LE(point.lowQuartile, point.error);
      EXPECT_LE(point.error, point.highQuartile);
      differ = differ || point.lowQuartile < point.highQuartile;
    }
  }
  EXPECT_TRUE(differ);
}

TEST(ChartSweepTest, TellsHowFarItIs) {
  int told = 0;
  int last = -1;
  SweepOptions options;
  options.steps = 6;
  options.rounds = 1;
  options.leastSeconds = 0;
  options.progress = [&](int done, int total, const std::string& what) {
    EXPECT_GE(done, last);
    EXPECT_LT(done, total);
    EXPECT_NE(what, "");
    last = done;
    ++told;
  };
  sweepScene(SceneSource::find("pyramid:2"), options);

  EXPECT_GT(told, 20);
}

}  // namespace
}  // namespace samestep
