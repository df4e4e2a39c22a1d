// SPDX-License-Identifier: MIT
#include <cstdio>

#include <samestep/recorder.h>
#include <samestep/scene.h>

#include "cli/program.h"

namespace samestep::program {
namespace {

struct Options {
  std::string scene;
  std::string file;
  std::string scalar = "fixed";
  std::uint64_t ticks = 0;
};

template <Scalar S>
int run(const Options& options) {
  const SceneSource source = SceneSource::find(options.scene);
  checkWritable(options.file);
  const std::uint64_t ticks = options.ticks > 0 ? options.ticks : source.summary().ticks;
  Scene<S> scene(source);
  std::vector<std::uint8_t> bytes;
  Recorder<S> recorder(scene.space(), scene.timeStep(), bytes);
  Progress progress("record", ticks);
  std::uint64_t commands = 0;
  for (std::uint64_t tick = 1; tick <= ticks; ++tick) {
    try {
      while (const Command<S>* command = scene.nextCommand()) {
        recorder.apply(*command);
        ++commands;
      }
      recorder.step();
    } catch (const Error& error) {
      throw scene.refused(error);
    }
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

void addRecord(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "record",
      "Run a scene and write down its start, everything done to it and a fingerprint of every tick");
  auto options = std::make_shared<Options>();
  word->add_option("SCENE", options->scene, "A name from 'samestep scenes', or the path of a scene file")
      ->required();
  word->add_option("-o,--output", options->file, "The recording to write")->required();
  addScalarOption(*word, options->scalar);
  addTicksOption(*word, options->ticks);
  word->callback([options, &result] {
    result = withScalar(options->scalar, [&](auto scalar) { return run<decltype(scalar)>(*options); });
  });
}

}  // namespace samestep::program
