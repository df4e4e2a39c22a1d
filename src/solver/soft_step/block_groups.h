// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "parallel/crew.h"
#include "solver/kernels/contact_block.h"

namespace samestep {

/// Blocks that share no body, or such as are solved in order.
struct BlockGroup {
  std::uint32_t begin = 0, end = 0;
  bool inOrder = false;
};

/// Fewer blocks, 96 pairs, are no task of their own.
template <class N>
inline constexpr std::uint32_t kBlockGrain = 96 / N::kLanes;

/// Grain of bodies in a loop of few operations each.
inline constexpr std::uint32_t kBodyGrain = 256;

/// Something that any part of the work may find, whatever it is: no order matters.
class Finding {
 public:
  void note(bool found) {
    if (found) [[unlikely]]
      found_.store(1, std::memory_order_relaxed);
  }
  /// True if anything was found; asked after the work.
  explicit operator bool() const { return found_.load(std::memory_order_relaxed) != 0; }

 private:
  std::atomic<std::uint32_t> found_{0};
};

/// Calls part(begin, end) for ranges of blocks, group after group: within a group at the same time.
template <class N, class Part>
void eachGroup(const std::vector<BlockGroup>& groups, Crew& crew, Part&& part) {
  for (const BlockGroup& group : groups) {
    if (group.inOrder) {
      part(group.begin, group.end);
    } else {
      crew.each(group.end - group.begin, kBlockGrain<N>, [&](std::uint32_t begin, std::uint32_t end) {
        part(group.begin + begin, group.begin + end);
      });
    }
  }
}

/// A kernel's pass over all blocks; true where a number left its range.
template <class N>
bool passOverGroups(ContactPass<N> kernel, ContactBlock<N>* blocks, BlockRest<N>* rests,
                    const std::vector<BlockGroup>& groups, std::vector<SoftBody<N>>& bodies,
                    const SoftConstants<N>& constants, Crew& crew) {
  Finding left;
  eachGroup<N>(groups, crew, [&](std::uint32_t begin, std::uint32_t end) {
    left.note(kernel(blocks + begin, rests + begin, end - begin, bodies.data(), constants) != 0);
  });
  return static_cast<bool>(left);
}

}  // namespace samestep
