// SPDX-License-Identifier: MIT
// What keeping a world costs, on a scene after some steps: the portable snapshot (size, saving, loading with
// all checks) and the copy in memory, beside a copy of as many bytes by memcpy. Processor time, the best of
// some rounds. Usage: snapshot_bench [SCENE [TICKS [ROUNDS]]]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <vector>

#include <samestep/scene.h>
#include <samestep/snapshot.h>

namespace samestep {
namespace {

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// The least time that one call takes, over rounds of about 20 ms each.
template <class Work>
double timed(int rounds, Work&& work) {
  double best = 1e9;
  int calls = 1;
  for (int round = 0; round < rounds;) {
    const double start = seconds();
    for (int i = 0; i < calls; ++i) work();
    const double took = seconds() - start;
    if (took < 0.02) {
      calls *= 2;
      continue;
    }
    best = std::min(best, took / calls);
    ++round;
  }
  return best;
}

template <Scalar S>
void measure(const char* scalar, const SceneSource& source, int ticks, int rounds) {
  Scene<S> scene(source);
  Space<S>& space = scene.space();
  for (int i = 0; i < ticks; ++i) {
    while (const Command<S>* command = scene.nextCommand()) applyCommand(space, *command);
    space.step(scene.timeStep());
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(saveSnapshot(space, {})));
  const double asking = timed(rounds, [&] { saveSnapshot(space, {}); });
  const double saving = timed(rounds, [&] { saveSnapshot(space, bytes); });
  const double loading = timed(rounds, [&] { loadSnapshot(space, bytes); });
  const double size = static_cast<double>(bytes.size());
  std::printf(
      "%-6s %5u bodies, %5zu pairs: snapshot %7.0f bytes, %.0f per body; size asked in %.0f us, saved in "
      "%.0f us (%.2f GB/s), loaded in %.0f us (%.2f GB/s)\n",
      scalar, space.bodyCount(), space.state().pairs.size(), size, size / space.bodyCount(), asking * 1e6,
      saving * 1e6, size / saving / 1e9, loading * 1e6, size / loading / 1e9);

  space.step(scene.timeStep());
  SavedSpace<S> saved = space.save();
  const auto inMemory = static_cast<std::size_t>(saved.bytes());
  std::vector<std::uint8_t> from(inMemory, 1), to(inMemory);
  const double copying = timed(rounds, [&] {
    std::memcpy(to.data(), from.data(), inMemory);
    from[0] = to[inMemory / 2];
  });
  const double keeping = timed(rounds, [&] { space.save(saved); });
  const double restoring = timed(rounds, [&] { space.restore(saved); });
  // A restored world without its caches would pay for them in the next step.
  const double both = timed(rounds, [&] {
    space.save(saved);
    space.restore(saved);
  });
  const double stepping = timed(rounds, [&] {
    space.restore(saved);
    space.step(scene.timeStep());
  });
  std::printf(
      "       in memory %zu bytes: memcpy %.0f us, save %.0f us, restore %.0f us, both %.2f times the "
      "memcpy; restore and step %.0f us\n",
      inMemory, copying * 1e6, keeping * 1e6, restoring * 1e6, both / copying, stepping * 1e6);
}

}  // namespace
}  // namespace samestep

int main(int argc, char** argv) {
  using namespace samestep;
  const SceneSource source = SceneSource::find(argc > 1 ? argv[1] : "pyramid40");
  const int ticks = argc > 2 ? std::atoi(argv[2]) : 300;
  const int rounds = argc > 3 ? std::atoi(argv[3]) : 10;
#ifndef SAMESTEP_FIXED_ONLY
  measure<double>("double", source, ticks, rounds);
#endif
  measure<Fixed>("fixed", source, ticks, rounds);
}
