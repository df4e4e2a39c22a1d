// SPDX-License-Identifier: MIT
#include <samestep/error.h>
#include <samestep/space_game.h>

#include <gtest/gtest.h>

#include "lockstep/session_pair.h"

namespace samestep {
namespace {

using Kind = SessionEvent::Kind;

SessionSettings common(std::uint8_t maxPlayers = 0) {
  SessionSettings settings;
  settings.hashInterval = 10;
  settings.maxPlayers = maxPlayers;
  for (Seat seat = 0; seat < kMaxPlayers; ++seat) settings.addresses[seat] = seat;
  return settings;
}

/// One who comes when the others have begun.
struct Newcomer {
  Newcomer(Table& at, SessionSettings settings, Seat seat) : table(at) {
    settings.players = static_cast<std::uint8_t>(at.sessions.size());
    settings.localSeat = seat;
    settings.joins = true;
    session = std::make_unique<Session>(settings, game.functions(), at.post->of(seat));
  }
  /// A frame of everybody.
  Frame frame(std::uint8_t held = 1) {
    table.frame(held);
    return session->frame(table.now, {&held, 1});
  }
  void play(int count) {
    for (int i = 0; i < count; ++i) frame(static_cast<std::uint8_t>(i / 9));
  }
  bool told(Kind kind, SessionEvent& event) {
    while (session->next(event)) {
      if (event.kind == kind) return true;
    }
    return false;
  }
  /// True if it has the state of a player at the newest tick that both are certain of.
  bool agreesWith(Seat seat) const {
    const Session& other = *table.sessions[seat];
    const Tick tick = std::min({session->tick(), session->confirmed(), other.tick(), other.confirmed()});
    return game.sums[tick % game.sums.size()] == table.games[seat].sums[tick % game.sums.size()];
  }

  Table& table;
  AddingGame game;
  std::unique_ptr<Session> session;
};

TEST(JoinTest, WhoComesLatePlaysFromTheSameTickEverywhere) {
  Table table(3, common(5));
  table.play(100);
  Newcomer late(table, common(5), 4);
  late.play(300);

  SessionEvent event;
  ASSERT_TRUE(late.told(Kind::joined, event));
  EXPECT_EQ(event.seat, 4);
  EXPECT_GT(event.tick, 100u);
  EXPECT_EQ(late.session->state(), SessionState::running);
  EXPECT_TRUE(late.agreesWith(0));
  EXPECT_EQ(late.game.present, 4u);
  for (Seat seat = 0; seat < 3; ++seat) {
    SessionEvent other;
    ASSERT_TRUE(table.told(seat, Kind::joined, other));
    EXPECT_EQ(other.tick, event.tick);
    EXPECT_EQ(table.games[seat].present, 4u);
    EXPECT_EQ(table.sessions[seat]->present(), 0b10111);
  }
  EXPECT_TRUE(table.agree());
}

TEST(JoinTest, TheOthersDoNotWaitForWhoComes) {
  Table table(3, common(4));
  table.play(100);
  std::array<std::uint64_t, 3> waited{};
  for (Seat seat = 0; seat < 3; ++seat) waited[seat] = table.sessions[seat]->stats().waited;
  Newcomer late(table, common(4), 3);
  late.play(300);

  ASSERT_EQ(late.session->state(), SessionState::running);
  for (Seat seat = 0; seat < 3; ++seat) EXPECT_EQ(table.sessions[seat]->stats().waited, waited[seat]);
}

TEST(JoinTest, WhatANewcomerDoesReachesAll) {
  Table table(2, common(3));
  table.play(60);
  Newcomer late(table, common(3), 2);
  late.play(200);
  const std::uint8_t command[] = {7, 7};
  ASSERT_TRUE(late.session->command(command));
  late.play(60);

  EXPECT_TRUE(late.agreesWith(0));
  EXPECT_TRUE(late.agreesWith(1));
  EXPECT_TRUE(table.agree());
}

TEST(JoinTest, WhoCrashedComesBackIntoItsSeat) {
  Table table(3, common());
  table.play(100);
  table.sessions[2].reset();
  // A player that is gone is dropped after three seconds; it may begin anew before that.
  table.play(90);
  Newcomer back(table, common(), 2);
  back.play(600);

  SessionEvent event;
  ASSERT_TRUE(table.told(0, Kind::dropped, event));
  EXPECT_EQ(event.seat, 2);
  ASSERT_TRUE(table.told(0, Kind::joined, event));
  EXPECT_EQ(event.seat, 2);
  EXPECT_EQ(table.sessions[0]->present(), 0b111);
  EXPECT_EQ(back.game.present, 3u);
  EXPECT_TRUE(back.agreesWith(0));
  EXPECT_TRUE(back.agreesWith(1));
}

TEST(JoinTest, ASeatIsTakenAgainAndAgain) {
  Table table(3, common());
  table.play(60);
  for (int times = 0; times < 4; ++times) {
    table.sessions[2].reset();
    table.play(300);
    Newcomer back(table, common(), 2);
    back.play(400);
    EXPECT_EQ(table.sessions[0]->present(), 0b111) << times;
    EXPECT_TRUE(back.agreesWith(0)) << times;
    back.session->leave();
    back.play(60);
    EXPECT_EQ(back.session->endReason(), EndReason::left) << times;
  }
  EXPECT_TRUE(table.agree());
}

TEST(JoinTest, AStateThatLiesIsRefusedAndAnotherOneTaken) {
  Table table(3, common(4));
  table.games[0].lies = true;
  table.play(100);
  Newcomer late(table, common(4), 3);
  late.play(400);

  SessionEvent event;
  ASSERT_TRUE(late.told(Kind::lied, event));
  EXPECT_EQ(event.seat, 0);
  ASSERT_TRUE(late.told(Kind::joined, event));
  EXPECT_TRUE(late.agreesWith(1));
  EXPECT_EQ(table.sessions[1]->present(), 0b1111);
}

TEST(JoinTest, WhereEveryStateLiesNobodyIsBelieved) {
  Table table(2, common(3));
  table.games[0].lies = table.games[1].lies = true;
  table.play(100);
  Newcomer late(table, common(3), 2);
  late.play(300);

  EXPECT_EQ(late.session->endReason(), EndReason::notAdmitted);
  EXPECT_EQ(table.sessions[0]->present(), 0b11);
  EXPECT_TRUE(table.agree());
}

TEST(JoinTest, ANewcomerWithAnotherBuildOrForATakenSeatIsRefused) {
  Table table(2, common(4));
  table.play(60);
  SessionSettings other = common(4);
  other.revision = 7;
  Newcomer strange(table, other, 2);
  strange.play(30);
  EXPECT_EQ(strange.session->endReason(), EndReason::refused);
  SessionEvent event;
  ASSERT_TRUE(strange.told(Kind::refused, event));
  EXPECT_EQ(static_cast<Mismatch>(event.detail), Mismatch::revision);

  // A seat with an address of its own is not for others.
  table.sessions[0]->setAddress(3, 9);
  table.sessions[1]->setAddress(3, 9);
  Newcomer thief(table, common(4), 3);
  thief.play(30);
  ASSERT_TRUE(thief.told(Kind::refused, event));
  EXPECT_EQ(static_cast<Mismatch>(event.detail), Mismatch::seat);
  EXPECT_EQ(table.sessions[0]->present(), 0b11);
}

TEST(JoinTest, SeveralNewcomersAreLetInOneAfterAnother) {
  Table table(2, common(5));
  table.play(60);
  Newcomer first(table, common(5), 2);
  Newcomer second(table, common(5), 3);
  Newcomer third(table, common(5), 4);
  for (int i = 0; i < 900; ++i) {
    const std::uint8_t held = static_cast<std::uint8_t>(i / 5);
    table.frame(held);
    for (Newcomer* late : {&first, &second, &third}) late->session->frame(table.now, {&held, 1});
  }

  EXPECT_EQ(table.sessions[0]->present(), 0b11111);
  for (const Newcomer* late : {&first, &second, &third}) EXPECT_TRUE(late->agreesWith(0));
  EXPECT_TRUE(table.agree());
}

TEST(JoinTest, WhoDisappearsWhileItJoinsStopsNobody) {
  Table table(3, common(4));
  table.play(60);
  for (int frames = 5; frames < 120; frames += 10) {
    Newcomer late(table, common(4), 3);
    late.play(frames);
    late.session.reset();
    table.play(300);
  }
  const Tick before = table.common();
  table.play(60);

  EXPECT_GT(table.common(), before + 50);
  EXPECT_TRUE(table.agree());
}

TEST(JoinTest, RefusesMoreSeatsThanThereAreAndAGameThatReadsNoState) {
  AddingGame game;
  Post post;
  SessionSettings settings = common(17);
  EXPECT_THROW(Session(settings, game.functions(), post.of(0)), ValueOutOfRange);
  settings = common(3);
  settings.players = 4;
  EXPECT_THROW(Session(settings, game.functions(), post.of(0)), ValueOutOfRange);
  settings = common(3);
  settings.joins = true;
  Game reads = game.functions();
  reads.read = nullptr;
  EXPECT_THROW(Session(settings, reads, post.of(0)), ValueOutOfRange);
}

/// Calls its session from within its own step.
struct Meddler {
  AddingGame game;
  Session* session = nullptr;
  int refused = 0;

