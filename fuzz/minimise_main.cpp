// SPDX-License-Identifier: MIT
// Chooses from the files of folders few and small ones that together reach every edge that all of them reach,
// and prints their names: again and again the file that reaches most new edges for its size. libFuzzer's
// -merge takes the smallest first, which leaves several times as many.
// Usage: minimise_TARGET LEAST FOLDER...    LEAST: how many edges a file must reach that no other does, but
// for small ones, which count for a single one: most refusals of a parser are one edge and need few bytes.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" void __sanitizer_cov_8bit_counters_init(std::uint8_t* begin, std::uint8_t* end);
extern "C" void __sanitizer_cov_pcs_init(const std::uintptr_t* begin, const std::uintptr_t* end);
extern "C" void __sanitizer_cov_trace_pc_indir(std::uintptr_t callee);
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

namespace {

using Counters = std::pair<std::uint8_t*, std::uint8_t*>;
Counters modules[16];
std::size_t moduleCount = 0;

struct Candidate {
  std::filesystem::path path;
  std::size_t size = 0;
  std::vector<std::uint32_t> edges;
};

/// The size in bytes of a file that one edge is worth.
constexpr std::size_t kSmall = 160;

void clearCounters() {
  for (std::size_t i = 0; i < moduleCount; ++i)
    std::fill(modules[i].first, modules[i].second, std::uint8_t{0});
}

std::vector<std::uint32_t> reachedEdges() {
  std::vector<std::uint32_t> edges;
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < moduleCount; ++i) {
    for (const std::uint8_t* at = modules[i].first; at != modules[i].second; ++at, ++number) {
      if (*at != 0) edges.push_back(number);
    }
  }
  return edges;
}

std::size_t unknownIn(const Candidate& candidate, const std::vector<bool>& known) {
  return static_cast<std::size_t>(std::count_if(candidate.edges.begin(), candidate.edges.end(),
                                                [&](std::uint32_t edge) { return !known[edge]; }));
}

}  // namespace

// Each module calls this before main; nothing of the standard library is ready then.
void __sanitizer_cov_8bit_counters_init(std::uint8_t* begin, std::uint8_t* end) {
  if (begin == end || moduleCount == std::size(modules)) return;
  if (moduleCount > 0 && modules[moduleCount - 1].first == begin) return;
  modules[moduleCount++] = {begin, end};
}
void __sanitizer_cov_pcs_init(const std::uintptr_t*, const std::uintptr_t*) {}
void __sanitizer_cov_trace_pc_indir(std::uintptr_t) {}
std::size_t LLVMFuzzerMutate(std::uint8_t*, std::size_t size, std::size_t) { return size; }

int main(int argc, char** argv) {
  std::vector<Candidate> left;
  const std::size_t least = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1;
  for (int i = 2; i < argc; ++i) {
    for (const auto& entry : std::filesystem::directory_iterator(argv[i])) {
      if (entry.is_regular_file()) left.push_back({entry.path(), 0, {}});
    }
  }
  // The first run makes whatever a static needs.
  LLVMFuzzerTestOneInput(nullptr, 0);
  std::sort(left.begin(), left.end(), [](const Candidate& a, const Candidate& b) { return a.path < b.path; });
  std::uint32_t edgeCount = 0;
  for (Candidate& candidate : left) {
    std::ifstream file(candidate.path, std::ios::binary);
    const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file),
                                          std::istreambuf_iterator<char>()};
    clearCounters();
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    candidate.size = bytes.size();
    candidate.edges = reachedEdges();
    if (!candidate.edges.empty()) edgeCount = std::max(edgeCount, candidate.edges.back() + 1);
  }

  std::vector<bool> known(edgeCount);
  for (;;) {
    const Candidate* best = nullptr;
    double most = 0;
    for (const Candidate& candidate : left) {
      const std::size_t unknown = unknownIn(candidate, known);
      const double worth = static_cast<double>(unknown) / (64 + static_cast<double>(candidate.size));
      if (unknown < (candidate.size <= kSmall ? 1 : least) || worth <= most) continue;
      most = worth;
      best = &candidate;
    }
    if (best == nullptr) return 0;
    for (const std::uint32_t edge : best->edges) known[edge] = true;
    std::printf("%s\n", best->path.c_str());
  }
}
