// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace samestep {

/// Not text, spoilt by whatever changes line ends or cuts the eighth bit.
inline constexpr std::uint8_t kRecordingMagic[8] = {0x89, 'S', 'A', 'M', 'E', '\r', '\n', 0x1a};

/// Limits of one command.
inline constexpr std::uint32_t kMaxSpawnShapes = 256;
inline constexpr std::uint32_t kMaxInputBytes = 1u << 16;

}  // namespace samestep
