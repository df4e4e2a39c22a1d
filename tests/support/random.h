// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/scalar.h>

namespace samestep {

/// Splitmix64: the same numbers on every platform, unlike the standard distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  /// Number in [0, count). @pre count > 0
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>((next() >> 32) * count >> 32);
  }
  /// Number in [low, high].
  int between(int low, int high) {
    return low + static_cast<int>(below(static_cast<std::uint32_t>(high - low + 1)));
  }
  bool oneIn(std::uint32_t count) { return below(count) == 0; }

  /// A multiple of 2^-10 in [low, high]: exact in every scalar.
  template <Scalar S>
  S number(int low, int high) {
    return ratio<S>(between(low * 1024, high * 1024), 1024);
  }

 private:
  std::uint64_t state_;
};

}  // namespace samestep