  template <class Call>
  void refuses(Call&& call) {
    try {
      call();
    } catch (const SpaceLocked&) {
      ++refused;
    }
  }
  static void step(const TickInputs&, void* data) {
    auto& self = *static_cast<Meddler*>(data);
    if (self.session == nullptr) return;
    const std::uint8_t held = 0;
    self.refuses([&] { self.session->frame(2'000'000, {&held, 1}); });
    self.refuses([&] { self.session->poll(2'000'000); });
    self.refuses([&] { self.session->command({&held, 1}); });
    self.refuses([&] { self.session->leave(); });
    self.refuses([&] { self.session->pause(true); });
    self.refuses([&] { self.session->setInputDelay(3); });
    self.refuses([&] { self.session->setWindow(3); });
    self.refuses([&] { self.session->setRunAhead(1); });
    self.refuses([&] { self.session->setSaving(Saving::sparse); });
    self.refuses([&] { self.session->setAddress(0, 1); });
    EXPECT_EQ(self.session->window(), 8);
    self.session = nullptr;
  }
};

TEST(SessionGuardTest, ASessionIsNotChangedFromWithinItsOwnGame) {
  Table table(2, common());
  Meddler meddler;
  Game functions = meddler.game.functions();
  functions.data = &meddler;
  functions.save = [](std::uint32_t, void*) {};
  functions.load = functions.save;
  functions.step = Meddler::step;
  functions.hash = [](void*) { return std::uint64_t{0}; };
  functions.write = nullptr;
  functions.read = nullptr;
  SessionSettings settings = common();
  settings.hashInterval = 10;
  table.sessions[1] = std::make_unique<Session>(
      [&] {
        settings.localSeat = 1;
        return settings;
      }(),
      functions, table.post->of(1));
  meddler.session = table.sessions[1].get();
  table.play(20);

  EXPECT_EQ(meddler.refused, 10);
  EXPECT_GT(table.sessions[1]->tick(), 10u);
}

}  // namespace
}  // namespace samestep
