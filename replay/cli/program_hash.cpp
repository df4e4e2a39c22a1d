// SPDX-License-Identifier: MIT
#include <cstdio>

#include <samestep/high_water.h>
#include <samestep/scene.h>
#include <samestep/workers.h>

#include "cli/program.h"

namespace samestep::program {
namespace {

struct Options {
  std::string scene;
  std::string settings;
  std::string scalar = "fixed";
  std::uint64_t ticks = 0;
  std::uint64_t every = 1;
  bool highWater = false;
  ComputeOptions compute;
};

void printHighWater() {
  for (const HighWaterMark& mark : highWaterTable().marks()) {
    std::printf("high water\t%.*s\t%.9g\n", static_cast<int>(mark.name.size()), mark.name.data(),
                mark.value());
  }
}

template <Scalar S>
int run(const Options& options) {
  const SceneSource source = findScene(options.scene, options.settings);
  const std::uint64_t ticks = options.ticks > 0 ? options.ticks : source.summary().ticks;
  WorkerPool pool(options.compute.workers);
  Scene<S> scene(source);
  scene.space().forceKernel(options.compute.target());
  scene.space().setWorkers(&pool, Sharing::always);
  Progress progress("hash", ticks);
  for (std::uint64_t tick = 1; tick <= ticks; ++tick) {
    try {
      scene.step();
    } catch (const FixedOverflow& report) {
      std::fflush(stdout);
      std::fprintf(stderr, "samestep: %s: tick %llu: out of range in %s\n", options.scene.c_str(),
                   static_cast<unsigned long long>(tick), report.what());
      return kMismatch;
    }
    if (tick % options.every == 0) {
      std::printf("%llu %s\n", static_cast<unsigned long long>(tick), hex(scene.space().hash()).c_str());
    }
    progress.at(tick);
  }
  if (options.highWater) printHighWater();
  return kGood;
}

}  // namespace

void addHash(CLI::App& app, int& result) {
  CLI::App* word =
      app.add_subcommand("hash", "Run a scene and print a fingerprint of its world after every tick");
  auto options = std::make_shared<Options>();
  word->add_option("SCENE", options->scene, "A name from 'samestep scenes', or the path of a scene file")
      ->required();
  addSettingsOption(*word, options->settings);
  addScalarOption(*word, options->scalar);
  addTicksOption(*word, options->ticks);
  word->add_option("--every", options->every, "Print only every K-th tick")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40))
      ->capture_default_str();
  addComputeOptions(*word, options->compute);
  word->add_flag("--high-water", options->highWater,
                 "With --scalar checked: print the largest value that each formula of the engine had");
  word->callback([options, &result] {
    if (options->highWater && options->scalar != "checked") {
      throw CLI::ValidationError("--high-water", "only checked numbers are recorded: add --scalar checked");
    }
    result = withScalar(options->scalar, [&](auto scalar) { return run<decltype(scalar)>(*options); });
  });
}

}  // namespace samestep::program
