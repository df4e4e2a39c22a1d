// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>

#include <samestep/verify.h>
#include <samestep/workers.h>

#include "program.h"

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

int verifyFile(const std::string& file, KernelTarget kernel, TaskRunner& workers) {
  try {
    const std::vector<std::uint8_t> bytes = readFile(file);
    Progress progress("verify", 0);
    VerifyOptions options;
    options.data = &progress;
    options.kernel = kernel;
    options.workers = &workers;
    options.progress = [](std::uint64_t done, std::uint64_t total, void* data) {
      static_cast<Progress*>(data)->at(done, total);
      return true;
    };
    const std::int64_t start = milliseconds();
    const VerifyResult result = verify(bytes, options);
    const std::int64_t took = milliseconds() - start;
    progress.clear();
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
  word->callback([files, compute, &result] {
    const KernelTarget kernel = compute->target();
    WorkerPool pool(compute->workers);
    result = kGood;
    for (const std::string& file : *files) result = std::max(result, verifyFile(file, kernel, pool));
  });
}

}  // namespace samestep::program
