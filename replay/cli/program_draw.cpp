// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>

#include <samestep/draw.h>
#include <samestep/player.h>
#include <samestep/scene.h>

#include "cli/program.h"

namespace samestep::program {
namespace {

struct Options {
  std::string source;
  std::string file;
  std::string scalar = "fixed";
  std::uint64_t tick = 0;
  bool scalarGiven = false;
};

/// Only SVG is written: another ending would promise another format.
void checkPicture(const std::string& file) {
  checkWritable(file);
  for (const char* other : {".png", ".jpg", ".jpeg", ".gif", ".webp", ".pdf", ".bmp"}) {
    if (file.ends_with(other)) throw Unusable(file + ": pictures are written as SVG; name the file .svg");
  }
}

template <Scalar S>
void write(const Options& options, const Space<S>& space) {
  const std::string caption = options.source + " · tick " + std::to_string(options.tick) + " · " +
                              std::to_string(space.bodyCount()) + " bodies · hash " + hex(space.hash());
  writeFile(options.file, drawSvg(space, caption));
  std::printf("%s: tick %llu of %s\n", options.file.c_str(), static_cast<unsigned long long>(options.tick),
              options.source.c_str());
}

template <Scalar S>
int drawScene(const Options& options) {
  Scene<S> scene(SceneSource::find(options.source));
  Progress progress("draw", options.tick);
  while (scene.tick() < options.tick) {
    scene.step();
    progress.at(scene.tick());
  }
  write(options, scene.space());
  return kGood;
}

template <Scalar S>
int drawRecording(const Options& options, const Wirings& wirings, std::span<const std::uint8_t> bytes) {
  Progress progress("draw", options.tick);
  PlayerOptions how;
  how.data = &progress;
  how.progress = [](std::uint64_t tick, std::uint64_t target, void* data) {
    static_cast<Progress*>(data)->at(tick, target);
    return true;
  };
  Player<S> player(bytes, wiringOf<S>(wirings), how);
  if (options.tick > player.ticks()) {
    throw Unusable(options.source + ": ends at tick " + std::to_string(player.ticks()));
  }
  player.seek(options.tick);
  write(options, player.space());
  return kGood;
}

int draw(const Options& options, const Wirings& wirings) {
  checkPicture(options.file);
  std::error_code error;
  const bool file = std::filesystem::is_regular_file(options.source, error);
  if (!file || options.source.ends_with(".json")) {
    return withScalar(options.scalar, [&](auto scalar) { return drawScene<decltype(scalar)>(options); });
  }
  if (options.scalarGiven) {
    throw Unusable(options.source + ": a recording has its scalar; --scalar is for scenes");
  }
  try {
    const std::vector<std::uint8_t> bytes = readRecording(options.source);
    return withScalarOf(recordingInfo(bytes).scalar, [&](auto scalar) {
      return drawRecording<decltype(scalar)>(options, wirings, bytes);
    });
  } catch (const FormatError& problem) {
    tell(options.source, problem);
    return kUnusable;
  }
}

}  // namespace

void addDraw(CLI::App& app, Wirings& wirings, int& result) {
  CLI::App* word = app.add_subcommand("draw", "Draw one tick of a scene or recording as an SVG picture");
  auto options = std::make_shared<Options>();
  word->add_option("SCENE|FILE", options->source, "A scene (name or path) or a recording")->required();
  word->add_option("--tick", options->tick, "The tick to draw; 0 is the start")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 40))
      ->required();
  word->add_option("-o,--output", options->file, "The SVG file to write")->required();
  addScalarOption(*word, options->scalar);
  addGameOption(*word, wirings);
  word->callback([options, word, &wirings, &result] {
    options->scalarGiven = word->count("--scalar") > 0;
    result = draw(*options, wirings);
  });
}

}  // namespace samestep::program
