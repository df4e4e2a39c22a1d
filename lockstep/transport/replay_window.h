// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace samestep {

/// Numbers of datagrams that were received: the last kSize of them by a bit each, older ones count as
/// received.
class ReplayWindow {
 public:
  static constexpr std::uint64_t kSize = 1024;

  /// The whole number that 16 bits stand for: the one nearest to the highest received.
  std::uint64_t wholeOf(std::uint16_t low) const {
    const auto away = static_cast<std::int16_t>(static_cast<std::uint16_t>(low - next_));
    const std::uint64_t whole = next_ + static_cast<std::uint64_t>(static_cast<std::int64_t>(away));
    // Numbers begin at 0, so that nothing can lie before it.
    return away < 0 && whole > next_ ? whole + 0x10000 : whole;
  }

  bool seen(std::uint64_t number) const {
    if (number >= next_) return false;
    return next_ - number > kSize || (word(number) >> (number % 64) & 1) != 0;
  }

  void mark(std::uint64_t number) {
    for (; next_ <= number; ++next_) {
      if (number - next_ >= kSize) next_ = number - kSize + 1;
      word(next_) &= ~(std::uint64_t{1} << (next_ % 64));
    }
    word(number) |= std::uint64_t{1} << (number % 64);
  }

 private:
  std::uint64_t& word(std::uint64_t number) { return bits_[number / 64 % bits_.size()]; }
  const std::uint64_t& word(std::uint64_t number) const { return bits_[number / 64 % bits_.size()]; }

  std::uint64_t next_ = 0;
  std::array<std::uint64_t, kSize / 64> bits_{};
};

}  // namespace samestep
