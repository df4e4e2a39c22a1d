// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <samestep/snapshot.h>
#include <xxhash.h>

#include "support/recordings.h"

namespace samestep {

/// Writes the checksum at the end of a snapshot again.
inline void mendSnapshot(Bytes& bytes) {
  if (bytes.size() < 8) return;
  const std::size_t at = bytes.size() - 8;
  const std::uint64_t checksum = XXH3_64bits(bytes.data(), at);
  for (unsigned i = 0; i < 8; ++i) bytes[at + i] = static_cast<std::uint8_t>(checksum >> (8 * i));
}

template <Scalar S>
Bytes snapshotOf(const Space<S>& space) {
  Bytes bytes(static_cast<std::size_t>(saveSnapshot(space, {})));
  saveSnapshot(space, bytes);
  return bytes;
}

/// A snapshot of a state, however wrong that is: with the header of another snapshot and a checksum that is
/// right.
template <Scalar S>
Bytes snapshotOf(const WorldState<S>& world) {
  Bytes bytes = snapshotOf(Space<S>());
  bytes.resize(28);
  encodeWorld(world, bytes);
  bytes.resize(bytes.size() + 8);
  for (unsigned i = 0; i < 8; ++i) bytes[20 + i] = static_cast<std::uint8_t>(bytes.size() >> (8 * i));
  mendSnapshot(bytes);
  return bytes;
}

}  // namespace samestep
