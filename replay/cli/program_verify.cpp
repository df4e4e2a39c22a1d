// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>

#include <samestep/verify.h>
#include <samestep/workers.h>

#include "cli/commands.h"

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

int verifyFiles(const VerifyFilesOptions& options) {
  VerifyOptions each;
  each.kernel = options.compute.target();
  each.limits = options.limits;
  WorkerPool pool(options.compute.workers);
  each.workers = &pool;
  int result = kGood;
  for (const std::string& file : options.files)
    result = std::max(result, verifyFile(file, each, options.seconds));
  return result;
}

}  // namespace samestep::program
