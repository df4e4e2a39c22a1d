// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>

#include <samestep/verify.h>
#include <samestep/workers.h>

#include "cli/program.h"

namespace samestep::program {
namespace {

void report(const std::string& file, const VerifyResult& result, std::int64_t milliseconds) {
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
    return end == 0 || milliseconds() < end;
  }
};

int verifyFile(const std::string& file, VerifyOptions options, std::int64_t seconds) {
  try {
    const std::vector<std::uint8_t> bytes = readFile(file);
    const std::int64_t start = milliseconds();
    Watch watch;
    if (seconds != 0) watch.end = start + seconds * 1000;
    options.data = &watch;
    options.progress = [](std::uint64_t done, std::uint64_t total, void* data) {
      return static_cast<Watch*>(data)->after(done, total);
    };
    const VerifyResult result = verify(bytes, options);
    const std::int64_t took = milliseconds() - start;
    watch.progress.clear();
    if (result.stopped) throw Unusable("takes longer than " + std::to_string(seconds) + " s");
    report(file, result, took);
    return result.matches ? kGood : kMismatch;
  } catch (const std::exception& error) {
    tell(file, error);
    return kUnusable;
  }
}

}  // namespace

void addVerify(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "verify", "Replay recordings and check that every tick comes out as it was recorded");
  auto files = std::make_shared<std::vector<std::string>>();
  word->add_option("FILE", *files, "Recordings, as 'samestep record' or a game wrote them")->required();
  auto compute = std::make_shared<ComputeOptions>();
  addComputeOptions(*word, *compute);
  // For recordings from strangers.
  auto limits = std::make_shared<WorldLimits>();
  auto seconds = std::make_shared<std::int64_t>(0);
  word->add_option("--max-bodies", limits->bodies, "Refuse recordings of worlds with more bodies")
      ->capture_default_str();
  word->add_option("--max-shapes", limits->shapes, "Refuse those with more shapes")->capture_default_str();
  word->add_option("--max-pairs", limits->pairs, "Refuse those with more shapes near each other")
      ->check(CLI::Range(std::uint32_t{0}, kMostPairs))
      ->capture_default_str();
  word->add_option("--max-seconds", *seconds, "Give up after so many seconds for a recording")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 30));
  word->callback([files, compute, limits, seconds, &result] {
    VerifyOptions options;
    options.kernel = compute->target();
    options.limits = *limits;
    WorkerPool pool(compute->workers);
    options.workers = &pool;
    result = kGood;
    for (const std::string& file : *files) result = std::max(result, verifyFile(file, options, *seconds));
  });
}

}  // namespace samestep::program
