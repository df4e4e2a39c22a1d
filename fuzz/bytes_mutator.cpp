// SPDX-License-Identifier: MIT
// The mutator of targets that read binary formats: beside libFuzzer's changes, ones of whole little-endian
// fields of 1, 4 and 8 bytes, as the formats are made of.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "dice.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                               unsigned int seed);

namespace samestep::fuzz {
namespace {

std::uint64_t load(const std::uint8_t* at, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < width; ++i) value |= static_cast<std::uint64_t>(at[i]) << (8 * i);
  return value;
}
void store(std::uint8_t* at, std::size_t width, std::uint64_t value) {
  for (std::size_t i = 0; i < width; ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint64_t changedField(std::uint64_t value, Dice& dice) {
  switch (dice.below(8)) {
    case 0:
      return value + 1;
    case 1:
      return value - 1;
    case 2:
      return 0 - value;
    case 3:
      return value ^ std::uint64_t{1} << dice.below(64);
    case 4:
      return std::uint64_t{1} << dice.below(64);
    case 5:
      return (std::uint64_t{1} << dice.below(64)) - 1;
    case 6:
      return dice.below(8);
    default:
      return value + (dice.below(2) == 0 ? std::uint64_t{1} << 32 : 0 - (std::uint64_t{1} << 32));
  }
}

void changeField(std::uint8_t* data, std::size_t size, Dice& dice) {
  constexpr std::size_t kWidths[] = {1, 4, 8, 8};
  const std::size_t width = kWidths[dice.below(4)];
  if (size < width) return;
  const std::size_t at = dice.below(size - width + 1);
  // The word comes from elsewhere, or is its own value changed.
  const std::size_t from = dice.below(4) == 0 ? dice.below(size - width + 1) : at;
  const std::uint64_t value = load(data + from, width);
  store(data + at, width, from == at ? changedField(value, dice) : value);
}

}  // namespace
}  // namespace samestep::fuzz

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                    unsigned int seed) {
  samestep::fuzz::Dice dice(seed);
  if (size == 0 || dice.below(3) == 0) return LLVMFuzzerMutate(data, size, maxSize);
  for (std::size_t left = 1 + dice.below(3); left > 0; --left) samestep::fuzz::changeField(data, size, dice);
  return size;
}
