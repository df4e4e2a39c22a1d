// SPDX-License-Identifier: MIT
#include <samestep/error.h>
#include <samestep/session.h>

#include <algorithm>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "lockstep/session_pair.h"

namespace samestep {
namespace {

using Kind = SessionEvent::Kind;

SessionSettings lockstep(std::uint8_t delay) {
  SessionSettings settings;
  settings.window = 0;
  settings.inputDelay = delay;
  return settings;
}

TEST(SessionTest, StartsWhenAllHaveHeardEachOther) {
  Table table(3);
  EXPECT_EQ(table.sessions[0]->state(), SessionState::connecting);

  table.play(4);

  for (Seat seat = 0; seat < 3; ++seat) {
    EXPECT_EQ(table.sessions[seat]->state(), SessionState::running);
    EXPECT_TRUE(table.told(seat, Kind::started));
  }
}

TEST(SessionTest, PureLockstepNeedsTheWayThereOnlyAndSavesNothing) {
  // Datagrams sent in one frame are there in the next.
  Table table(2, lockstep(1));
  table.play(100);

  EXPECT_GE(table.sessions[0]->tick(), 95u);
  EXPECT_EQ(table.sessions[0]->stats().saves, 0u);
  EXPECT_EQ(table.sessions[0]->stats().rollbacks, 0u);
  EXPECT_LE(table.sessions[0]->tick(), table.sessions[0]->confirmed());
}

TEST(SessionTest, ASilentPeerStopsTheOthersAtTheWindow) {
  SessionSettings settings;
  settings.window = 5;
  Table table(2, settings);
  table.play(50);
  table.post->cut = true;

  table.play(20);

  for (const auto& session : table.sessions) EXPECT_EQ(session->tick() - session->confirmed(), 5u);
  EXPECT_EQ(table.frames[0], Frame::waiting);
}

TEST(SessionTest, AfterACutAllHaveTheSameState) {
  Table table(3);
  table.play(50);
  table.post->cut = true;
  table.play(20);
  table.post->cut = false;

  table.play(30);
  for (int i = 0; i < 20; ++i) table.frame(9);

  EXPECT_GT(table.sessions[0]->stats().rollbacks, 0u);
  EXPECT_GT(table.common(), 90u);
  EXPECT_TRUE(table.agree());
}

TEST(SessionTest, RunAheadShowsWhatComesAndChangesNothing) {
  SessionSettings ahead;
  ahead.runAhead = 2;
  Table plain(2), shown(2, ahead);
  for (Table* table : {&plain, &shown}) {
    table->play(60);
    for (const auto& session : table->sessions) session->setRunAhead(0);
    table->play(1);
  }

  EXPECT_EQ(plain.games[0].sum, shown.games[0].sum);
  EXPECT_GT(shown.sessions[0]->stats().steps, plain.sessions[0]->stats().steps + 100);
}

TEST(SessionTest, SparseSavingGivesTheSameStatesWithFewerSaves) {
  SessionSettings sparse;
  sparse.saving = Saving::sparse;
  Table each(2), few(2, sparse);
  for (Table* table : {&each, &few}) {
    for (int i = 0; i < 200; ++i) {
      table->post->cut = i % 40 > 33;
      table->frame(static_cast<std::uint8_t>(i / 5));
    }
    for (int i = 0; i < 20; ++i) table->frame(1);
    EXPECT_GT(table->common(), 180u);
    EXPECT_TRUE(table->agree());
  }

  EXPECT_LT(few.sessions[0]->stats().saves, each.sessions[0]->stats().saves);
}

TEST(SessionTest, ModesAndDelaysChangeWithinAMatch) {
  Table table(2, lockstep(2));
  table.play(40);
  table.sessions[0]->setWindow(8);
  table.sessions[0]->setInputDelay(0);
  table.play(40);
  table.sessions[1]->setWindow(4);
  table.sessions[0]->setInputDelay(9);
  table.play(40);
  table.sessions[0]->setWindow(0);
  table.play(40);
  for (const auto& session : table.sessions) session->setInputDelay(2);
  for (int i = 0; i < 30; ++i) table.frame(1);

  EXPECT_GE(std::min(table.sessions[0]->tick(), table.sessions[1]->tick()), 150u);
  EXPECT_FALSE(table.told(0, Kind::desync));
  EXPECT_FALSE(table.told(1, Kind::desync));
}

TEST(SessionTest, AQueueOfCommandsIsBoundedAndSaysSo) {
  Table table(2);
  const std::uint8_t command[] = {1, 2, 3};
  int taken = 0;
  while (taken < 1000 && table.sessions[0]->command(command)) ++taken;

  EXPECT_EQ(taken, 32);
  table.play(60);
  EXPECT_TRUE(table.sessions[0]->command(command));
}

// A transport that seals adds its own bytes, up to kMaxDatagram.
TEST(SessionTest, NoPacketIsLongerThanATransportHasRoomFor) {
  SessionSettings wide;
  wide.maxHeldBytes = 64;
  wide.maxCommandBytes = 128;
  wide.inputDelay = 16;
  Table table(2, wide);
  std::array<std::uint8_t, 64> held{};
  const std::array<std::uint8_t, 128> command{};
  for (int i = 0; i < 60; ++i) {
    table.now += 16'667;
    held[0] = static_cast<std::uint8_t>(i);
    for (const auto& session : table.sessions) {
      session->command(command);
      session->frame(table.now, held);
    }
    // Then nothing arrives, and inputs pile up.
    table.post->cut = i > 20;
  }

  EXPECT_GT(table.post->longest, 900u);
  EXPECT_LE(table.post->longest, kMaxPacket);
}

TEST(SessionTest, WhoLeavesIsAbsentFromTheSameTickEverywhere) {
  Table table(3);
  table.play(50);

  table.sessions[2]->leave();
  table.play(60);

  EXPECT_EQ(table.sessions[2]->state(), SessionState::ended);
  EXPECT_EQ(table.sessions[2]->endReason(), EndReason::left);
  SessionEvent first, second;
  ASSERT_TRUE(table.told(0, Kind::left, first));
  ASSERT_TRUE(table.told(1, Kind::left, second));
  EXPECT_EQ(first.tick, second.tick);
  EXPECT_EQ(table.games[0].present, 2u);
  EXPECT_EQ(table.sessions[0]->present(), 0b011);
  EXPECT_EQ(table.frames[0], Frame::advanced);
}

TEST(SessionTest, OfTwoTheOtherPlaysOnWhenOneLeaves) {
  for (Seat leaver = 0; leaver < 2; ++leaver) {
    Table table(2);
    table.play(50);
    table.sessions[leaver]->leave();
    table.play(2000);

    EXPECT_EQ(table.sessions[leaver]->endReason(), EndReason::left);
    EXPECT_EQ(table.sessions[1 - leaver]->state(), SessionState::running);
    EXPECT_GT(table.sessions[1 - leaver]->tick(), 2000u);
  }
}

TEST(SessionTest, APauseHoldsAllAndDropsNobody) {
  Table table(2);
  table.play(30);
  table.sessions[1]->pause(true);
  table.play(600);
  const Tick tick = table.sessions[0]->tick();
  EXPECT_LT(tick, 50u);
  EXPECT_TRUE(table.told(0, Kind::paused));

  table.sessions[1]->pause(false);
  table.play(60);

  EXPECT_TRUE(table.told(0, Kind::unpaused));
  EXPECT_GT(table.sessions[0]->tick(), tick + 50);
}

/// A commit as a peer would send it: `number` decided, `voters` go on, seat 2 is dropped with its input 20.
std::vector<std::uint8_t> commitOf(Seat from, std::uint8_t number, std::uint8_t voters) {
  const auto first = static_cast<std::uint8_t>(7 | from << 4);
  const auto view = static_cast<std::uint8_t>(number - 1);
  return {first, 0, view, number, 0, 0, 0, voters, 0, 4, 0, 20, 0, 0, 0, 0, 0};
}

TEST(SessionTest, ACommitThatOnePeerForgesIsRefused) {
  Table table(4);
  table.play(30);
  table.post->put(1, 0, commitOf(1, 1, 0b1011));
  table.post->put(1, 2, commitOf(1, 1, 0b1011));
  // One that names somebody who does not play.
  table.post->put(1, 3, commitOf(1, 1, 0b11011));
  table.play(60);

  EXPECT_EQ(table.sessions[0]->present(), 0b1111);
  EXPECT_EQ(table.sessions[2]->state(), SessionState::running);
  EXPECT_GT(table.sessions[3]->tick(), 80u);
  EXPECT_EQ(table.sessions[0]->stats().badPackets, 1u);
  EXPECT_EQ(table.sessions[3]->stats().badPackets, 1u);
}

// Negative control: the same bytes are a commit.
TEST(SessionTest, ACommitThatMostTellIsBelieved) {
  Table table(4);
  table.play(30);
  for (const Seat from : {Seat{0}, Seat{1}, Seat{3}}) table.post->put(from, 2, commitOf(from, 1, 0b1011));
  table.play(2);

  EXPECT_EQ(table.sessions[2]->endReason(), EndReason::dropped);
}

TEST(SessionTest, WhoIsHeardIsNotDroppedBecauseOneAsks) {
  Table table(4);
  table.play(30);
  for (Seat to : {Seat{0}, Seat{3}}) {
    // Seat 1 asks to drop seat 2, and then says that all agreed.
    table.post->put(1, to, std::vector<std::uint8_t>{3 | 16, 0, 0, 17, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0});
    table.post->put(1, to,
                    std::vector<std::uint8_t>{5 | 16, 0, 0, 17, 0, 0, 0, 0b1011, 0, 4, 0, 20, 0, 0, 0, 0, 0});
    table.post->put(1, to, commitOf(1, 1, 0b1011));
  }
  table.play(300);

  for (Seat seat = 0; seat < 4; ++seat) EXPECT_EQ(table.sessions[seat]->present(), 0b1111);
  EXPECT_GT(table.sessions[0]->tick(), 300u);
  EXPECT_TRUE(table.agree());
}

/// The peer goes on talking but makes no inputs.
TEST(SessionTest, APeerThatMakesNoInputsIsDropped) {
  Table table(3);
  table.play(30);
  for (int i = 0; i < 400; ++i) {
    table.now += 16'667;
    const std::uint8_t held = 1;
    table.sessions[0]->frame(table.now, {&held, 1});
    table.sessions[1]->frame(table.now, {&held, 1});
    table.sessions[2]->poll(table.now);
  }

  EXPECT_EQ(table.sessions[0]->present(), 0b011);
  EXPECT_EQ(table.sessions[1]->present(), 0b011);
  EXPECT_EQ(table.sessions[2]->endReason(), EndReason::dropped);
  EXPECT_GT(table.sessions[0]->tick(), 200u);
}

TEST(SessionTest, APauseThatNeverEndsIsNoReasonToWaitForEver) {
  SessionSettings settings;
  settings.pausedAtMost = 5'000'000;
  Table table(3, settings);
  table.play(30);
  table.sessions[2]->pause(true);
  table.play(240);
  EXPECT_EQ(table.sessions[0]->present(), 0b111);
  table.play(600);

  EXPECT_EQ(table.sessions[0]->present(), 0b011);
  EXPECT_GT(table.sessions[0]->tick(), 100u);
}

template <class Change>
Mismatch refusal(Change&& change) {
  std::vector<SessionSettings> settings(2);
  change(settings[1]);
  Table table(settings);
  table.play(5);
  SessionEvent event;
  EXPECT_EQ(table.sessions[0]->endReason(), EndReason::refused);
  EXPECT_EQ(table.sessions[1]->endReason(), EndReason::refused);
  EXPECT_TRUE(table.told(0, Kind::refused, event));
  return static_cast<Mismatch>(event.detail);
}

TEST(SessionTest, APeerWithAnotherBuildIsRefusedWithTheReason) {
  EXPECT_EQ(refusal([](SessionSettings& other) { other.revision = 7; }), Mismatch::revision);
  EXPECT_EQ(refusal([](SessionSettings& other) { other.fingerprint = 7; }), Mismatch::fingerprint);
  EXPECT_EQ(refusal([](SessionSettings& other) { other.content = 7; }), Mismatch::content);
  EXPECT_EQ(refusal([](SessionSettings& other) { other.maxHeldBytes = 7; }), Mismatch::settings);
  EXPECT_EQ(refusal([](SessionSettings& other) { other.match = 1u << 16; }), Mismatch::protocol);
}

TEST(SessionTest, AMinorityEndsAndSaysWhy) {
  Table table(3);
  table.play(30);
  // The third hears nobody any more.
  for (int i = 0; i < 1500 && table.sessions[2]->state() == SessionState::running; ++i) {
    table.now += 16'667;
    const std::uint8_t held = 1;
    table.sessions[2]->frame(table.now, {&held, 1});
  }

  EXPECT_EQ(table.sessions[2]->endReason(), EndReason::minority);
  EXPECT_TRUE(table.told(2, Kind::interrupted));
}

template <class Change>
std::string refusedSettings(Change&& change) {
  AddingGame game;
  Post post;
  SessionSettings settings;
  Game functions = game.functions();
  change(settings, functions);
  try {
    const Session session(settings, functions, post.of(0));
  } catch (const ValueOutOfRange& error) {
    return error.what();
  }
  return "";
}

TEST(SessionTest, RefusesSettingsOutsideTheirRangesByName) {
  EXPECT_EQ(refusedSettings([](auto& s, auto&) { s.players = 17; }), "A session has 2 to 16 players.");
  EXPECT_EQ(refusedSettings([](auto& s, auto&) { s.localSeat = 2; }),
            "The local seat is not one of the session's.");
  EXPECT_EQ(refusedSettings([](auto& s, auto&) { s.window = 17; }), "The window is longer than 16 ticks.");
  EXPECT_EQ(refusedSettings([](auto& s, auto&) { s.maxHeldBytes = 65; }),
            "maxHeldBytes is not within 1 to 64.");
  EXPECT_EQ(refusedSettings([](auto&, auto& g) { g.hash = nullptr; }),
            "A game lacks one of its four functions.");
  EXPECT_EQ(refusedSettings([](auto&, auto&) {}), "");
}

// The session lives on, within its memory, whatever a peer says.
TEST(SessionTest, MalformedDatagramsAreCountedAndDropped) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 60; ++round) {
    Table table(3);
    table.play(20);
    for (int i = 0; i < 200; ++i) {
      table.frame(static_cast<std::uint8_t>(i / 9));
      std::array<std::uint8_t, 80> bytes;
      for (std::uint8_t& byte : bytes) {
        byte = static_cast<std::uint8_t>(random() % (random() % 3 == 0 ? 256 : 4));
      }
      bytes[0] = static_cast<std::uint8_t>(random() % 13 | 16);
      bytes[1] = bytes[2] = 0;
      table.post->put(1, 0, {bytes.data(), random() % bytes.size()});
    }
    EXPECT_GT(table.sessions[0]->stats().badPackets, 20u);
    const Tick tick = table.sessions[0]->tick();
    EXPECT_LE(tick - std::min(tick, table.sessions[0]->confirmed()), 16u);
  }
}

