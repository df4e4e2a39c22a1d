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
/// Bytes they asked for.
inline std::uint64_t allocatedBytes = 0;
/// Number of further calls that take memory before one fails; none fails below 0.
inline std::int64_t allocationsUntilFailure = -1;

/// Counts a call that asks for so much; null where it is to fail.
inline void* countedMemory(std::size_t size) noexcept {
  ++allocationCount;
  allocatedBytes += size;
  if (allocationsUntilFailure >= 0 && allocationsUntilFailure-- == 0) return nullptr;
  return std::malloc(size == 0 ? 1 : size);
}

}  // namespace samestep

// Inlined, it would have gcc take malloc and operator delete for a mismatched couple.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* memory = samestep::countedMemory(size)) return memory;
  throw std::bad_alloc();
}
// Sorting takes its buffer through this form; without it, the sanitizer's own would answer to `delete` below.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return samestep::countedMemory(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
