// SPDX-License-Identifier: MIT
// The whole step beside Chipmunk's: 30 steps to warm up, 300 timed, in rounds that take turns.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "peer_worlds.h"

namespace samestep::bench {
namespace {

constexpr int kWarmUp = 30;
constexpr int kTimed = 300;

constexpr const char* kEngines[] = {"chipmunk",
                                    "samestep-double-impulses10",
                                    "samestep-double-soft4",
                                    "samestep-fixed-impulses10",
                                    "samestep-fixed-soft4",
                                    "samestep-fixed-fast4"};
constexpr const char* kScenes[] = {"pyramid40", "soup"};

void run(benchmark::State& state, const PeerScene& scene, const char* engine) {
  using Clock = std::chrono::steady_clock;
  for (auto _ : state) {
    const std::unique_ptr<World> world = makeWorld(engine, scene);
    for (int i = 0; i < kWarmUp; ++i) world->step();
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < kTimed; ++i) world->step();
    const std::chrono::duration<double> spent = Clock::now() - start;
    state.SetIterationTime(spent.count() / kTimed);
  }
}

/// Prints the medians and what each engine takes of Chipmunk's time.
class Ratios : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type == Run::RT_Iteration) {
        times_[run.run_name.function_name].push_back(run.GetAdjustedRealTime());
      }
    }
  }
  void Finalize() override {
    std::printf("\n%-12s %-28s %12s %18s\n", "scene", "engine", "ms per step", "x Chipmunk");
    for (const char* scene : kScenes) {
      for (const char* engine : kEngines) {
        const double own = median(std::string(scene) + "/" + engine);
        const double reference = median(std::string(scene) + "/chipmunk");
        std::printf("%-12s %-28s %12.3f %18.2f\n", scene, engine, own, own / reference);
      }
    }
  }

 private:
  double median(const std::string& name) {
    std::vector<double>& all = times_[name];
    if (all.empty()) return 0;
    std::sort(all.begin(), all.end());
    return all[all.size() / 2];
  }
  std::map<std::string, std::vector<double>> times_;
};

}  // namespace
}  // namespace samestep::bench

int main(int argc, char** argv) {
  using namespace samestep::bench;
  benchmark::Initialize(&argc, argv);
  static std::map<std::string, PeerScene> scenes;
  for (const char* name : kScenes) scenes[name] = readScene(SAMESTEP_PEER_SCENES, name);
  for (const char* name : kScenes) {
    for (const char* engine : kEngines) {
      benchmark::RegisterBenchmark((std::string(name) + "/" + engine).c_str(), run, scenes[name], engine)
          ->UseManualTime()
          ->Iterations(1)
          ->Repetitions(7)
          ->Unit(benchmark::kMillisecond);
    }
  }
  Ratios reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
}
