// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

// Replaces operator new and delete of the whole program: for one source of a test program only.

namespace samestep {

/// Calls of operator new since the program began.
inline std::uint64_t allocationCount = 0;
/// What they asked for, bytes.
inline std::uint64_t allocatedBytes = 0;

}  // namespace samestep

// Not inlined, or gcc takes malloc and operator delete for a mismatched couple.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++samestep::allocationCount;
  samestep::allocatedBytes += size;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
// Sorting takes its buffer through this form; without it, the sanitizer's own would answer to `delete` below.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++samestep::allocationCount;
  samestep::allocatedBytes += size;
  return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
