// SPDX-License-Identifier: MIT
#include <cstdio>

#include <samestep/recorder.h>
#include <samestep/scene.h>

#include "cli/commands.h"

namespace samestep::program {
namespace {

template <Scalar S>
int run(const RecordOptions& options) {
  const SceneSource source = SceneSource::find(options.scene);
  const std::uint64_t ticks = options.ticks > 0 ? options.ticks : source.summary().ticks;
  Scene<S> scene(source);
  std::vector<std::uint8_t> bytes;
  Recorder<S> recorder(scene.space(), scene.timeStep(), bytes);
  Progress progress("record", ticks);
  std::uint64_t commands = 0;
  for (std::uint64_t tick = 1; tick <= ticks; ++tick) {
    while (const Command<S>* command = scene.nextCommand()) {
      recorder.apply(*command);
      ++commands;
    }
    recorder.step();
    progress.at(tick);
  }
  recorder.finish();
  writeFile(options.file, bytes);
  std::printf("%s: %llu ticks of %s in %s, %llu commands, %llu bytes\n", options.file.c_str(),
              static_cast<unsigned long long>(ticks), options.scene.c_str(), options.scalar.c_str(),
              static_cast<unsigned long long>(commands), static_cast<unsigned long long>(bytes.size()));
  return kGood;
}

}  // namespace

int recordScene(const RecordOptions& options) {
  return withScalar(options.scalar, [&](auto scalar) { return run<decltype(scalar)>(options); });
}

}  // namespace samestep::program
