// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <type_traits>

#include "base/budget.h"

namespace samestep {

/// The room for the blocks of a step, shared by the solvers of a scalar: one of them works at a time, and
/// each fills its blocks anew in every step. A solver that gives up so leaves its room to the next one.
class BlockMemory {
 public:
  BlockMemory() = default;
  BlockMemory(const BlockMemory&) = delete;
  BlockMemory& operator=(const BlockMemory&) = delete;

  /// Makes room for so many bytes, and where it grows for an eighth more than it had. What it held is lost.
  /// @param budget  asked as it is cleared, which for a large step takes a while
  /// @throws Interrupted
  void reserve(std::size_t bytes, Budget& budget) {
    if (bytes <= capacity_) return;
    const std::size_t grown = capacity_ + capacity_ / 8;
    const std::size_t capacity = bytes > grown ? bytes : grown;
    // The old room goes first: at its worst this is most of what a step takes.
    capacity_ = 0;
    room_.reset();
    room_.reset(new std::byte[capacity + kAlignment]);
    for (std::size_t begin = 0; begin < capacity + kAlignment; begin += kClearedAtOnce) {
      const std::size_t left = capacity + kAlignment - begin;
      std::memset(room_.get() + begin, 0, left < kClearedAtOnce ? left : kClearedAtOnce);
      budget.pay(0);
    }
    capacity_ = capacity;
  }
  /// The records of a plain type that begin at a multiple of kAlignment.
  template <class T>
  T* at(std::size_t offset) {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kAlignment);
    // not in results: only where the room begins
    const auto start = reinterpret_cast<std::uintptr_t>(room_.get());
    const std::size_t skipped = (kAlignment - start % kAlignment) % kAlignment;
    return reinterpret_cast<T*>(room_.get() + skipped + offset);
  }
  std::size_t capacity() const { return capacity_; }

  static constexpr std::size_t kAlignment = 64;

 private:
  static constexpr std::size_t kClearedAtOnce = std::size_t{1} << 24;

  std::unique_ptr<std::byte[]> room_;
  std::size_t capacity_ = 0;
};

}  // namespace samestep