TEST(SessionTest, APeerThatNeverSaysWhatCameIsToldNoInputsThatAreForgotten) {
  Table table(2);
  table.play(10);
  const Tick first = table.sessions[1]->tick();
  for (Tick i = 0; i < 400; ++i) {
    table.now += 16'667;
    // Eight inputs that hold what the one before held; of ours none came.
    const auto base = static_cast<std::uint16_t>(first + i);
    const auto low = static_cast<std::uint8_t>(base), high = static_cast<std::uint8_t>(base >> 8);
    const std::uint8_t packet[] = {2 | 16, 0, 0, low, high, 0, 0, 0, 64, 8 << 2};
    table.post->put(1, 0, packet);
    const std::uint8_t held = 1;
    table.sessions[0]->frame(table.now, {&held, 1});
  }

  EXPECT_GT(table.sessions[0]->tick(), 390u);
  EXPECT_EQ(table.sessions[0]->stats().badPackets, 0u);
}

TEST(SessionTest, AStrangersBytesChangeNothing) {
  Table table(2), calm(2);
  std::mt19937_64 random(1);
  for (int i = 0; i < 300; ++i) {
    std::array<std::uint8_t, 60> bytes;
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    bytes[0] = static_cast<std::uint8_t>((bytes[0] & 15) | 16);
    bytes[1] = bytes[2] = 0;
    table.post->put(7, 0, bytes);
    table.frame(static_cast<std::uint8_t>(i / 9));
    calm.frame(static_cast<std::uint8_t>(i / 9));
  }

  EXPECT_EQ(table.sessions[0]->stats().badPackets, 300u);
  EXPECT_EQ(table.games[0].sum, calm.games[0].sum);
}

}  // namespace
}  // namespace samestep
