// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/collision.h>
#include <samestep/events.h>
#include <samestep/state.h>

namespace samestep {

/// What a step tells beside the state, read after it.
template <Scalar S>
struct StepEvents {
  std::vector<RangeEvent> range;
  CollisionStats collisionStats{};
  std::uint64_t accurateInstead = 0;
  /// Of each body slot, the bits of Body::Held that the step under way noted.
  std::vector<std::uint8_t> held;

  void begin(const WorldState<S>& world) { held.assign(world.bodies.slots(), 0); }
  /// Lists what was held, by body id.
  void listRange(const WorldState<S>& world) {
    range.clear();
    for (std::uint32_t i = 0; i < held.size(); ++i) {
      if (held[i] != 0) [[unlikely]]
        range.push_back({world.bodies.idAt(i), held[i]});
    }
  }
};

}  // namespace samestep
