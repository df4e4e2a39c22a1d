// SPDX-License-Identifier: MIT
// A match takes no memory once its sessions are made.
#include <atomic>
#include <cstdlib>
#include <new>

#include <samestep/space_game.h>

#include <gtest/gtest.h>

#include "arena/arena.h"
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

/// A peer of a match of the arena.
struct ArenaPeer {
  ArenaPeer(Post& post, Seat seat, Seat players) {
    SessionSettings settings;
    settings.players = players;
    settings.localSeat = seat;
    for (Seat other = 0; other < players; ++other) settings.addresses[other] = other;
    settings.maxHeldBytes = 1;
    game.describe(settings);
    session = std::make_unique<Session>(settings, game.functions(), post.of(seat));
  }

  arena::Arena<Fixed> arena{4, 12};
  SpaceGame<Fixed> game{arena.space(), ratio<Fixed>(1, 60), arena::Arena<Fixed>::applyInputs, &arena};
  std::unique_ptr<Session> session;
};

TEST(SessionAllocationTest, AMatchOfPhysicsTakesNoMemoryOnceItsWorldsHaveGrown) {
  const auto post = std::make_unique<Post>();
  std::vector<std::unique_ptr<ArenaPeer>> peers;
  for (Seat seat = 0; seat < 4; ++seat) peers.push_back(std::make_unique<ArenaPeer>(*post, seat, Seat{4}));
  std::uint64_t now = 0;
  const auto play = [&](int frames) {
    for (int i = 0; i < frames; ++i) {
      now += 16'667;
      post->cut = i % 20 > 14;
      for (Seat seat = 0; seat < 4; ++seat) {
        Session& session = *peers[seat]->session;
        const std::uint8_t held = arena::botButtons(1, seat, session.tick());
        session.frame(now, {&held, 1});
      }
    }
  };
  play(1200);
  const long before = allocations;
  play(600);

  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(peers[0]->session->stats().rollbacks, 50u);
}

}  // namespace
}  // namespace samestep
