// SPDX-License-Identifier: MIT
#include <cstdio>

#include "cli/program.h"
#include "study/chart_sweep.h"
#include "study/tune.h"

namespace samestep::program {
namespace {

struct Options {
  std::string scene;
  TuneGoal goal;
  std::string output;
  std::string picture;
  std::uint64_t steps = 0;
  int rounds = 3;
  int starts = 8;
};

void print(const Chart& chart, const FrontPoint& at) {
  std::printf("  %10.4f ms per step  %10.3g m  %s, %d %s\n", millisecondsPerStep(chart, *at.point),
              at.point->error, at.line->method.c_str(), at.point->count, at.line->unit.c_str());
}

std::string goalText(const TuneGoal& goal) {
  char text[100];
  if (goal.error > 0 && goal.budget > 0) {
    std::snprintf(text, sizeof text, "an error of at most %g m in at most %g ms a step", goal.error,
                  goal.budget);
  } else if (goal.error > 0) {
    std::snprintf(text, sizeof text, "an error of at most %g m", goal.error);
  } else {
    std::snprintf(text, sizeof text, "at most %g ms a step", goal.budget);
  }
  return text;
}

Chart sweep(const SceneSource& source, const Options& options) {
  StatusLine status;
  SweepOptions sweep;
  sweep.steps = options.steps;
  sweep.rounds = options.rounds;
  sweep.starts = options.starts;
  // Step sizes of 1/30 to 1/240 s of a scene with 60 steps a second.
  if (!Scene<Fixed>(source).hasEvents()) sweep.halvings = {-1, 0, 1, 2};
  sweep.progress = [&](int done, int total, const std::string& what) {
    status.show("tune: " + std::to_string(done) + " of " + std::to_string(total) + " runs; " + what);
  };
  return sweepScene(source, sweep);
}

/// Says what cannot be reached, and the nearest that can.
int unreachable(const Chart& chart, const Options& options, const Tuned& tuned) {
  std::printf("No setting of %s reaches %s.\n", options.scene.c_str(), goalText(options.goal).c_str());
  if (options.goal.error > 0 && options.goal.error < chart.resolution) {
    std::printf("Its answer is itself known to %.2g m only.\n", chart.resolution);
  }
  if (tuned.nearest.point == nullptr) {
    std::printf("No setting could make all steps.\n");
  } else {
    std::printf("The nearest:\n");
    print(chart, tuned.nearest);
  }
  return kMismatch;
}

int run(const Options& options) {
  const SceneSource source = SceneSource::find(options.scene);
  if (!options.output.empty()) checkWritable(options.output);
  if (!options.picture.empty()) checkWritable(options.picture);
  const Chart chart = sweep(source, options);
  if (!options.picture.empty()) writeFile(options.picture, drawChart(chart));
  for (const std::string& line : chart.measure) std::printf("%s\n", line.c_str());
  std::printf("Settings of which nothing faster is as accurate (Pareto front):\n");
  for (const FrontPoint& at : frontOf(chart)) print(chart, at);
  const Tuned tuned = tune(chart, options.goal);
  if (tuned.found.point == nullptr) return unreachable(chart, options, tuned);
  std::printf("Settings for %s:\n", goalText(options.goal).c_str());
  print(chart, tuned.found);
  if (tuned.usual.point != nullptr) {
    std::printf("Default settings, %.2f times the time:\n",
                tuned.usual.point->milliseconds / tuned.found.point->milliseconds);
    print(chart, tuned.usual);
  }
  const std::string json = settingsJson(chart, tuned.found);
  if (options.output.empty()) {
    std::printf("%s", json.c_str());
  } else {
    writeFile(options.output, json);
    std::printf("%s: these settings\n", options.output.c_str());
  }
  return kGood;
}

}  // namespace

void addTune(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "tune", "Find the cheapest settings of a scene for an error, or the most accurate ones for a time");
  auto options = std::make_shared<Options>();
  word->add_option("SCENE", options->scene, "A name from 'samestep scenes', or the path of a scene file")
      ->required();
  word->add_option("--error", options->goal.error, "The greatest error, m")->check(CLI::PositiveNumber);
  word->add_option("--budget", options->goal.budget, "The greatest time of a step, ms")
      ->check(CLI::PositiveNumber);
  word->add_option("-o,--output", options->output,
                   "Write the settings to this file, as JSON; printed if not given");
  word->add_option("--chart", options->picture, "Also draw what was measured to this SVG file");
  word->add_option("--rounds", options->rounds,
                   "Rounds in which the settings take turns; the time of each is its median")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  word->add_option("--starts", options->starts,
                   "Starts over which the error of a scene without an exact or converged answer is a median")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  word->add_option("--ticks", options->steps,
                   "How many steps to make; if not given 330, or what the scene's exact answer is for")
      ->check(CLI::Range(std::uint64_t{6}, std::uint64_t{1} << 20));
  word->callback([options, &result] {
    if (options->goal.error == 0 && options->goal.budget == 0) {
      throw CLI::RequiredError("--error or --budget");
    }
    result = run(*options);
  });
}

}  // namespace samestep::program
