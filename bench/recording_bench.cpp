// SPDX-License-Identifier: MIT
// What recording and verifying cost beside bare stepping, on a scene. Processor time, the best of some
// rounds. Usage: recording_bench [SCENE [ROUNDS]]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include <samestep/recorder.h>
#include <samestep/scene.h>
#include <samestep/verify.h>

namespace samestep {
namespace {

constexpr int kTicks = 600;

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Times {
  double bare = 1e9;
  double hashed = 1e9;
  double recorded = 1e9;
  double verified = 1e9;
};

template <Scalar S>
void applyDue(Scene<S>& scene) {
  while (const Command<S>* command = scene.nextCommand()) applyCommand(scene.space(), *command);
}

/// Seconds that `run` takes, without what it takes to set up the scene.
template <Scalar S, class Run>
double timed(const SceneSource& source, Run&& run) {
  Scene<S> scene(source);
  const double start = seconds();
  run(scene);
  return seconds() - start;
}

template <Scalar S>
void measure(const char* scalar, const SceneSource& source, int rounds) {
  Times best;
  std::uint64_t sum = 0;
  for (int round = 0; round < rounds; ++round) {
    best.bare = std::min(best.bare, timed<S>(source, [](Scene<S>& scene) {
                           for (int i = 0; i < kTicks; ++i) {
                             applyDue(scene);
                             scene.space().step(scene.timeStep());
                           }
                         }));
    best.hashed = std::min(best.hashed, timed<S>(source, [&](Scene<S>& scene) {
                             for (int i = 0; i < kTicks; ++i) {
                               applyDue(scene);
                               scene.space().step(scene.timeStep());
                               sum += scene.space().hash();
                             }
                           }));
    std::vector<std::uint8_t> bytes;
    best.recorded = std::min(best.recorded, timed<S>(source, [&](Scene<S>& scene) {
                               Recorder<S> recorder(scene.space(), scene.timeStep(), bytes);
                               for (int i = 0; i < kTicks; ++i) {
                                 while (const Command<S>* command = scene.nextCommand())
                                   recorder.apply(*command);
                                 recorder.step();
                               }
                               recorder.finish();
                             }));
    const double start = seconds();
    if (!verify(bytes).matches) std::abort();
    best.verified = std::min(best.verified, seconds() - start);
  }
  const auto percent = [&](double time) { return (time / best.bare - 1) * 100; };
  std::printf(
      "%-6s bare %7.1f us/step, with hash %+5.1f %%, recording %+5.1f %% (beyond the hash %+5.1f %%), "
      "verifying at %5.1f %% of the bare speed  [%llx]\n",
      scalar, best.bare / kTicks * 1e6, percent(best.hashed), percent(best.recorded),
      (best.recorded - best.hashed) / best.bare * 100, best.bare / best.verified * 100,
      static_cast<unsigned long long>(sum & 15));
}

}  // namespace
}  // namespace samestep

int main(int argc, char** argv) {
  using namespace samestep;
  const SceneSource source = SceneSource::find(argc > 1 ? argv[1] : "arena");
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 10;
#ifndef SAMESTEP_FIXED_ONLY
  measure<double>("double", source, rounds);
#endif
  measure<Fixed>("fixed", source, rounds);
}
