#pragma once

#include <cstdint>

namespace samestep {

/// splitmix64: the same numbers everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed = 1) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
  }
  /// Every size from 1 to 64 bits alike, either sign.
  std::int64_t anySize() {
    const std::uint64_t bits = next();
    return static_cast<std::int64_t>(bits) >> (next() % 64);
  }

 private:
  std::uint64_t state_;
};

}  // namespace samestep
