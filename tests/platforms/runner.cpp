// SPDX-License-Identifier: MIT
// What scripts/platforms runs on each platform. Prints one line about the platform, then one for each tick of
// each scene: name, scalar, tick, hash. Output goes through printf: <iostream> would be most of the program.
#include <bit>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>

#include <samestep/version.h>

#include "scenes.h"

namespace samestep {
namespace {

template <Scalar S>
void run(const char* scalar, std::uint64_t ticks) {
  for (int i = 0; i < kPlatformScenes; ++i) {
    const PlatformScene<S> scene = platformScene<S>(i);
    Space<S> space;
    scene.build(space);
    for (std::uint64_t tick = 1; tick <= ticks; ++tick) {
      scene.act(space, tick);
      space.step(ratio<S>(1, 64));
      std::printf("%s %s %" PRIu64 " %016" PRIx64 "\n", scene.name, scalar, tick, space.hash());
    }
  }
}

void describePlatform() {
  const std::string_view name = compiler();
  std::printf("platform: %d %s %.*s\n", static_cast<int>(8 * sizeof(void*)),
              std::endian::native == std::endian::little ? "little" : "big", static_cast<int>(name.size()),
              name.data());
}

}  // namespace
}  // namespace samestep

int main(int argumentCount, char** arguments) {
  const std::uint64_t ticks = argumentCount > 1 ? std::strtoull(arguments[1], nullptr, 10) : 600;
  samestep::describePlatform();
  samestep::run<samestep::Fixed>("fixed", ticks);
#ifndef SAMESTEP_FIXED_ONLY
  samestep::run<double>("double", ticks);
#endif
  std::puts("end");
  return 0;
}
