// SPDX-License-Identifier: MIT
// The mutator of all targets that read their input as words; see input.h.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "dice.h"
#include "input.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                               unsigned int seed);
extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* first, std::size_t firstSize,
                                                 const std::uint8_t* second, std::size_t secondSize,
                                                 std::uint8_t* out, std::size_t maxOutSize,
                                                 unsigned int seed);

namespace samestep::fuzz {
namespace {

constexpr std::size_t kWord = Input::kWord;

std::uint64_t load(const std::uint8_t* at) {
  std::uint64_t value = 0;
  std::memcpy(&value, at, kWord);
  return value;
}
void store(std::uint8_t* at, std::uint64_t value) { std::memcpy(at, &value, kWord); }

/// A word of a random kind; mostly of few bits, as small numbers mean more.
std::uint64_t freshWord(Dice& dice) {
  std::uint64_t payload = dice.next() >> 8;
  if (dice.below(2) == 0) payload &= 0xffff;
  return payload << 8 | dice.below(256);
}

/// One number changed a little or altogether.
std::uint64_t changedWord(std::uint64_t word, Dice& dice) {
  const std::uint64_t kind = word & 0xff, payload = word >> 8;
  switch (dice.below(8)) {
    case 0:
      return (payload + 1) << 8 | kind;
    case 1:
      return (payload - 1) << 8 | kind;
    case 2:
      return (0 - payload) << 8 | kind;
    case 3:
      return payload << 8 | dice.below(256);
    case 4:
      return word ^ std::uint64_t{1} << dice.below(64);
    case 5: {
      const std::size_t shift = 8 * dice.below(8);
      return (word & ~(std::uint64_t{0xff} << shift)) | static_cast<std::uint64_t>(dice.below(256)) << shift;
    }
    case 6:
      return (payload + dice.below(512) - 256) << 8 | kind;
    default:
      return freshWord(dice);
  }
}

/// One change; the size is a multiple of a word and stays so.
std::size_t mutateOnce(std::uint8_t* data, std::size_t size, std::size_t maxSize, Dice& dice) {
  const std::size_t words = size / kWord, room = maxSize / kWord;
  if (words == 0) {
    if (room == 0) return 0;
    store(data, freshWord(dice));
    return kWord;
  }
  const std::size_t at = dice.below(words);
  std::uint8_t* const word = data + at * kWord;
  switch (dice.below(12)) {
    case 0: {  // insert
      if (words == room) break;
      std::memmove(word + kWord, word, size - at * kWord);
      store(word, freshWord(dice));
      return size + kWord;
    }
    case 1: {  // erase some
      const std::size_t count = 1 + dice.below(std::min<std::size_t>(words - at, 8));
      std::memmove(word, word + count * kWord, size - (at + count) * kWord);
      return size - count * kWord;
    }
    case 2: {  // double a stretch in place
      const std::size_t count = std::min(1 + dice.below(8), std::min(words - at, room - words));
      if (count == 0) break;
      std::memmove(word + count * kWord, word, size - at * kWord);
      return size + count * kWord;
    }
    case 3: {  // copy a stretch over another
      const std::size_t to = dice.below(words);
      const std::size_t count = std::min(1 + dice.below(8), words - std::max(at, to));
      std::memmove(data + to * kWord, word, count * kWord);
      return size;
    }
    case 4: {  // exchange two
      const std::size_t to = dice.below(words);
      const std::uint64_t kept = load(word);
      store(word, load(data + to * kWord));
      store(data + to * kWord, kept);
      return size;
    }
    default:
      break;
  }
  store(word, changedWord(load(word), dice));
  return size;
}

}  // namespace
}  // namespace samestep::fuzz

using samestep::fuzz::Dice;
using samestep::fuzz::kWord;

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                    unsigned int seed) {
  Dice dice(seed);
  // libFuzzer's own changes know the constants that the code compares with.
  if (dice.below(8) == 0) return LLVMFuzzerMutate(data, size, maxSize);
  size -= size % kWord;
  for (std::size_t left = 1 + dice.below(4); left > 0; --left) {
    size = samestep::fuzz::mutateOnce(data, size, maxSize, dice);
  }
  return size;
}

std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* first, std::size_t firstSize,
                                      const std::uint8_t* second, std::size_t secondSize, std::uint8_t* out,
                                      std::size_t maxOutSize, unsigned int seed) {
  Dice dice(seed);
  const std::size_t ofFirst = kWord * dice.below(firstSize / kWord + 1);
  const std::size_t from = kWord * dice.below(secondSize / kWord + 1);
  const std::size_t ofSecond = kWord * dice.below((secondSize - from) / kWord + 1);
  const std::size_t headSize = std::min(ofFirst, maxOutSize - maxOutSize % kWord);
  const std::size_t middleSize = std::min(ofSecond, maxOutSize - headSize);
  std::memcpy(out, first, headSize);
  std::memcpy(out + headSize, second + from, middleSize);
  const std::size_t size = headSize + middleSize;
  const std::size_t tailSize = std::min(firstSize - ofFirst, maxOutSize - size);
  std::memcpy(out + size, first + ofFirst, tailSize);
  return size + tailSize;
}
