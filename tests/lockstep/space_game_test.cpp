// SPDX-License-Identifier: MIT
#include <samestep/space_game.h>

#include <samestep/circle_shape.h>
#include <samestep/error.h>
#include <samestep/sync_test.h>
#include <samestep/verify.h>
#include <samestep/version.h>

#include <array>
#include <cstring>

#include <gtest/gtest.h>

#include "lockstep/session_pair.h"

namespace samestep {
namespace {

/// Two discs that players push, and a score beside the Space.
struct Scored {
  explicit Scored(int mass = 1) {
    for (int i = 0; i < 2; ++i) {
      Body<Fixed> body(Fixed(mass), Fixed(1));
      body.setPosition({Fixed(3 * i), Fixed(0)});
      // A replay applies the inputs to a Space of its own.
      bodies[static_cast<std::size_t>(i)] = space.add(body).anywhere();
      space.add(circleShape<Fixed>(bodies[static_cast<std::size_t>(i)], Fixed(1)));
    }
  }
  OwnState own() {
    OwnState own;
    own.data = this;
    own.save = [](std::uint32_t slot, void* data) { self(data).saved[slot] = self(data).score; };
    own.load = [](std::uint32_t slot, void* data) { self(data).score = self(data).saved[slot]; };
    own.hash = [](void* data) { return self(data).score; };
    own.write = [](std::uint32_t slot, std::span<std::uint8_t> into, void* data) {
      if (into.size() >= 8) std::memcpy(into.data(), &self(data).saved[slot], 8);
      return std::uint64_t{8};
    };
    own.read = [](std::span<const std::uint8_t> bytes, void* data) {
      if (bytes.size() != 8) return false;
      std::memcpy(&self(data).score, bytes.data(), 8);
      return true;
    };
    own.name = [](std::uint64_t, std::span<char> into, void*) { std::memcpy(into.data(), "score", 6); };
    return own;
  }
  static Scored& self(void* data) { return *static_cast<Scored*>(data); }
  static void apply(Space<Fixed>& world, const TickInputs& inputs, void* data) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (inputs.players[i].held.empty()) continue;
      auto& body = world.body(self(data).bodies[i]);
      body.applyForce({Fixed(inputs.players[i].held[0] % 16 - 8), Fixed(0)}, body.position());
      self(data).score += inputs.players[i].held[0];
    }
  }

  Space<Fixed> space;
  std::array<BodyId, 2> bodies{};
  std::uint64_t score = 0;
  std::array<std::uint64_t, kSaveSlots + kKeepSlots> saved{};
  SpaceGame<Fixed> game{space, ratio<Fixed>(1, 60), apply, this, own()};
};

