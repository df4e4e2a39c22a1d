// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <samestep/state_diff.h>
#include <samestep/verify.h>

namespace samestep {

/// Place where two recordings part.
struct ReplayDifference {
  bool worldsDiffer = false;
  /// The first step after which they do, 0 for the worlds before the first; else the steps compared.
  std::uint64_t tick = 0;
  /// Place in that step: "start", "commands" (before the step itself), or the name of a stage.
  std::string stage;
  /// There, at most as many as asked for.
  std::vector<FieldDifference> fields;
  /// The first step before which different things were done, 0 if there is none up to `tick`.
  std::uint64_t commandTick = 0;
  /// Commands that only one of them has then, in words, at most a thousand; both empty where only the order
  /// differs. Commands are compared by all their bytes, the game's own input too.
  std::vector<std::string> onlyA;
  std::vector<std::string> onlyB;
};

/// Replays two recordings side by side until their worlds differ, one ends, or options.progress says stop.
/// @throws as verify
template <Scalar S>
ReplayDifference findDifference(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                                const Wiring<S>& wiring, std::uint32_t mostFields,
                                const VerifyOptions& options = {});

}  // namespace samestep
