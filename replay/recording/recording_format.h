// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace samestep {

/// Not text, spoilt by whatever changes line ends or cuts the eighth bit.
inline constexpr std::uint8_t kRecordingMagic[8] = {0x89, 'S', 'A', 'M', 'E', '\r', '\n', 0x1a};

// Offsets of the header, and of the first world behind it.
inline constexpr std::uint64_t kVersionAt = 8;
inline constexpr std::uint64_t kRevisionAt = 12;
inline constexpr std::uint64_t kScalarAt = 16;
inline constexpr std::uint64_t kTimeStepAt = 20;
inline constexpr std::uint64_t kWorldAt = 28;

/// Limits of one command.
inline constexpr std::uint32_t kMaxSpawnShapes = 256;
inline constexpr std::uint32_t kMaxInputBytes = 1u << 16;

}  // namespace samestep