TEST(SpaceGameTest, PeersWithStateBesideTheirSpacesStayTheSame) {
  Post post;
  std::array<Scored, 2> peers;
  std::vector<std::unique_ptr<Session>> sessions;
  for (Seat seat = 0; seat < 2; ++seat) {
    SessionSettings settings;
    settings.localSeat = seat;
    settings.addresses[1] = 1;
    settings.hashInterval = 1;
    peers[seat].game.describe(settings);
    sessions.push_back(std::make_unique<Session>(settings, peers[seat].game.functions(), post.of(seat)));
  }

  for (std::uint64_t i = 0; i < 400; ++i) {
    post.cut = i % 30 > 24;
    for (Seat seat = 0; seat < 2; ++seat) {
      const std::uint8_t held = static_cast<std::uint8_t>(i / 5 + seat);
      sessions[seat]->frame(i * 16'667, {&held, 1});
    }
  }

  EXPECT_GT(sessions[0]->tick(), 300u);
  EXPECT_GT(sessions[0]->stats().rollbacks, 10u);
  SessionEvent event;
  for (const auto& session : sessions) {
    while (session->next(event)) EXPECT_NE(event.kind, SessionEvent::Kind::desync);
  }
}

/// Two peers with a score, of which one may have vanished.
struct ScoredMatch {
  ScoredMatch() {
    for (Seat seat = 0; seat < 2; ++seat) begin(seat, false);
  }
  void begin(Seat seat, bool joins) {
    peers[seat] = std::make_unique<Scored>();
    SessionSettings settings;
    settings.localSeat = seat;
    settings.addresses[1] = 1;
    settings.hashInterval = 10;
    settings.joins = joins;
    peers[seat]->game.describe(settings);
    sessions[seat] = std::make_unique<Session>(settings, peers[seat]->game.functions(), post.of(seat));
  }
  void play(int frames) {
    for (int i = 0; i < frames; ++i) {
      now += 16'667;
      for (Seat seat = 0; seat < 2; ++seat) {
        const std::uint8_t held = static_cast<std::uint8_t>(now / 99'000 + seat);
        if (sessions[seat] != nullptr) sessions[seat]->frame(now, {&held, 1});
      }
    }
  }

  Post post;
  std::array<std::unique_ptr<Scored>, 2> peers;
  std::array<std::unique_ptr<Session>, 2> sessions;
  std::uint64_t now = 0;
};

TEST(SpaceGameTest, WhatDiffersBesideTheSpaceIsNamed) {
  ScoredMatch match;
  match.play(60);
  match.peers[1]->score += 3;
  // In every state that it may go back to as well.
  for (std::uint64_t& saved : match.peers[1]->saved) saved += 3;
  match.play(200);

  for (const auto& session : match.sessions) {
    ASSERT_NE(session->desync(), nullptr);
    const DesyncReport& report = *session->desync();
    EXPECT_STREQ(report.ours.object, "own state");
    EXPECT_STREQ(report.ours.field, "score");
    EXPECT_STREQ(report.theirs.field, "score");
    EXPECT_STRNE(report.ours.text, report.theirs.text);
  }
}

TEST(SpaceGameTest, ASyncTestNamesWhatIsNotBroughtBackBesideTheSpace) {
  Scored scored;
  Game game = scored.game.functions();
  game.load = [](std::uint32_t, void*) {};
  SyncTest test(game);
  const std::uint8_t held = 3;
  const std::array<PlayerInput, 2> players{PlayerInput{true, {&held, 1}, {}},
                                           PlayerInput{true, {&held, 1}, {}}};

  // Where nothing moves, the score alone is another one.
  Scored still;
  Game resting = still.game.functions();
  EXPECT_TRUE(resting.difference != nullptr);
  resting.save(0, resting.data);
  still.score += 1;
  resting.save(1, resting.data);
  std::array<char, 80> text{};
  EXPECT_TRUE(resting.difference(0, 1, text, resting.data));
  EXPECT_STREQ(text.data(), "own state, score: 0 and 1");
  EXPECT_FALSE(test.frame(players));
}

TEST(SpaceGameTest, WhoComesBackHasTheWorldAndWhatIsBesideIt) {
  ScoredMatch match;
  match.play(100);
  match.sessions[1].reset();
  match.play(260);
  match.begin(1, true);
  std::vector<std::uint8_t> bytes;
  match.peers[1]->game.record(bytes);
  match.play(400);

  ASSERT_EQ(match.sessions[1]->state(), SessionState::running);
  EXPECT_EQ(match.sessions[0]->present(), 0b11);
  for (const auto& session : match.sessions) EXPECT_EQ(session->desync(), nullptr);
  EXPECT_GT(match.peers[1]->score, 0u);
  const Tick to = std::min(match.sessions[1]->tick(), match.sessions[1]->confirmed());
  match.peers[1]->game.finishRecording(to);
  const VerifyResult result = verify<Fixed>(bytes, match.peers[1]->game.wiring());
  EXPECT_TRUE(result.matches);
  EXPECT_GT(result.ticks, 300u);
  EXPECT_LT(result.ticks, to);
}

TEST(SpaceGameTest, BytesThatAreNoStateAreRefusedAndTheRestOfTheMatchGoesOn) {
  Scored scored;
  const Game game = scored.game.functions();
  game.save(0, game.data);
  std::vector<std::uint8_t> bytes(game.write(0, {}, game.data));
  ASSERT_EQ(game.write(0, bytes, game.data), bytes.size());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(game.read(std::span<const std::uint8_t>(bytes).first(size), game.data)) << size;
  }
  bytes.push_back(0);
  EXPECT_FALSE(game.read(bytes, game.data));
  bytes.pop_back();
  EXPECT_TRUE(game.read(bytes, game.data));
}

TEST(SpaceGameTest, DescribesWorldTimeStepAndBuild) {
  const Scored light, heavy(2);
  SessionSettings a, b, c;
  light.game.describe(a);
  heavy.game.describe(b);
  c.content = 5;
  light.game.describe(c);

  EXPECT_EQ(a.revision, kSimulationRevision);
  EXPECT_EQ(a.fingerprint, b.fingerprint);
  EXPECT_NE(a.content, b.content);
  EXPECT_NE(a.content, c.content);
}

TEST(SpaceGameTest, RefusesAGameWithoutInputsAndHalfAnOwnState) {
  Space<Fixed> space;
  OwnState half;
  half.hash = [](void*) { return std::uint64_t{0}; };

  EXPECT_THROW(SpaceGame<Fixed>(space, Fixed(0), nullptr), ValueOutOfRange);
  EXPECT_THROW(SpaceGame<Fixed>(space, Fixed(0), Scored::apply, nullptr, half), ValueOutOfRange);
}

/// The inputs of two players for a tick, each with its own bytes.
struct TwoInputs {
  explicit TwoInputs(Tick at)
      : bytes{static_cast<std::uint8_t>(at / 3), static_cast<std::uint8_t>(at / 7)},
        players{PlayerInput{true, {&bytes[0], 1}, {}}, PlayerInput{true, {&bytes[1], 1}, {&bytes[0], 1}}},
        inputs{at, players} {}
  std::array<std::uint8_t, 2> bytes;
  std::array<PlayerInput, 2> players;
  TickInputs inputs;
};

TEST(SpaceGameTest, ARecordingOfARollbackMatchIsOfWhatWasPlayedInTheEnd) {
  Scored plain, guessing;
  std::vector<std::uint8_t> plainBytes, guessingBytes;
  plain.game.record(plainBytes);
  guessing.game.record(guessingBytes);
  const Game straight = plain.game.functions(), rolled = guessing.game.functions();
  for (Tick tick = 0; tick < 60; ++tick) straight.step(TwoInputs(tick).inputs, straight.data);
  for (Tick tick = 0; tick < 60; tick += 6) {
    rolled.save(0, rolled.data);
    // Guessed wrongly, taken back and made again.
    for (Tick guess = tick; guess < tick + 6; ++guess) {
      TwoInputs wrong(guess + 100);
      wrong.inputs.tick = guess;
      rolled.step(wrong.inputs, rolled.data);
    }
    rolled.load(0, rolled.data);
    for (Tick right = tick; right < tick + 6; ++right) rolled.step(TwoInputs(right).inputs, rolled.data);
  }
  plain.game.finishRecording(54);
  guessing.game.finishRecording(54);

  EXPECT_EQ(plainBytes, guessingBytes);
  const VerifyResult result = verify<Fixed>(guessingBytes, guessing.game.wiring());
  EXPECT_TRUE(result.matches);
  EXPECT_EQ(result.ticks, 54u);
}

TEST(SpaceGameTest, InputsOfATickSurviveTheirBytes) {
  const TwoInputs two(300);
  std::array<std::uint8_t, kMaxInputsBytes> bytes;
  const std::size_t size = encodeInputs(two.inputs, bytes);
  std::array<PlayerInput, kMaxPlayers> players;

  const TickInputs back = decodeInputs({bytes.data(), size}, players);

  EXPECT_EQ(back.tick, 300u);
  ASSERT_EQ(back.players.size(), 2u);
  EXPECT_EQ(back.players[1].held[0], two.bytes[1]);
  EXPECT_EQ(back.players[1].commands[0], two.bytes[0]);
  EXPECT_EQ(encodeInputs(two.inputs, std::span(bytes).first(size - 1)), 0u);
}

TEST(SpaceGameTest, BytesThatAreNoInputsAreRefused) {
  const TwoInputs two(300);
  std::array<std::uint8_t, kMaxInputsBytes> bytes;
  const std::size_t size = encodeInputs(two.inputs, bytes);
  std::array<PlayerInput, kMaxPlayers> players;
  for (std::size_t cut = 0; cut < size; ++cut) {
    EXPECT_THROW(decodeInputs({bytes.data(), cut}, players), MalformedBytes) << cut;
  }
  EXPECT_THROW(decodeInputs({bytes.data(), size + 1}, players), MalformedBytes);
  bytes[4] = kMaxPlayers + 1;
  EXPECT_THROW(decodeInputs({bytes.data(), size}, players), MalformedBytes);
}

}  // namespace
}  // namespace samestep
