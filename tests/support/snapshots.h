// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <samestep/snapshot.h>
#include "support/recordings.h"

namespace samestep {

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
  mendChecksum(bytes);
  return bytes;
}

}  // namespace samestep
