// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <samestep/space.h>

namespace samestep {

/// How large a world from outside may be.
struct WorldLimits {
  std::uint32_t bodies = 1u << 16;
  std::uint32_t shapes = 1u << 16;
  std::uint32_t pairs = 1u << 20;
  std::uint32_t handlers = 1u << 12;
};

/// Appends the canonical bytes of a world: little-endian, field by field, the same everywhere.
template <Scalar S>
void encodeWorld(const WorldState<S>& world, std::vector<std::uint8_t>& bytes);

/// Reads a world from `offset` on and moves it past. Whatever the bytes are, the world is one a Space can
/// have, fit for Space::adopt, or there is none; memory is taken for what has been read only.
/// @throws FormatError
template <Scalar S>
WorldState<S> decodeWorld(std::span<const std::uint8_t> bytes, std::uint64_t& offset,
                          const WorldLimits& limits = {});

/// Why no Space could have this state, or null.
template <Scalar S>
const char* flawOf(const WorldState<S>& world, const WorldLimits& limits = {});

#ifndef SAMESTEP_FIXED_ONLY
extern template void encodeWorld<double>(const WorldState<double>&, std::vector<std::uint8_t>&);
extern template WorldState<double> decodeWorld<double>(std::span<const std::uint8_t>, std::uint64_t&,
                                                       const WorldLimits&);
extern template const char* flawOf<double>(const WorldState<double>&, const WorldLimits&);
#endif
extern template void encodeWorld<Fixed>(const WorldState<Fixed>&, std::vector<std::uint8_t>&);
extern template WorldState<Fixed> decodeWorld<Fixed>(std::span<const std::uint8_t>, std::uint64_t&,
                                                     const WorldLimits&);
extern template const char* flawOf<Fixed>(const WorldState<Fixed>&, const WorldLimits&);
extern template void encodeWorld<CheckedFixed>(const WorldState<CheckedFixed>&, std::vector<std::uint8_t>&);
extern template WorldState<CheckedFixed> decodeWorld<CheckedFixed>(std::span<const std::uint8_t>,
                                                                   std::uint64_t&, const WorldLimits&);
extern template const char* flawOf<CheckedFixed>(const WorldState<CheckedFixed>&, const WorldLimits&);

}  // namespace samestep
