// SPDX-License-Identifier: MIT
#include <cstdio>

#include "cli/commands.h"
#include "study/chart_sweep.h"

namespace samestep::program {
namespace {

int run(const ChartOptions& options) {
  const SceneSource source = SceneSource::find(options.scene);
  checkWritable(options.picture);
  if (!options.csv.empty()) checkWritable(options.csv);
  StatusLine status;
  SweepOptions sweep;
  sweep.steps = options.steps;
  sweep.rounds = options.rounds;
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
    std::printf("  %10.4f ms per step  %10.3g m  %s, %d %s\n", point->milliseconds, point->error,
                line->method.c_str(), point->count, line->unit.c_str());
  }
  return kGood;
}

}  // namespace

int chartSolvers(const ChartOptions& options) { return run(options); }

}  // namespace samestep::program
