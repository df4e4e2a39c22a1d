// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <samestep/version.h>

namespace samestep::fuzz {

// These mend what chance never gets right in a snapshot or recording, and what ages: docs/formats.md has the
// places.

template <class Number>
void putNumber(std::vector<std::uint8_t>& bytes, std::size_t at, Number value) {
  for (std::size_t i = 0; i < sizeof value; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

/// The revision of the simulation: today's, so that inputs outlive a change of results.
inline void mendRevision(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kAt = 12;
  if (bytes.size() >= kAt + sizeof kSimulationRevision) putNumber(bytes, kAt, kSimulationRevision);
}

/// The size of a snapshot.
inline void mendSize(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kAt = 20;
  if (bytes.size() >= kAt + sizeof(std::uint64_t)) putNumber(bytes, kAt, std::uint64_t{bytes.size()});
}

/// The checksum at the end, over all that is before it; after everything else.
inline void mendChecksum(std::vector<std::uint8_t>& bytes) {
  if (bytes.size() < sizeof(std::uint64_t)) return;
  const std::size_t at = bytes.size() - sizeof(std::uint64_t);
  putNumber(bytes, at, std::uint64_t{XXH3_64bits(bytes.data(), at)});
}

}  // namespace samestep::fuzz
