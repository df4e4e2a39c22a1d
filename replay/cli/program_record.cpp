// SPDX-License-Identifier: MIT
#include <cstdio>

#include <samestep/named_handlers.h>
#include <samestep/recorder.h>
#include <samestep/scene.h>

#include "cli/program.h"

namespace samestep::program {
namespace {

struct Options {
  std::string scene;
  std::string settings;
  std::string file;
  std::string scalar = "fixed";
  std::uint64_t ticks = 0;
  std::vector<std::string> claims;
  std::vector<std::string> notes;
  bool pack = false;
};

/// "KEY=VALUE"; the value of a claim may be left out where the program knows it.
std::pair<std::string, std::string> keyAndValue(const std::string& text) {
  const std::size_t sign = text.find('=');
  return {text.substr(0, sign), sign == std::string::npos ? std::string() : text.substr(sign + 1)};
}

template <Scalar S>
void recordWords(const Options& options, Recorder<S>& recorder, const Space<S>& space) {
  for (const std::string& claim : options.claims) {
    auto [key, value] = keyAndValue(claim);
    if (claim.find('=') == std::string::npos) value = namedClaim(space, key);
    if (value.empty()) throw Unusable("--claim " + claim + ": what it is must be given, as KEY=VALUE");
    recorder.claim(key, value);
  }
  for (const std::string& note : options.notes) {
    const auto [key, value] = keyAndValue(note);
    recorder.note(key, value);
  }
}

template <Scalar S>
int run(const Options& options) {
  const SceneSource source = findScene(options.scene, options.settings);
  checkWritable(options.file);
  const std::uint64_t ticks = options.ticks > 0 ? options.ticks : source.summary().ticks;
  Scene<S> scene(source);
  std::vector<std::uint8_t> bytes;
  Recorder<S> recorder(scene.space(), scene.timeStep(), bytes);
  recorder.setPacking(options.pack);
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
  recordWords(options, recorder, scene.space());
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
  addSettingsOption(*word, options->settings);
  addScalarOption(*word, options->scalar);
  addTicksOption(*word, options->ticks);
  word->add_option(
          "--claim", options->claims,
          "KEY=VALUE: say this of the world at the end; the value of samestep.bodies, samestep.hash and "
          "samestep.user-data.N need not be given")
      ->allow_extra_args(false);
  word->add_option("--note", options->notes, "KEY=VALUE: write this down beside the match")
      ->allow_extra_args(false);
  if (packingAvailable()) word->add_flag("--pack", options->pack, "Pack the recording by zstd");
  word->callback([options, &result] {
    result = withScalar(options->scalar, [&](auto scalar) { return run<decltype(scalar)>(*options); });
  });
}

}  // namespace samestep::program
