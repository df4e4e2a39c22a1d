// SPDX-License-Identifier: MIT
#include <charconv>

#include "peer_worlds.h"

namespace samestep::bench {
namespace {

/// The number after a prefix, or 0 if `text` is not the prefix and a number up to 100.
int countAfter(const std::string& text, const std::string& prefix) {
  if (!text.starts_with(prefix)) return 0;
  int count = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + prefix.size(), end, count);
  return read.ec == std::errc() && read.ptr == end && count <= 100 ? count : 0;
}

std::unique_ptr<World> makeSamestep(const std::string& engine, const PeerScene& scene, const char* prefix,
                                    std::unique_ptr<World> (*make)(const PeerScene&, SolverChoice)) {
  const std::pair<const char*, SolverChoice> kinds[] = {
      {"impulses", {}}, {"soft", {true, false, 0}}, {"fast", {true, true, 0}}};
  std::string name = engine;
  KernelTarget kernel = KernelTarget::best;
  if (const std::size_t at = name.rfind('-');
      at != std::string::npos && findKernel(name.c_str() + at + 1, kernel)) {
    if (!isAvailable(kernel)) return nullptr;
    name.resize(at);
  }
  const std::size_t mark = name.rfind('x');
  const bool shared = mark != std::string::npos && mark > std::string(prefix).size();
  for (auto [kind, choice] : kinds) {
    choice.count = countAfter(name.substr(0, shared ? mark : name.size()), std::string(prefix) + kind);
    choice.workers = shared ? countAfter(name.substr(mark), "x") : 1;
    choice.kernel = kernel;
    if (choice.workers == 0) return nullptr;
    if (choice.count > 0) return make(scene, choice);
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<World> makeWorld(const std::string& engine, const PeerScene& scene) {
  if (engine == "chipmunk") return makeChipmunk(scene, 10);
  if (const int iterations = countAfter(engine, "chipmunk"); iterations > 0) {
    return makeChipmunk(scene, iterations);
  }
  if (engine == "box2d24") return makeBox2d(scene);
  if (auto world = makeSamestep(engine, scene, "samestep-double-", makeDouble)) return world;
  return makeSamestep(engine, scene, "samestep-fixed-", makeFixed);
}

}  // namespace samestep::bench
