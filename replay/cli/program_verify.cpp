// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cstdio>

#include <samestep/verify.h>
#include <samestep/workers.h>

#include "cli/program.h"
#include "cli/program_wiring.h"

namespace samestep::program {
namespace {

/// A stranger's bytes, with what a terminal would take for orders shown as dots.
std::string printable(std::string text) {
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '.';
  }
  return text;
}

void report(const std::string& file, const VerifyResult& result, std::int64_t milliseconds) {
  if (result.unexpected != nullptr) {
    std::printf("%s: UNEXPECTED: %s is not as expected", file.c_str(), result.unexpected);
    if (result.unexpectedOffset > 0) {
      std::printf(" (offset %llu)", static_cast<unsigned long long>(result.unexpectedOffset));
    }
    std::printf("\n");
    return;
  }
  if (!result.matches && result.falseClaim && result.recordedHash == result.computedHash) {
    const ClaimAt& claim = *result.falseClaim;
    std::printf("%s: FALSE CLAIM: after tick %llu, %s is not %s\n", file.c_str(),
                static_cast<unsigned long long>(claim.tick), printable(claim.key).c_str(),
                printable({claim.value.begin(), claim.value.end()}).c_str());
    return;
  }
  if (result.keyframeDiffers) {
    std::printf("%s: MISMATCH at tick %llu of %llu: the keyframe there is another world\n", file.c_str(),
                static_cast<unsigned long long>(result.firstWrongTick),
                static_cast<unsigned long long>(result.ticks));
    return;
  }
  if (!result.matches) {
    std::printf("%s: MISMATCH at tick %llu of %llu: recorded %s, computed %s\n", file.c_str(),
                static_cast<unsigned long long>(result.firstWrongTick),
                static_cast<unsigned long long>(result.ticks), hex(result.recordedHash).c_str(),
                hex(result.computedHash).c_str());
    return;
  }
  const std::uint64_t perSecond =
      result.ticks * 1000 / static_cast<std::uint64_t>(std::max<std::int64_t>(milliseconds, 1));
  std::printf(
      "%s: good: all %llu ticks give the recorded hashes, last %s (%llu ticks/s, %llu times real time at 60 "
      "Hz)\n",
      file.c_str(), static_cast<unsigned long long>(result.ticks), hex(result.computedHash).c_str(),
      static_cast<unsigned long long>(perSecond), static_cast<unsigned long long>(perSecond / 60));
}

/// What a verification is told after each tick.
struct Watch {
  Progress progress{"verify", 0};
  std::int64_t end = 0;  ///< By milliseconds(); 0 for none.

  bool after(std::uint64_t done, std::uint64_t total) {
    progress.at(done, total);
    return !isOver();
  }
  bool isOver() const { return end != 0 && milliseconds() >= end; }
};

/// verify, with what this program knows of.
VerifyResult verifyKnown(std::span<const std::uint8_t> bytes, const VerifyOptions& options) {
  if (recordingInfo(bytes).scalar == ScalarKind::fixed) {
    return verify<Fixed>(bytes, programWiring<Fixed>(), options);
  }
#ifndef SAMESTEP_FIXED_ONLY
  return verify<double>(bytes, programWiring<double>(), options);
#else
  return verify(bytes, options);
#endif
}

int verifyFile(const std::string& file, VerifyOptions options, std::int64_t seconds) {
  try {
    const std::vector<std::uint8_t> bytes = readRecording(file, options.limits.bytes);
    const std::int64_t start = milliseconds();
    Watch watch;
    if (seconds != 0) watch.end = start + seconds * 1000;
    options.data = &watch;
    options.progress = [](std::uint64_t done, std::uint64_t total, void* data) {
      return static_cast<Watch*>(data)->after(done, total);
    };
    if (seconds != 0) {
      options.interrupt = {[](void* data) { return static_cast<const Watch*>(data)->isOver(); }, &watch};
    }
    const VerifyResult result = verifyKnown(bytes, options);
    const std::int64_t took = milliseconds() - start;
    watch.progress.clear();
    if (result.stopped) throw Unusable(file + ": takes longer than " + std::to_string(seconds) + " s");
    report(file, result, took);
    // A batch that is killed keeps the verdicts it has come to.
    std::fflush(stdout);
    return result.matches ? kGood : kMismatch;
  } catch (const std::exception& error) {
    tell(file, error);
    return kUnusable;
  }
}

/// What a server knows of the match, as it stands in the arguments.
struct ExpectedWords {
  std::string firstHash;
  std::string timeStep;
  std::string scalar;
  std::vector<std::string> commands;
  std::uint64_t ticks = 0;
  std::uint64_t firstTick = 0;
};

bool readHash(const std::string& text, std::uint64_t& hash) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  return text.size() == 16 && error == std::errc() && end == text.data() + text.size();
}

/// "1/60".
bool readTimeStep(const std::string& text, std::uint32_t& rate) {
  if (!text.starts_with("1/")) return false;
  const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), rate);
  return error == std::errc() && end == text.data() + text.size() && rate > 0 && rate <= 1000000;
}

