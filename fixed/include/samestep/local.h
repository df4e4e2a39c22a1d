#pragma once

#include <cstdint>

#include "samestep/expects.h"
#include "samestep/fixed.h"
#include "samestep/scalar_results.h"

namespace samestep {

/// Numbers for comparing places that are near each other: less than 2^9 m apart along each axis. A place is
/// cut to 2^-22 m, a unit vector to 2^-30, and sums of two products of a place and a unit are exact in 64
/// bits, in units of 2^-52 m.
template <FixedNumber S>
requires(S::kBits == 32) struct LocalOf<S> {
  using type = std::int64_t;
};

/// Distance that places may have for localPlace, m.
inline constexpr int kLocalReach = 1 << 9;

/// A difference of places, of magnitude below kLocalReach.
template <FixedNumber S>
constexpr std::int64_t localPlace(S difference) {
  expects(difference > S(-kLocalReach) && difference < S(kLocalReach));
  return difference.raw() >> 10;
}
/// A component of a unit vector.
template <FixedNumber S>
constexpr std::int64_t localUnit(S component) {
  return component.raw() >> 2;
}
/// A length of magnitude below kLocalReach in the units of localDot.
template <FixedNumber S>
constexpr std::int64_t localLength(S length) {
  expects(length > S(-kLocalReach) && length < S(kLocalReach));
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(length.raw()) << 20);
}
/// x nx + y ny of a place and a unit vector, exactly.
constexpr std::int64_t localDot(std::int64_t x, std::int64_t y, std::int64_t nx, std::int64_t ny) {
  return x * nx + y * ny;
}

}  // namespace samestep
