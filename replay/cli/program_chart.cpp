// SPDX-License-Identifier: MIT
#include <cstdio>

#include "cli/program.h"
#include "study/chart_sweep.h"

namespace samestep::program {
namespace {

struct Options {
  std::string scene;
  std::string picture;
  std::string csv;
  std::uint64_t steps = 0;
  int rounds = 3;
  int starts = 32;
  bool stepSizes = false;
  std::vector<std::string> kernels;
};

int run(const Options& options) {
  const SceneSource source = SceneSource::find(options.scene);
  checkWritable(options.picture);
  if (!options.csv.empty()) checkWritable(options.csv);
  StatusLine status;
  SweepOptions sweep;
  sweep.steps = options.steps;
  sweep.rounds = options.rounds;
  sweep.starts = options.starts;
  if (options.stepSizes) sweep.halvings = {-1, 0, 1, 2};
  if (!options.kernels.empty()) sweep.kernels.clear();
  for (const std::string& name : options.kernels) {
    sweep.kernels.push_back(ComputeOptions{.kernel = name}.target());
  }
  sweep.progress = [&](int done, int total, const std::string& what) {
    status.show("chart: " + std::to_string(done) + " of " + std::to_string(total) + " runs; " + what);
  };
  const Chart chart = sweepScene(source, sweep);
  status.clear();
  writeFile(options.picture, drawChart(chart));
  if (!options.csv.empty()) writeFile(options.csv, chartCsv(chart));
  std::printf("%s: %s\n", options.picture.c_str(), options.scene.c_str());
  for (const std::string& line : chart.measure) std::printf("%s\n", line.c_str());
  std::printf("Settings of which nothing faster is as accurate (Pareto front):\n");
  for (const auto& [line, point] : frontOf(chart)) {
    std::printf("  %10.3f ms per simulated second  %10.3g m  %s, %d %s\n", point->milliseconds, point->error,
                line->method.c_str(), point->count, line->unit.c_str());
  }
  return kGood;
}

}  // namespace

void addChart(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "chart", "Run a scene with every solver setting and draw speed against accuracy as an SVG picture");
  auto options = std::make_shared<Options>();
  word->add_option("SCENE", options->scene, "A name from 'samestep scenes', or the path of a scene file")
      ->required();
  word->add_option("-o,--output", options->picture, "The SVG file to write")->required();
  word->add_option("--csv", options->csv, "Also write the figures to this file");
  word->add_option("--rounds", options->rounds,
                   "Rounds in which the settings take turns; the time of each is its median")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  word->add_option("--starts", options->starts,
                   "Starts over which the error of a scene without an exact or converged answer is a median")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  word->add_flag("--step-sizes", options->stepSizes,
                 "Also lines for steps of twice, a half and a quarter of the scene's own length");
  word->add_option("--kernel", options->kernels,
                   "Give the soft step a line for these processor instructions; may be given several times, "
                   "the best of this machine if not given")
      ->check(CLI::IsMember(kernelNames()));
  word->add_option("--ticks", options->steps,
                   "How many steps to make; if not given 330, or what the scene's exact answer is for")
      ->check(CLI::Range(std::uint64_t{6}, std::uint64_t{1} << 20));
  word->callback([options, &result] { result = run(*options); });
}

}  // namespace samestep::program