std::vector<std::string> commandWords() {
  std::vector<std::string> words{"none"};
  for (std::uint8_t kind = 0; kind < kCommandKinds; ++kind) {
    words.emplace_back(commandName(static_cast<CommandKind>(kind)));
  }
  return words;
}

Expectations expectationsOf(const CLI::App& word, const ExpectedWords& words) {
  Expectations expected;
  std::uint64_t hash = 0;
  std::uint32_t rate = 0;
  if (readHash(words.firstHash, hash)) expected.firstHash = hash;
  if (readTimeStep(words.timeStep, rate)) expected.stepsPerSecond = rate;
  if (!words.scalar.empty()) {
    expected.scalar = words.scalar == "fixed" ? ScalarKind::fixed : ScalarKind::float64;
  }
  if (word.count("--ticks") > 0) expected.ticks = words.ticks;
  if (word.count("--first-tick") > 0) expected.firstTick = words.firstTick;
  if (words.commands.empty()) return expected;
  expected.commands = 0;
  for (std::uint8_t kind = 0; kind < kCommandKinds; ++kind) {
    const std::string name = commandName(static_cast<CommandKind>(kind));
    const bool allowed =
        std::find(words.commands.begin(), words.commands.end(), name) != words.commands.end();
    if (allowed) expected.commands |= 1u << kind;
  }
  return expected;
}

/// Adds the options of expectations.
void addExpectations(CLI::App& word, ExpectedWords& words) {
  const auto hashes = [](const std::string& text) {
    std::uint64_t hash = 0;
    return readHash(text, hash) ? std::string() : "16 hexadecimal digits are wanted, not " + text;
  };
  const auto steps = [](const std::string& text) {
    std::uint32_t rate = 0;
    return readTimeStep(text, rate) ? std::string() : "1/60 or the like is wanted, not " + text;
  };
  word.add_option("--expect-first-hash", words.firstHash, "The hash that the world must have at the start")
      ->check(CLI::Validator(hashes, "HASH"));
  word.add_option("--time-step", words.timeStep, "How long each step must be, in seconds, as 1/60")
      ->check(CLI::Validator(steps, "1/N"));
  word.add_option("--scalar", words.scalar, "The number type that it must be recorded with")
      ->check(CLI::IsMember({"fixed", "double"}));
  word.add_option("--ticks", words.ticks, "How many steps it must have")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40));
  word.add_option("--first-tick", words.firstTick, "How many steps the world must have made at the start");
  word.add_option("--allow-commands", words.commands, "The kinds of command there may be, or none")
      ->delimiter(',')
      ->check(CLI::IsMember(commandWords()));
}

}  // namespace

void addVerify(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "verify", "Replay recordings and check that every tick comes out as it was recorded");
  auto files = std::make_shared<std::vector<std::string>>();
  word->add_option("FILE", *files, "Recordings, as 'samestep record' or a game wrote them")->required();
  auto compute = std::make_shared<ComputeOptions>();
  addComputeOptions(*word, *compute);
  auto expected = std::make_shared<ExpectedWords>();
  addExpectations(*word, *expected);
  // For recordings from strangers.
  auto limits = std::make_shared<RecordingLimits>();
  auto seconds = std::make_shared<std::int64_t>(0);
  word->add_option("--max-bodies", limits->bodies, "Refuse recordings of worlds with more bodies")
      ->capture_default_str();
  word->add_option("--max-shapes", limits->shapes, "Refuse those with more shapes")->capture_default_str();
  word->add_option("--max-pairs", limits->pairs, "Refuse those with more shapes near each other")
      ->check(CLI::Range(std::uint32_t{0}, kMostPairs))
      ->capture_default_str();
  word->add_option("--max-handlers", limits->handlers, "Refuse those with more collision handlers bound")
      ->capture_default_str();
  word->add_option("--max-iterations", limits->iterations,
                   "Refuse those whose steps solve contacts more often, by sequential impulses")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  word->add_option("--max-substeps", limits->substeps, "Refuse those whose steps have more substeps")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  word->add_option("--max-commands", limits->commandsPerTick, "Refuse those with more commands before a step")
      ->capture_default_str();
  word->add_option("--max-bytes", limits->bytes, "Refuse files that are larger; no more of them is read")
      ->capture_default_str();
  word->add_option("--max-work", limits->work,
                   "Refuse those that take more work, in units of about 10 ns: the same on every machine")
      ->check(CLI::Range(std::uint64_t{1}, ~std::uint64_t{0}));
  word->add_option("--max-seconds", *seconds, "Give up after so many seconds for a recording")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 30));
  word->callback([files, compute, limits, seconds, expected, word, &result] {
    VerifyOptions options;
    options.kernel = compute->target();
    options.limits = *limits;
    options.expected = expectationsOf(*word, *expected);
    WorkerPool pool(compute->workers);
    options.workers = &pool;
    result = kGood;
    for (const std::string& file : *files) result = std::max(result, verifyFile(file, options, *seconds));
  });
}

}  // namespace samestep::program
