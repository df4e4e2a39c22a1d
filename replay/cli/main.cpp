// SPDX-License-Identifier: MIT
// The program: scenes, their hashes, recordings and pictures.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include <samestep/error.h>
#include <samestep/fingerprint.h>
#include <samestep/space.h>
#include <samestep/version.h>
#include <samestep/workers.h>

#include "cli/commands.h"

namespace {

/// What two players compare before a match.
std::string fingerprints() {
  using namespace samestep;
  std::string text = "fingerprint fixed " + program::hex(fingerprint<Fixed>());
#ifndef SAMESTEP_FIXED_ONLY
  text += "\nfingerprint double " + program::hex(fingerprint<double>());
#endif
  return text;
}

std::string versionText() {
  using namespace samestep;
  return "samestep " + std::string(version()) + "\nsimulation revision " +
         std::to_string(kSimulationRevision) + "\nscalars " + std::string(builtScalars()) + "\ncompiler " +
         std::string(compiler()) + "\n" + fingerprints();
}

}  // namespace

namespace samestep::program {
namespace {

void addScalarOption(CLI::App& app, std::string& scalar) {
  std::vector<std::string> names{"fixed"};
  if (ScalarTraits<double>::kSupported) names.emplace_back("double");
  if (ScalarTraits<CheckedFixed>::kSupported) names.emplace_back("checked");
  app.add_option("--scalar", scalar, "The number type that the world is computed with")
      ->check(CLI::IsMember(names))
      ->capture_default_str();
}

void addComputeOptions(CLI::App& app, ComputeOptions& options) {
  app.add_option("--kernel", options.kernel,
                 "The processor instructions to solve contacts with; no hash differs")
      ->check(CLI::IsMember(kernelNames()))
      ->capture_default_str();
  app.add_option("--workers", options.workers,
                 "How many threads share all that can be shared; no hash differs")
      ->check(CLI::Range(1, WorkerPool::kMostWorkers))
      ->capture_default_str();
}

void addTicksOption(CLI::App& app, std::uint64_t& ticks) {
  app.add_option("--ticks", ticks, "How many steps to make; as the scene says if not given")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40));
}

void addScenes(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand("scenes", "List the scenes that can be run by name");
  word->callback([&result] { result = listScenesByName(); });
}

void addHash(CLI::App& app, int& result) {
  CLI::App* word =
      app.add_subcommand("hash", "Run a scene and print a fingerprint of its world after every tick");
  auto options = std::make_shared<HashOptions>();
  word->add_option("SCENE", options->scene, "A name from 'samestep scenes', or the path of a scene file")
      ->required();
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
    result = hashScene(*options);
  });
}

void addRecord(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "record",
      "Run a scene and write down its start, everything done to it and a fingerprint of every tick");
  auto options = std::make_shared<RecordOptions>();
  word->add_option("SCENE", options->scene, "A name from 'samestep scenes', or the path of a scene file")
      ->required();
  word->add_option("-o,--output", options->file, "The recording to write")->required();
  addScalarOption(*word, options->scalar);
  addTicksOption(*word, options->ticks);
  word->callback([options, &result] { result = recordScene(*options); });
}

void addVerify(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "verify", "Replay recordings and check that every tick comes out as it was recorded");
  auto options = std::make_shared<VerifyFilesOptions>();
  word->add_option("FILE", options->files, "Recordings, as 'samestep record' or a game wrote them")
      ->required();
  addComputeOptions(*word, options->compute);
  // For recordings from strangers.
  word->add_option("--max-bodies", options->limits.bodies, "Refuse recordings of worlds with more bodies")
      ->capture_default_str();
  word->add_option("--max-shapes", options->limits.shapes, "Refuse those with more shapes")
      ->capture_default_str();
  word->add_option("--max-pairs", options->limits.pairs, "Refuse those with more shapes near each other")
      ->check(CLI::Range(std::uint32_t{0}, kMostPairs))
      ->capture_default_str();
  word->add_option("--max-seconds", options->seconds, "Give up after so many seconds for a recording")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 30));
  word->callback([options, &result] { result = verifyFiles(*options); });
}

