// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <samestep/space_codec.h>

namespace samestep::fuzz {

// The portable form of a world, in one place: what the snapshot target reads and writes.

inline constexpr WorldLimits kFuzzLimits = {64, 64, 256, 32};

/// @throws FormatError
template <Scalar S>
WorldState<S> readWorld(std::span<const std::uint8_t> bytes, std::uint64_t& end) {
  end = 0;
  return decodeWorld<S>(bytes, end, kFuzzLimits);
}

template <Scalar S>
std::vector<std::uint8_t> writeWorld(const WorldState<S>& world) {
  std::vector<std::uint8_t> bytes;
  encodeWorld(world, bytes);
  return bytes;
}

}  // namespace samestep::fuzz
