// SPDX-License-Identifier: MIT
#include "peer_memory.h"

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

namespace samestep::bench {
namespace {

/// Bytes of a line of /proc/self/status, or -1.
long long statusBytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key + ":")) return 1024 * std::atoll(line.c_str() + key.size() + 1);
  }
  return -1;
}

long long growthHere(const std::string& engine, const PeerScene& scene, int steps) {
  // The allocator's threshold at its default, or it is what reading the scenes made of it.
  mallopt(M_MMAP_THRESHOLD, 128 * 1024);
  // Memory freed before and kept by the allocator would hide what the world needs.
  malloc_trim(0);
  const long long before = statusBytes("VmRSS");
  const std::unique_ptr<World> world = makeWorld(engine, scene);
  for (int i = 0; i < steps; ++i) world->step();
  const long long peak = statusBytes("VmHWM");
  return before < 0 || peak < 0 ? -1 : peak - before;
}

}  // namespace

std::optional<long long> peakGrowth(const std::string& engine, const PeerScene& scene, int steps) {
  int ends[2];
  if (pipe(ends) != 0) return std::nullopt;
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) return std::nullopt;
  if (child == 0) {
    const long long growth = growthHere(engine, scene, steps);
    const bool told = write(ends[1], &growth, sizeof growth) == static_cast<ssize_t>(sizeof growth);
    _exit(told ? 0 : 1);
  }
  close(ends[1]);
  long long growth = -1;
  const bool read_ = read(ends[0], &growth, sizeof growth) == static_cast<ssize_t>(sizeof growth);
  close(ends[0]);
  waitpid(child, nullptr, 0);
  if (!read_ || growth < 0) return std::nullopt;
  return growth;
}

}  // namespace samestep::bench
