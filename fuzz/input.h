// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <samestep/fixed.h>

namespace samestep::fuzz {

/// Bytes from the fuzzer, read as words of 8 bytes: the first says how the other seven are meant. Every
/// input means something, a missing word is zero, and one word is one number or one decision: so that a
/// changed, moved or copied word is a changed, moved or copied number.
class Input {
 public:
  static constexpr std::size_t kWord = 8;

  Input(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes, size) {}

  /// True if all whole words have been read.
  bool atEnd() const { return bytes_.size() < kWord; }

  /// The next word as it is.
  std::uint64_t word() {
    if (atEnd()) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < kWord; ++i) value |= static_cast<std::uint64_t>(bytes_[i]) << (8 * i);
    bytes_ = bytes_.subspan(kWord);
    return value;
  }

  /// A number of Q32.32: a small integer, a fraction, a few units from a power of two or from a number that
  /// matters to the engine, any 53 bits, or near one read before: the coincidences that random bits never
  /// make. Any such number is a double, too.
  Fixed number();
  /// Number brought into [low, high] by the remainder of a division.
  Fixed numberIn(Fixed low, Fixed high);

 private:
  std::span<const std::uint8_t> bytes_;
  std::int64_t last_ = 0;
  std::int64_t before_ = 0;
};

/// Byte `index` of a word.
constexpr std::uint8_t byteOf(std::uint64_t word, int index) {
  return static_cast<std::uint8_t>(word >> (8 * index));
}

/// A hash of an input, for checks too dear to make on each.
constexpr std::uint64_t mixed(const std::uint8_t* bytes, std::size_t size) {
  std::uint64_t hash = size;
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3u;
  hash = (hash ^ hash >> 32) * 0x9e3779b97f4a7c15u;
  return hash ^ hash >> 32;
}

/// Limit of the numbers that Input makes in size, metres.
inline constexpr int kMaxNumber = 1 << 20;

}  // namespace samestep::fuzz
