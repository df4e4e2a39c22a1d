// SPDX-License-Identifier: MIT
#include <cstdio>

#include <samestep/high_water.h>
#include <samestep/scene.h>
#include <samestep/workers.h>

#include "cli/commands.h"

namespace samestep::program {
namespace {

void printHighWater() {
  for (const HighWaterMark& mark : highWaterTable().marks()) {
    std::printf("high water\t%.*s\t%.9g\n", static_cast<int>(mark.name.size()), mark.name.data(),
                mark.value());
  }
}

template <Scalar S>
int run(const HashOptions& options) {
  const SceneSource source = SceneSource::find(options.scene);
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

int hashScene(const HashOptions& options) {
  return withScalar(options.scalar, [&](auto scalar) { return run<decltype(scalar)>(options); });
}

}  // namespace samestep::program
