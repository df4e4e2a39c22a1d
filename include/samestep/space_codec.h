// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <samestep/space.h>

namespace samestep {

/// The format of worlds that encodeWorld writes; decodeWorld reads every one from 1 up to it.
inline constexpr std::uint32_t kWorldFormat = 2;

/// Writes the bytes of a world as snapshots and recordings hold it: little-endian, field by field, the same
/// everywhere, with what a number shares with the record before left out; see docs/formats.md.
/// @return how many bytes that is; where `into` has less room, its content is of no use
template <Scalar S>
std::uint64_t encodeWorld(const WorldState<S>& world, std::span<std::uint8_t> into);
/// Appends them.
template <Scalar S>
void encodeWorld(const WorldState<S>& world, std::vector<std::uint8_t>& bytes);

/// Reads a world from `offset` on and moves it past. Whatever the bytes are, the world is one a Space can
/// have, fit for Space::adopt, or there is none; memory is taken for no more objects than the limits allow
/// and the bytes left could tell of.
/// @param format  the one that wrote the bytes: what came later keeps its default
/// @throws FormatError, UnsoundArithmetic
template <Scalar S>
WorldState<S> decodeWorld(std::span<const std::uint8_t> bytes, std::uint64_t& offset,
                          const WorldLimits& limits = {}, std::uint32_t format = kWorldFormat);

/// Reason why no Space could have this state, or null.
template <Scalar S>
const char* flawOf(const WorldState<S>& world, const WorldLimits& limits = {});

}  // namespace samestep
