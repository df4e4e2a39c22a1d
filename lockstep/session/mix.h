// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace samestep::lockstep {

/// The finisher of SplitMix64: each bit of the answer goes by all bits of the value.
inline std::uint64_t mix(std::uint64_t value) {
  value = (value ^ value >> 30) * 0xbf58476d1ce4e5b9u;
  value = (value ^ value >> 27) * 0x94d049bb133111ebu;
  return value ^ value >> 31;
}

/// One number from two, such that neither is lost.
inline std::uint64_t mix(std::uint64_t a, std::uint64_t b) { return mix(a * 0x9e3779b97f4a7c15u + b); }

}  // namespace samestep::lockstep
