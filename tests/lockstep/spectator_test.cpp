// SPDX-License-Identifier: MIT
#include <samestep/spectator.h>

#include <samestep/error.h>
#include <samestep/space_game.h>

#include <cstring>
#include <memory>

#include <gtest/gtest.h>

#include "arena/arena.h"
#include "lockstep/session_pair.h"

namespace samestep {
namespace {

/// Two players, of whom the first is watched by one who has no seat.
struct Watched {
  Watched() { seat(); }

  void seat() {
    spectator = std::make_unique<Spectator>(
        seen.functions(),
        [](Tick, std::span<const std::uint8_t> bytes, void* data) {
          auto& self = *static_cast<Watched*>(data);
          require<Fault::MalformedBytes>(bytes.size() == 2000 && !self.refuses);
          std::memcpy(&self.seen.sum, bytes.data(), 8);
        },
        this, watcherPost.of(1), 0);
  }
  void play(int frames) {
    for (int i = 0; i < frames; ++i) {
      table.frame(static_cast<std::uint8_t>(table.now / 100'000));
      host.update(table.now);
      watcherPost.cut = lossy && i % 3 == 0;
      if (!away) spectator->frame(table.now);
      watcherPost.cut = false;
    }
  }
  /// True if the spectator has what the players had at its tick.
  bool same() const {
    return spectator->tick() > 0 &&
           seen.sum == table.games[0].sums[spectator->tick() % table.games[0].sums.size()];
  }

  Table table{2};
  Post watcherPost;
  AddingGame seen;
  bool refuses = false;
  bool lossy = false;
  bool away = false;
  SpectatorHost host{*table.sessions[0], watcherPost.of(0),
                     [](Tick& tick, std::vector<std::uint8_t>& bytes, void* data) {
                       auto& self = *static_cast<Watched*>(data);
                       const Session& session = *self.table.sessions[0];
                       tick = std::min(session.tick(), session.confirmed());
                       // The state has more than one block.
                       bytes.assign(2000, 0);
                       std::memcpy(bytes.data(), &self.table.games[0].sums[tick % 4096], 8);
                       return tick > 0;
                     },
                     this};
  std::unique_ptr<Spectator> spectator;
};

TEST(SpectatorTest, WhoComesLateSeesWhatThePlayersSee) {
  Watched watched;
  watched.away = true;
  watched.play(300);
  watched.away = false;
  watched.play(60);

  EXPECT_EQ(watched.spectator->state(), Spectator::State::watching);
  EXPECT_GT(watched.spectator->tick(), 340u);
  EXPECT_TRUE(watched.same());
  EXPECT_EQ(watched.host.watching(), 1u);
}

TEST(SpectatorTest, LossDelaysAndChangesNothing) {
  Watched watched;
  watched.lossy = true;
  watched.play(400);

  EXPECT_GT(watched.spectator->tick(), 370u);
  EXPECT_TRUE(watched.same());
}

TEST(SpectatorTest, WhoWasAwayForLongerThanTheHostRemembersBeginsAnew) {
  Watched watched;
  watched.play(60);
  watched.away = true;
  watched.play(1500);
  watched.away = false;
  watched.play(60);

  EXPECT_GT(watched.spectator->tick(), 1580u);
  EXPECT_TRUE(watched.same());
}

TEST(SpectatorTest, WhoJoinsAgainIsServedAgain) {
  Watched watched;
  watched.play(100);
  watched.seat();
  watched.play(60);

  EXPECT_GT(watched.spectator->tick(), 140u);
  EXPECT_TRUE(watched.same());
}

TEST(SpectatorTest, AStateThatCannotBeLoadedEndsTheWatching) {
  Watched watched;
  watched.refuses = true;
  watched.play(60);

  EXPECT_EQ(watched.spectator->state(), Spectator::State::failed);
  EXPECT_GT(watched.table.sessions[0]->tick(), 50u);
}

TEST(SpectatorTest, WhatIsNoQuestionIsCountedAndNotAnswered) {
  Watched watched;
  watched.play(60);
  watched.away = true;
  for (std::uint8_t length = 1; length < 20; ++length) {
    watched.watcherPost.put(1, 0, std::vector<std::uint8_t>(length, 0x62));
  }
  watched.play(1);

  EXPECT_EQ(watched.host.refused(), 19u);
}

TEST(SpectatorTest, AWorldIsWatchedFromAnyTickOn) {
  Post post;
  Post watcherPost;
  struct Player {
    arena::Arena<Fixed> arena{2, 4};
    SpaceGame<Fixed> game{arena.space(), ratio<Fixed>(1, 60), arena::Arena<Fixed>::applyInputs, &arena};
    std::unique_ptr<Session> session;
  };
  std::array<Player, 2> players;
  Player watcher;
  for (Seat seat = 0; seat < 2; ++seat) {
    SessionSettings settings;
    settings.localSeat = seat;
    settings.addresses[1] = 1;
    players[seat].game.describe(settings);
    players[seat].session =
        std::make_unique<Session>(settings, players[seat].game.functions(), post.of(seat));
  }
  SpectatorHost host(
      *players[0].session, watcherPost.of(0),
      [](Tick& tick, std::vector<std::uint8_t>& bytes, void* data) {
        const auto& player = *static_cast<Player*>(data);
        return player.game.snapshot(*player.session, tick, bytes);
      },
      &players[0]);
  Spectator spectator(
      watcher.game.functions(),
      [](Tick, std::span<const std::uint8_t> bytes, void* data) {
        static_cast<Player*>(data)->game.load(bytes);
      },
      &watcher, watcherPost.of(1), 0);

  std::uint64_t now = 1'000'000;
  for (int frame = 0; frame < 400; ++frame) {
    now += 16'667;
    for (Seat seat = 0; seat < 2; ++seat) {
      // At the end all rest, so that nothing is guessed wrongly.
      const std::uint8_t held =
          frame < 380 ? arena::botButtons(3, seat, static_cast<Tick>(frame)) : std::uint8_t{0};
      players[seat].session->frame(now, {&held, 1});
    }
    host.update(now);
    if (frame > 200) spectator.frame(now);
  }
  while (spectator.tick() < players[0].session->tick() && spectator.frame(now += 20'000) > 0) {
  }

  ASSERT_EQ(spectator.state(), Spectator::State::watching);
  EXPECT_GT(spectator.tick(), 380u);
  while (watcher.arena.space().stamp() < players[0].arena.space().stamp()) {
    // The last steps are certain, too, but were not sent yet.
    const std::uint8_t held = 0;
    const PlayerInput rest{true, {&held, 1}, {}};
    const std::array<PlayerInput, 2> both{rest, rest};
    const Game game = watcher.game.functions();
    game.step({spectator.tick(), both}, game.data);
  }
  EXPECT_EQ(watcher.arena.space().hash(), players[0].arena.space().hash());
}

}  // namespace
}  // namespace samestep
