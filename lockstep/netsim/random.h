// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "session/mix.h"

namespace samestep::netsim {

/// SplitMix64: the same numbers from a seed everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() { return lockstep::mix(state_ += 0x9e3779b97f4a7c15u); }
  /// Below `bound`, which is not 0.
  std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>((next() >> 32) * bound >> 32);
  }
  /// Random number from `least` to `most`, both included.
  std::uint32_t within(std::uint32_t least, std::uint32_t most) { return least + below(most - least + 1); }
  /// True so many times in a thousand.
  bool perMille(std::uint32_t chance) { return below(1000) < chance; }

 private:
  std::uint64_t state_;
};

}  // namespace samestep::netsim
