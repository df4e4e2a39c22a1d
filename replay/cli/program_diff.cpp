// SPDX-License-Identifier: MIT
#include <cstdio>

#include <samestep/replay_diff.h>

#include "cli/program.h"

namespace samestep::program {
namespace {

struct Options {
  std::string a;
  std::string b;
  std::uint32_t most = 5;
};

unsigned long long shown(std::uint64_t number) { return number; }

/// Reads a recording; says on the error output what is wrong with its first bytes.
bool read(const std::string& file, std::vector<std::uint8_t>& bytes) {
  try {
    bytes = readRecording(file);
    return true;
  } catch (const FormatError& error) {
    tell(file, error);
    return false;
  }
}

/// True if a whole recording can be used; which of the two is at fault is told here.
template <Scalar S>
bool usable(const std::string& file, std::span<const std::uint8_t> bytes, std::uint64_t& ticks) {
  try {
    ticks = RecordingReader<S>(bytes).ticks();
    return true;
  } catch (const FormatError& error) {
    tell(file, error);
    return false;
  }
}

void reportCommands(const ReplayDifference& difference) {
  if (difference.commandTick == 0) {
    std::printf("what was done to them is the same up to here\n");
    return;
  }
  std::printf("what was done to them differs first at tick %llu:\n", shown(difference.commandTick));
  for (const std::string& words : difference.onlyA) std::printf("  only A: %s\n", words.c_str());
  for (const std::string& words : difference.onlyB) std::printf("  only B: %s\n", words.c_str());
  if (difference.onlyA.empty() && difference.onlyB.empty()) std::printf("  the same in another order\n");
}

void reportWorlds(const ReplayDifference& difference) {
  if (difference.stage == "start") {
    std::printf("the worlds differ from the start, first in\n");
  } else if (difference.stage == "commands") {
    std::printf("the worlds differ at tick %llu, before its step, first in\n", shown(difference.tick));
  } else {
    std::printf("the worlds differ at tick %llu, in the stage \"%s\", first in\n", shown(difference.tick),
                difference.stage.c_str());
  }
  for (const FieldDifference& field : difference.fields) {
    std::printf("  %s, %s\n    A: %s\n    B: %s\n", field.object.c_str(), field.field.c_str(),
                field.a.c_str(), field.b.c_str());
  }
}

template <Scalar S>
int run(const Options& options, const Wirings& wirings, std::span<const std::uint8_t> a,
        std::span<const std::uint8_t> b) {
  std::uint64_t ticksA = 0;
  std::uint64_t ticksB = 0;
  if (!usable<S>(options.a, a, ticksA) || !usable<S>(options.b, b, ticksB)) return kUnusable;
  Progress progress("diff", 0);
  VerifyOptions how;
  how.data = &progress;
  how.progress = [](std::uint64_t done, std::uint64_t total, void* data) {
    static_cast<Progress*>(data)->at(done, total);
    return true;
  };
  const ReplayDifference difference = findDifference<S>(a, b, wiringOf<S>(wirings), options.most, how);
  progress.clear();
  if (difference.worldsDiffer) {
    reportWorlds(difference);
    if (difference.stage != "start") reportCommands(difference);
    return kMismatch;
  }
  std::printf("the worlds are the same for %llu ticks\n", shown(difference.tick));
  reportCommands(difference);
  if (ticksA == ticksB) return kGood;
  std::printf("but A has %llu ticks and B has %llu\n", shown(ticksA), shown(ticksB));
  return kMismatch;
}

int diff(const Options& options, const Wirings& wirings) {
  std::vector<std::uint8_t> a;
  std::vector<std::uint8_t> b;
  if (!read(options.a, a) || !read(options.b, b)) return kUnusable;
  const ScalarKind scalar = recordingInfo(a).scalar;
  if (scalar != recordingInfo(b).scalar) {
    std::printf("one is recorded with fixed, the other with double\n");
    return kMismatch;
  }
  return withScalarOf(scalar, [&](auto number) { return run<decltype(number)>(options, wirings, a, b); });
}

}  // namespace

void addDiff(CLI::App& app, const Wirings& wirings, int& result) {
  CLI::App* word = app.add_subcommand(
      "diff", "Replay two recordings and find the first tick, object and field in which their worlds differ");
  auto options = std::make_shared<Options>();
  word->add_option("A", options->a, "A recording")->required();
  word->add_option("B", options->b, "Another one")->required();
  word->add_option("--fields", options->most, "How many differing fields to show")
      ->check(CLI::Range(1u, 1000000u))
      ->capture_default_str();
  word->callback([options, &wirings, &result] { result = diff(*options, wirings); });
}

}  // namespace samestep::program
