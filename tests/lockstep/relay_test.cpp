// SPDX-License-Identifier: MIT
#include <samestep/error.h>
#include <samestep/relay.h>

#include <numeric>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "lockstep/session_pair.h"
#include "relay/bundle.h"

namespace samestep {
namespace {

using lockstep::BundleQueue;
using lockstep::BundleReader;
using Bytes = std::vector<std::uint8_t>;

std::vector<std::pair<Seat, Bytes>> readAll(std::span<const std::uint8_t> bundle) {
  std::vector<std::pair<Seat, Bytes>> all;
  BundleReader reader(bundle);
  std::array<std::uint8_t, kMaxPacket> packet;
  Seat seat = 0;
  while (const std::uint32_t size = reader.next(seat, packet)) {
    all.emplace_back(seat, Bytes(packet.begin(), packet.begin() + size));
  }
  return all;
}

TEST(BundleTest, PacketsOfAnyLengthComeOutAsTheyWentIn) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    BundleQueue queue;
    std::vector<std::pair<Seat, Bytes>> in, out;
    for (std::uint32_t i = 0; i < 1 + random() % 20; ++i) {
      Bytes packet(1 + random() % (round % 3 == 0 ? kMaxPacket : 20));
      for (std::uint8_t& byte : packet) byte = static_cast<std::uint8_t>(random() % 3);
      // No packet of inputs: a later one would take its place.
      packet[0] = 10;
      const Seat seat = static_cast<Seat>(random() % kMaxPlayers);
      ASSERT_TRUE(queue.add(seat, packet));
      in.emplace_back(seat, packet);
    }
    std::array<std::uint8_t, kMaxDatagram> bundle;
    while (const std::uint32_t size = queue.take(bundle)) {
      EXPECT_LE(size, lockstep::kMaxBundle);
      const auto some = readAll(std::span(bundle).first(size));
      out.insert(out.end(), some.begin(), some.end());
    }
    EXPECT_EQ(in, out);
    EXPECT_TRUE(queue.empty());
  }
}

TEST(BundleTest, OfInputsTheNewestAreSent) {
  BundleQueue queue;
  queue.add(1, Bytes{2, 1, 1});
  queue.add(2, Bytes{2, 2, 2});
  queue.add(1, Bytes{10, 9});
  queue.add(1, Bytes{2, 3, 3, 3});
  std::array<std::uint8_t, kMaxDatagram> bundle;
  const std::uint32_t size = queue.take(bundle);

  const std::vector<std::pair<Seat, Bytes>> expected{{2, {2, 2, 2}}, {1, {10, 9}}, {1, {2, 3, 3, 3}}};
  EXPECT_EQ(readAll(std::span(bundle).first(size)), expected);
}

TEST(BundleTest, BytesThatAreNoBundleLeadNowhere) {
  std::mt19937 random(3);
  std::array<std::uint8_t, kMaxPacket> packet;
  for (int round = 0; round < 20000; ++round) {
    Bytes bytes(random() % 60);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    if (!bytes.empty()) bytes[0] = lockstep::kBundle;
    BundleReader reader(bytes);
    Seat seat = 0;
    std::uint32_t packets = 0;
    while (reader.next(seat, packet) > 0) ++packets;
    EXPECT_LE(packets, bytes.size());
  }
  BundleReader other(Bytes{1, 2, 3});
  Seat seat = 0;
  EXPECT_EQ(other.next(seat, packet), 0u);
  EXPECT_FALSE(other.good());
}

/// Players whose only way to each other is a relay.
struct Relayed {
  explicit Relayed(Seat players, Seat most = 0) {
    for (Seat seat = 0; seat < players; ++seat) add(seat, players, most, false);
  }
  void add(Seat seat, Seat players, Seat most, bool joins) {
    SessionSettings settings;
    settings.players = players;
    settings.maxPlayers = most;
    settings.localSeat = seat;
    settings.joins = joins;
    settings.hashInterval = 10;
    for (Seat other = 0; other < kMaxPlayers; ++other) {
      settings.addresses[other] = RelayTransport::address(other);
    }
    games.push_back(std::make_unique<AddingGame>());
    lines.push_back(std::make_unique<RelayTransport>(post->of(seat), kRelay, seat));
    sessions.push_back(
        std::make_unique<Session>(settings, games.back()->functions(), lines.back()->transport()));
  }
  void play(int frames) {
    for (int i = 0; i < frames; ++i) {
      now += 16'667;
      for (std::size_t at = 0; at < sessions.size(); ++at) {
        const std::uint8_t held = static_cast<std::uint8_t>(i / 7 + static_cast<int>(at));
        sessions[at]->frame(now, {&held, 1});
        lines[at]->update(now);
      }
      relay.update(now);
    }
  }
  bool agree() const {
    Tick tick = 0xffffffffu;
    for (const auto& session : sessions) tick = std::min({tick, session->tick(), session->confirmed()});
    for (const auto& game : games) {
      if (game->sums[tick % game->sums.size()] != games[0]->sums[tick % game->sums.size()]) return false;
    }
    return tick > 0;
  }

  static constexpr Seat kRelay = 15;
  std::unique_ptr<Post> post = std::make_unique<Post>();
  Relay relay{post->of(kRelay)};
  std::vector<std::unique_ptr<AddingGame>> games;
  std::vector<std::unique_ptr<RelayTransport>> lines;
  std::vector<std::unique_ptr<Session>> sessions;
  std::uint64_t now = 1'000'000;
};

TEST(RelayTest, PlayersPlayThroughIt) {
  Relayed match(4);
  match.play(400);

  EXPECT_GT(match.sessions[0]->tick(), 300u);
  EXPECT_TRUE(match.agree());
  EXPECT_EQ(match.relay.seats(), 4u);
  EXPECT_EQ(match.sessions[0]->stats().badPackets, 0u);
}

TEST(RelayTest, ANewcomerGetsTheStateThroughIt) {
  Relayed match(3, 4);
  match.play(100);
  match.add(3, 3, 4, true);
  match.play(400);

  EXPECT_EQ(match.sessions[3]->state(), SessionState::running);
  EXPECT_EQ(match.sessions[0]->present(), 0b1111);
  EXPECT_TRUE(match.agree());
}

TEST(RelayTest, NobodySpeaksInAnothersName) {
  Relayed match(3);
  match.play(60);
  const std::uint64_t before = match.relay.refused();
  // Another address says that it is seat 0, and sends something to seat 1.
  RelayTransport thief(match.post->of(9), Relayed::kRelay, 0);
  const Bytes packet{2, 0, 0, 1, 2, 3};
  thief.send(RelayTransport::address(1), packet);
  thief.update(match.now + 100'000);
  match.play(60);

  EXPECT_EQ(match.relay.refused(), before + 1);
  EXPECT_EQ(match.sessions[1]->stats().badPackets, 0u);
  EXPECT_TRUE(match.agree());
}

TEST(RelayTest, WithoutItThePlayersEndAsIfTheyHadLostEachOther) {
  Relayed match(3);
  match.play(60);
  match.post->cut = true;
  match.play(1500);

  for (const auto& session : match.sessions) EXPECT_EQ(session->endReason(), EndReason::minority);
}

}  // namespace
}  // namespace samestep