void addDiff(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "diff", "Replay two recordings and find the first tick, object and field in which their worlds differ");
  auto options = std::make_shared<DiffOptions>();
  word->add_option("A", options->a, "A recording")->required();
  word->add_option("B", options->b, "Another one")->required();
  word->add_option("--fields", options->most, "How many differing fields to show")
      ->check(CLI::Range(1u, 1000000u))
      ->capture_default_str();
  word->callback([options, &result] { result = diffRecordings(*options); });
}

void addDraw(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand("draw", "Draw one tick of a scene or recording as an SVG picture");
  auto options = std::make_shared<DrawOptions>();
  word->add_option("SCENE|FILE", options->source, "A scene (name or path) or a recording")->required();
  word->add_option("--tick", options->tick, "The tick to draw; 0 is the start")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 40))
      ->required();
  word->add_option("-o,--output", options->file, "The SVG file to write")->required();
  addScalarOption(*word, options->scalar);
  word->callback([options, &result] { result = drawTick(*options); });
}

void addChart(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "chart", "Run a scene with every solver setting and draw speed against accuracy as an SVG picture");
  auto options = std::make_shared<ChartOptions>();
  word->add_option("SCENE", options->scene, "A name from 'samestep scenes', or the path of a scene file")
      ->required();
  word->add_option("-o,--output", options->picture, "The SVG file to write")->required();
  word->add_option("--csv", options->csv, "Also write the figures to this file");
  word->add_option("--rounds", options->rounds,
                   "Rounds in which the settings take turns; the time of each is its median")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  word->add_option("--kernel", options->kernels,
                   "Give the soft step a line for these processor instructions; may be given several times, "
                   "the best of this machine if not given")
      ->check(CLI::IsMember(kernelNames()));
  word->add_option("--ticks", options->steps,
                   "How many steps to make; if not given 330, or what the scene's exact answer is for")
      ->check(CLI::Range(std::uint64_t{6}, std::uint64_t{1} << 20));
  word->callback([options, &result] { result = chartSolvers(*options); });
}

void addEnvelope(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand("envelope",
                                      "Find how high a stack, how unequal masses, how fast a bullet, which "
                                      "degenerate shapes each solver bears");
  auto options = std::make_shared<EnvelopeOptions>();
  word->add_option("LADDER", options->ladder, "Climb only this one")->check(CLI::IsMember(ladderNames()));
  word->add_option("--csv", options->csv, "Also write the limits to this file");
  word->callback([options, &result] { result = climbLadders(*options); });
}

}  // namespace
}  // namespace samestep::program

int main(int argc, char** argv) {
  using namespace samestep::program;
  CLI::App app(
      "Samestep: 2D physics that gives the same bits on every machine.\n"
      "Runs scenes, records them, checks recordings and finds where two of them part.\n"
      "Exit code: 0 all good, 1 something differs, 2 unusable arguments or files.",
      "samestep");
  app.set_version_flag("--version", versionText());
  app.require_subcommand(1);
  app.set_help_all_flag("--help-all", "Show the help of all subcommands");
  int result = kGood;
  addScenes(app, result);
  addHash(app, result);
  addRecord(app, result);
  addVerify(app, result);
  addDiff(app, result);
  addDraw(app, result);
  addChart(app, result);
  addEnvelope(app, result);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kGood : kUnusable;
  } catch (const std::exception& error) {
    std::fflush(stdout);
    std::fprintf(stderr, "samestep: %s\n", error.what());
    return kUnusable;
  }
  if (std::fflush(stdout) != 0) {
    std::fprintf(stderr, "samestep: cannot write the output\n");
    return kUnusable;
  }
  return result;
}
