// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace samestep {

/// Puts pairs of bodies into groups that share no body, so that the contacts of a group do not wait for each
/// other. A lot decides between the first few groups: where neighbours come in the same order everywhere, the
/// passes sweep a pile to one side. Depends on nothing but the order of the pairs and their bodies.
class ContactGroups {
 public:
  /// The last group takes what fits nowhere and may share bodies.
  static constexpr std::uint32_t kGroups = 64;
  /// Between so many groups a lot decides: enough that few pairs find none of them free, and no more, since
  /// each group is a walk through memory.
  static constexpr std::uint32_t kFew = 12;

  /// Starts anew for bodies numbered below `bodies`.
  void clear(std::uint32_t bodies) {
    used_.assign(bodies, 0);
    places_.clear();
    for (std::uint32_t& size : sizes_) size = 0;
  }
  /// The next pair; a body that nothing moves may be in every group.
  /// @param late  to come after those of its group that are not
  [[gnu::always_inline]] void add(std::uint32_t a, bool aMoves, std::uint32_t b, bool bMoves, bool late) {
    const std::uint64_t taken = (aMoves ? used_[a] : 0) | (bMoves ? used_[b] : 0);
    const std::uint32_t free = freeGroup(taken);
    const std::uint32_t group = free < kGroups ? free : kGroups - 1;
    const std::uint64_t bit = std::uint64_t{1} << group;
    if (aMoves) used_[a] |= bit;
    if (bMoves) used_[b] |= bit;
    const std::uint32_t place = 2 * group + (late && group != kGroups - 1 ? 1 : 0);
    places_.push_back(static_cast<std::uint8_t>(place));
    ++sizes_[place];
  }
  /// The numbers of the pairs, counted as they were added, group after group, in order within each half of a
  /// group.
  void sort(std::vector<std::uint32_t>& order) const {
    std::uint32_t next[2 * kGroups];
    std::uint32_t start = 0;
    for (std::uint32_t place = 0; place < 2 * kGroups; ++place) {
      next[place] = start;
      start += sizes_[place];
    }
    order.resize(places_.size());
    for (std::uint32_t i = 0; i < places_.size(); ++i) order[next[places_[i]]++] = i;
  }
  /// Number of pairs of a group.
  std::uint32_t size(std::uint32_t group) const { return sizes_[2 * group] + sizes_[2 * group + 1]; }

 private:
  /// One of the first groups that has neither body, by lot of the pair's number; the next one after those.
  std::uint32_t freeGroup(std::uint64_t taken) const {
    const std::uint64_t few = ~taken & ((std::uint64_t{1} << kFew) - 1);
    if (few == 0) return static_cast<std::uint32_t>(std::countr_one(taken));
    const std::uint32_t lot = static_cast<std::uint32_t>(places_.size()) * 0x9e3779b1u >> 16;
    const std::uint64_t later = few >> lot % kFew << lot % kFew;
    return static_cast<std::uint32_t>(std::countr_zero(later != 0 ? later : few));
  }

  std::vector<std::uint64_t> used_;
  std::vector<std::uint8_t> places_;
  std::uint32_t sizes_[2 * kGroups] = {};
};

}  // namespace samestep
