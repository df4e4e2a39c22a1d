// SPDX-License-Identifier: MIT
#include <samestep/slot_map.h>

namespace samestep {

void FreeSlots::reset(std::uint32_t slots) {
  words_.assign(wordsFor(slots), 0);
  summary_.assign(wordsFor(wordsFor(slots)), 0);
}

void FreeSlots::reserve(std::uint32_t slots) {
  makeRoom(words_, wordsFor(slots));
  makeRoom(summary_, wordsFor(wordsFor(slots)));
}

void FreeSlots::grow(std::uint32_t slots) {
  words_.resize(wordsFor(slots), 0);
  summary_.resize(wordsFor(wordsFor(slots)), 0);
}

}  // namespace samestep
