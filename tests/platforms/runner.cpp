// SPDX-License-Identifier: MIT
// What scripts/platforms runs on each platform: runner [--recorded] [--ticks N] [--kernel NAME] [--workers N]
// RECORDING...
// Other options are refused.
// Prints a line about the platform, then one for each tick of each recording: its name, the tick, the hash of
// the world after it, computed here; with --recorded the hash that the recording carries. Output goes through
// printf, as <iostream> would be most of the program.
#include <bit>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include <samestep/named_handlers.h>
#include <samestep/replay.h>
#include <samestep/version.h>
#include <samestep/workers.h>

namespace samestep {
namespace {

[[noreturn]] void stop(const char* path, const char* reason) {
  std::printf("%s: %s\n", path, reason);
  std::exit(1);
}

std::vector<std::uint8_t> readFile(const char* path) {
  std::FILE* file = std::fopen(path, "rb");
  if (file == nullptr) stop(path, "cannot be opened");
  std::vector<std::uint8_t> bytes;
  std::uint8_t chunk[4096];
  while (const std::size_t count = std::fread(chunk, 1, sizeof chunk, file)) {
    bytes.insert(bytes.end(), chunk, chunk + count);
  }
  std::fclose(file);
  return bytes;
}

/// The part of a path after the last slash.
std::string_view nameOf(std::string_view path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

struct Options {
  bool recorded = false;
  std::uint64_t ticks = ~std::uint64_t{0};
  KernelTarget kernel = KernelTarget::best;
  int workers = 1;
};

template <Scalar S>
void run(std::string_view name, const std::vector<std::uint8_t>& bytes, const Options& options) {
  WorkerPool pool(options.workers);
  Replay<S> replay(bytes, namedHandlerWiring<S>());
  replay.space().setWorkers(&pool, Sharing::always);
  replay.space().forceKernel(options.kernel);
  while (replay.tick() < options.ticks && replay.step()) {
    const std::uint64_t hash = options.recorded ? replay.recordedHash() : replay.space().hash();
    std::printf("%.*s %" PRIu64 " %016" PRIx64 "\n", static_cast<int>(name.size()), name.data(),
                replay.tick(), hash);
  }
}

void runFile(const char* path, const Options& options) {
  const std::vector<std::uint8_t> bytes = readFile(path);
  if (recordingInfo(bytes).scalar == ScalarKind::fixed) {
    run<Fixed>(nameOf(path), bytes, options);
    return;
  }
#ifndef SAMESTEP_FIXED_ONLY
  run<double>(nameOf(path), bytes, options);
#else
  stop(path, "this build has no double");
#endif
}

void describePlatform() {
  const std::string_view name = compiler();
  std::printf("platform: %d %s %.*s\n", static_cast<int>(8 * sizeof(void*)),
              std::endian::native == std::endian::little ? "little" : "big", static_cast<int>(name.size()),
              name.data());
  // So that it is seen even if the program does not come to its end.
  std::fflush(stdout);
}

}  // namespace
}  // namespace samestep

int main(int argumentCount, char** arguments) {
  samestep::Options options;
  samestep::describePlatform();
  for (int i = 1; i < argumentCount; ++i) {
    const std::string_view argument = arguments[i];
    if (argument == "--recorded") {
      options.recorded = true;
    } else if (argument == "--ticks" && i + 1 < argumentCount) {
      options.ticks = std::strtoull(arguments[++i], nullptr, 10);
    } else if (argument == "--kernel" && i + 1 < argumentCount) {
      ++i;
      if (!samestep::findKernel(arguments[i], options.kernel)) samestep::stop(arguments[i], "no such kernel");
      if (!samestep::isAvailable(options.kernel)) samestep::stop(arguments[i], "not on this machine");
    } else if (argument == "--workers" && i + 1 < argumentCount) {
      options.workers = static_cast<int>(std::strtol(arguments[++i], nullptr, 10));
    } else if (argument.starts_with("--")) {
      samestep::stop(arguments[i], "unknown option");
    } else {
      samestep::runFile(arguments[i], options);
    }
  }
  std::puts("end");
  return 0;
}
