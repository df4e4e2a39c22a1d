// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "peer_worlds.h"

namespace samestep::bench {

/// Bytes by which the peak resident memory of a process of its own grows while it builds a world and runs
/// `steps` steps; nothing where the system does not tell. Library pages first touched are counted too.
std::optional<long long> peakGrowth(const std::string& engine, const PeerScene& scene, int steps);

}  // namespace samestep::bench
