// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "recording/recording_format.h"

namespace samestep {

/// One section of a recording, as its first bytes tell it.
struct RecordingSection {
  SectionKind kind{};
  bool packed = false;
  /// True if the recording ends within it; of a payload that is not packed, what is there is told.
  bool cut = false;
  std::uint64_t at = 0;
  std::uint64_t payloadAt = 0;
  std::uint64_t payloadBytes = 0;
  std::uint32_t unpackedBytes = 0;
  std::uint64_t end = 0;
};

/// The hash that the chain of a recording begins with: that of its header.
std::uint64_t chainOf(std::span<const std::uint8_t> header);
/// The chain after a section: the hash of its bytes, up to where the chain stands, seeded with the chain
/// before.
std::uint64_t chainAfter(std::uint64_t chain, std::span<const std::uint8_t> section);

/// Reads where a section begins and ends.
/// @param mayBeCut  answers a section that goes beyond the bytes as cut
/// @throws FormatError
RecordingSection readSection(std::span<const std::uint8_t> bytes, std::uint64_t offset, bool mayBeCut);
/// Checks a whole section's link and moves the chain on.
/// @throws FormatError
void checkChain(std::span<const std::uint8_t> bytes, const RecordingSection& section, std::uint64_t& chain);

}  // namespace samestep
