// SPDX-License-Identifier: MIT
// A match takes no memory once its sessions are made.
#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "lockstep/session_pair.h"

namespace {
std::atomic<long> allocations = 0;

void* counted(std::size_t size) {
  ++allocations;
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace samestep {
namespace {

TEST(SessionAllocationTest, AMatchWithRollbacksCommandsAndALeaverTakesNoMemory) {
  Table table(4);
  const std::uint8_t command[] = {1, 2, 3, 4, 5};
  const long before = allocations;

  for (int i = 0; i < 1200; ++i) {
    table.post->cut = i % 50 > 40;
    if (i % 11 == 0) table.sessions[1]->command(command);
    if (i == 600) table.sessions[3]->leave();
    table.frame(static_cast<std::uint8_t>(i / 3));
  }

  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(table.sessions[0]->stats().rollbacks, 20u);
  EXPECT_EQ(table.sessions[3]->endReason(), EndReason::left);
}

}  // namespace
}  // namespace samestep
