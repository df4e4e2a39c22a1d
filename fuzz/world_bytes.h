// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <samestep/snapshot.h>
#include <samestep/space_codec.h>

#include "mend.h"

namespace samestep::fuzz {

// The portable form of a world, in one place: what the snapshot target reads and writes.

/// An input of the snapshot target. Its first byte says how the others are meant.
struct SnapshotInput {
  bool isDouble;
  bool isWhole;  ///< A snapshot, and not a bare world.
  OtherRevision otherRevision;
  std::vector<std::uint8_t> bytes;  ///< Bytes made good, where the first one says so.

  /// @pre !input.empty()
  explicit SnapshotInput(std::span<const std::uint8_t> input)
      : isDouble((input[0] & 1) != 0),
        isWhole((input[0] & 2) != 0),
        otherRevision((input[0] & 8) != 0 ? OtherRevision::refuse : OtherRevision::takeStateOnly),
        bytes(input.begin() + 1, input.end()) {
    if (!isWhole || (input[0] & 4) != 0) return;
    if (otherRevision == OtherRevision::refuse) mendRevision(bytes);
    mendSize(bytes);
    mendChecksum(bytes);
  }
};

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
