// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace samestep {

/// Magic that is not text, spoilt by whatever changes line ends or cuts the eighth bit.
inline constexpr std::uint8_t kRecordingMagic[8] = {0x89, 'S', 'A', 'M', 'E', '\r', '\n', 0x1a};

// Offsets of the header, and of what is behind it: in version 2 the first world.
inline constexpr std::uint64_t kVersionAt = 8;
inline constexpr std::uint64_t kRevisionAt = 12;
inline constexpr std::uint64_t kScalarAt = 16;
inline constexpr std::uint64_t kTimeStepAt = 20;
inline constexpr std::uint64_t kWorldAt = 28;

/// Limits of one command.
inline constexpr std::uint32_t kMaxSpawnShapes = 256;
inline constexpr std::uint32_t kMaxInputBytes = 1u << 16;

/// Kind of a recording's section, from version 3 on.
enum class SectionKind : std::uint8_t {
  keyframe = 1,  ///< Tick, hash, world.
  ticks = 2,     ///< Items of whole ticks.
  notes = 3,     ///< Keys and values without meaning here.
  index = 4,     ///< Places of the keyframes.
  end = 5,       ///< Number of ticks, and the place of the index.
};

/// In the byte of a section's kind: its payload is packed by zstd.
inline constexpr std::uint8_t kPackedBit = 0x80;
/// Kind and length before the payload, the chain behind it.
inline constexpr std::uint64_t kSectionHeadBytes = 5;
inline constexpr std::uint64_t kUnpackedLengthBytes = 4;
inline constexpr std::uint64_t kChainBytes = 8;
/// Size of what stands before the world in a keyframe: its tick and its hash.
inline constexpr std::uint64_t kKeyframeHeadBytes = 16;
inline constexpr std::uint64_t kIndexEntryBytes = 24;

// A packed payload unpacks to at most so many bytes, and to at most so many for each of its own, so that what
// a recording can ask for is in proportion to its size.
inline constexpr std::uint32_t kMaxUnpackedBytes = 1u << 26;
inline constexpr std::uint32_t kMaxUnpackedPerByte = 64;

}  // namespace samestep
