// SPDX-License-Identifier: MIT
#include <samestep/sealed_transport.h>

#include <algorithm>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "transport/handshake.h"
#include "transport/replay_window.h"

namespace samestep {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

/// Datagrams in memory: what was sent waits in the queue of its receiver, and is kept.
struct Wire {
  struct End {
    Wire* wire;
    Address address;
  };
  std::map<Address, std::deque<std::pair<Address, Bytes>>> waiting;
  std::vector<std::pair<Address, Bytes>> sent;
  std::map<Address, End> ends;

  Transport at(Address address) {
    ends[address] = {this, address};
    return {&ends[address],
            [](Address to, std::span<const std::uint8_t> bytes, void* data) {
              const End& end = *static_cast<End*>(data);
              end.wire->waiting[to].push_back({end.address, {bytes.begin(), bytes.end()}});
              end.wire->sent.push_back({to, {bytes.begin(), bytes.end()}});
            },
            [](Address& from, std::span<std::uint8_t> into, void* data) -> std::uint32_t {
              const End& end = *static_cast<End*>(data);
              auto& queue = end.wire->waiting[end.address];
              if (queue.empty()) return 0;
              const auto [sender, bytes] = queue.front();
              queue.pop_front();
              from = sender;
              std::copy(bytes.begin(), bytes.end(), into.begin());
              return static_cast<std::uint32_t>(bytes.size());
            }};
  }
};

class SealedTransportTest : public ::testing::Test {
 protected:
  static constexpr Address kAnna = 100, kBert = 200, kEve = 300;

  SealedTransportTest() {
    toBert = anna.addPeer(bertKeys.publicKey, kBert);
    toAnna = bert.addPeer(annaKeys.publicKey);
  }

  /// Lets time pass and takes what arrives.
  void run(int rounds = 4) {
    for (int i = 0; i < rounds; ++i) {
      now += 300'000;
      anna.update(now);
      bert.update(now);
      take(anna, atAnna);
      take(bert, atBert);
    }
  }

  static void take(SealedTransport& transport, std::vector<Bytes>& into) {
    Address from = 0;
    Bytes buffer(kMaxDatagram);
    while (const std::uint32_t length = transport.receive(from, buffer)) {
      into.push_back({buffer.begin(), buffer.begin() + length});
    }
  }

  Wire wire;
  MatchKey match{{7}};
  KeyPair annaKeys = KeyPair::fromSeed({1}), bertKeys = KeyPair::fromSeed({2});
  SealedTransport anna{wire.at(kAnna), annaKeys, match};
  SealedTransport bert{wire.at(kBert), bertKeys, match};
  Address toBert = 0, toAnna = 0;
  std::uint64_t now = 0;
  std::vector<Bytes> atAnna, atBert;
};

TEST_F(SealedTransportTest, PeersAgreeOnKeysAndReadEachOther) {
  run();
  ASSERT_TRUE(anna.connected(toBert));
  ASSERT_TRUE(bert.connected(toAnna));

  anna.send(toBert, bytesOf("left"));
  bert.send(toAnna, bytesOf("right"));
  run(1);

  EXPECT_EQ(atBert, std::vector<Bytes>{bytesOf("left")});
  EXPECT_EQ(atAnna, std::vector<Bytes>{bytesOf("right")});
}

TEST_F(SealedTransportTest, ASealAddsTheBytesThatItSays) {
  run();
  anna.send(toBert, bytesOf("left"));

  EXPECT_EQ(wire.sent.back().second.size(), 4 + SealedTransport::kSealBytes);
}

TEST_F(SealedTransportTest, NothingReadableIsOnTheWire) {
  run();
  anna.send(toBert, bytesOf("a long secret"));

  for (const auto& [to, bytes] : wire.sent) {
    const std::string text(bytes.begin(), bytes.end());
    EXPECT_EQ(text.find("secret"), std::string::npos);
    const std::string key(annaKeys.publicKey.bytes.begin(), annaKeys.publicKey.bytes.end());
    EXPECT_EQ(text.find(key), std::string::npos);
  }
}

TEST_F(SealedTransportTest, ADatagramIsTakenOnce) {
  run();
  anna.send(toBert, bytesOf("left"));
  wire.waiting[kBert].push_back(wire.waiting[kBert].back());
  run(1);

  EXPECT_EQ(atBert.size(), 1u);
  EXPECT_EQ(bert.counters().replayed, 1u);
}

TEST_F(SealedTransportTest, EveryDatagramOfAMatchSentAgainChangesNothing) {
  run();
  anna.send(toBert, bytesOf("left"));
  run(1);
  const auto recorded = wire.sent;
  for (const auto& [to, bytes] : recorded) wire.waiting[to].push_back({kEve, bytes});
  run(2);
  anna.send(toBert, bytesOf("again"));
  bert.send(toAnna, bytesOf("back"));
  run(1);

  EXPECT_EQ(atBert, (std::vector<Bytes>{bytesOf("left"), bytesOf("again")}));
  EXPECT_EQ(atAnna, std::vector<Bytes>{bytesOf("back")});
}

TEST_F(SealedTransportTest, ADatagramWithAnyBitChangedIsDropped) {
  run();
  anna.send(toBert, bytesOf("left"));
  const Bytes good = wire.waiting[kBert].back().second;
  wire.waiting[kBert].clear();
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1 << (bit % 8)));
    wire.waiting[kBert].push_back({kAnna, bad});
  }
  run(1);
  EXPECT_TRUE(atBert.empty());

  wire.waiting[kBert].push_back({kAnna, good});
  run(1);
  EXPECT_EQ(atBert, std::vector<Bytes>{bytesOf("left")});
}

TEST_F(SealedTransportTest, OrderDoesNotMatterWithinTheWindow) {
  run();
  for (int i = 0; i < 100; ++i) anna.send(toBert, bytesOf(std::to_string(i)));
  auto& queue = wire.waiting[kBert];
  std::reverse(queue.begin(), queue.end());
  run(1);

  EXPECT_EQ(atBert.size(), 100u);
}

TEST_F(SealedTransportTest, MoreDatagramsThanTheNumberOnTheWireHolds) {
  run();
  for (int i = 0; i < 70'000; ++i) {
    anna.send(toBert, bytesOf("x"));
    if (i % 3 != 0) wire.waiting[kBert].pop_back();
    if (i % 100 == 0) take(bert, atBert);
  }
  take(bert, atBert);

  EXPECT_EQ(atBert.size(), 23'334u);
  EXPECT_EQ(bert.counters().forged, 0u);
}

TEST_F(SealedTransportTest, AStrangerWithoutTheMatchKeyGetsNoAnswer) {
  const std::size_t before = wire.sent.size();
  const MatchKey other{{8}};
  const Call call(annaKeys, bertKeys.publicKey, other, 1);
  wire.waiting[kBert].push_back({kEve, {call.hello().begin(), call.hello().end()}});
  take(bert, atBert);

  EXPECT_EQ(wire.sent.size(), before);
  EXPECT_EQ(bert.counters().forged, 1u);
}

TEST_F(SealedTransportTest, APeerThatWasNotLetInGetsNoAnswer) {
  const KeyPair eve = KeyPair::fromSeed({3});
  const Call call(eve, bertKeys.publicKey, match, 1);
  wire.waiting[kBert].push_back({kEve, {call.hello().begin(), call.hello().end()}});
  take(bert, atBert);

  EXPECT_TRUE(wire.sent.empty());
  EXPECT_EQ(bert.counters().strangers, 1u);
}

TEST_F(SealedTransportTest, AdmissionDecidesAboutPeersThatAreNotKnown) {
  SealedTransport eve(wire.at(kEve), KeyPair::fromSeed({3}), match);
  bert.setAdmission([](const PublicKey&, void*) { return true; }, nullptr);
  const Address toBertFromEve = eve.addPeer(bertKeys.publicKey, kBert);
  std::vector<Bytes> atEve;
  for (int i = 0; i < 4; ++i) {
    run(1);
    eve.update(now);
    take(eve, atEve);
  }

  EXPECT_TRUE(eve.connected(toBertFromEve));
}

TEST_F(SealedTransportTest, APeerCannotSpeakForAnother) {
  // Eve has the match's key and her own, and calls as Anna.
  KeyPair eve = KeyPair::fromSeed({3});
  eve.publicKey = annaKeys.publicKey;
  const Call call(eve, bertKeys.publicKey, match, 1);
  wire.waiting[kBert].push_back({kEve, {call.hello().begin(), call.hello().end()}});
  take(bert, atBert);

  EXPECT_TRUE(wire.sent.empty());
  EXPECT_EQ(bert.counters().forged, 1u);
}

TEST_F(SealedTransportTest, NoAnswerIsLongerThanItsQuestion) { EXPECT_LT(kAnswerBytes, kHelloBytes); }

TEST_F(SealedTransportTest, LostCallsAndAnswersAreMadeAgain) {
  for (int lost = 0; lost < 5; ++lost) {
    now += 300'000;
    anna.update(now);
    if (lost % 2 == 0) wire.waiting[kBert].clear();
    take(bert, atBert);
    wire.waiting[kAnna].clear();
  }
  run();

  EXPECT_TRUE(anna.connected(toBert));
  EXPECT_TRUE(bert.connected(toAnna));
}

TEST_F(SealedTransportTest, WhereTheLastWordOfTheAgreementIsLostItIsSaidAgain) {
  anna.update(now);
  take(bert, atBert);
  take(anna, atAnna);
  wire.waiting[kBert].clear();
  ASSERT_TRUE(anna.connected(toBert));
  ASSERT_FALSE(bert.connected(toAnna));
  run(2);

  EXPECT_TRUE(bert.connected(toAnna));
}

TEST_F(SealedTransportTest, BothMayCallAtOnce) {
  bert.addPeer(annaKeys.publicKey, kAnna);
  run();
  anna.send(toBert, bytesOf("left"));
  bert.send(toAnna, bytesOf("right"));
  run(1);

  EXPECT_EQ(atBert, std::vector<Bytes>{bytesOf("left")});
  EXPECT_EQ(atAnna, std::vector<Bytes>{bytesOf("right")});
}

TEST_F(SealedTransportTest, APeerMayChangeItsAddress) {
  run();
  bert.send(toAnna, bytesOf("hello"));
  run(1);
  anna.send(toBert, bytesOf("from elsewhere"));
  wire.waiting[kBert].back().first = kEve;
  run(1);
  bert.send(toAnna, bytesOf("there"));

  EXPECT_EQ(wire.sent.back().first, kEve);
}

TEST_F(SealedTransportTest, APeerThatBeganAnewIsCalledAnew) {
  run();
  SealedTransport newBert(wire.at(kBert), bertKeys, match);
  const Address toAnnaAnew = newBert.addPeer(annaKeys.publicKey);
  std::vector<Bytes> atNewBert;
  for (int i = 0; i < 20; ++i) {
    now += 300'000;
    anna.update(now);
    newBert.update(now);
    take(newBert, atNewBert);
    take(anna, atAnna);
  }
  ASSERT_TRUE(newBert.connected(toAnnaAnew));
  newBert.send(toAnnaAnew, bytesOf("back again"));
  take(anna, atAnna);

  EXPECT_EQ(atAnna, std::vector<Bytes>{bytesOf("back again")});
}

TEST_F(SealedTransportTest, WhoWasRemovedIsNotHeard) {
  run();
  bert.removePeer(toAnna);
  anna.send(toBert, bytesOf("left"));
  run(1);

  EXPECT_TRUE(atBert.empty());
  EXPECT_FALSE(bert.connected(toAnna));
  EXPECT_GE(bert.counters().unknown, 1u);
}

TEST_F(SealedTransportTest, BytesOfAnyKindAndLengthAreCountedAndDropped) {
  run();
  for (std::uint32_t length = 1; length <= kMaxDatagram; ++length) {
    for (std::uint8_t kind = 0x50; kind <= 0x53; ++kind) {
      Bytes bytes(length, 0xa5);
      bytes[0] = kind;
      wire.waiting[kBert].push_back({kEve, bytes});
    }
  }
  // No call takes all of a flood.
  take(bert, atBert);
  EXPECT_FALSE(wire.waiting[kBert].empty());
  while (!wire.waiting[kBert].empty()) take(bert, atBert);
  const SealCounters& counters = bert.counters();

  EXPECT_TRUE(atBert.empty());
  EXPECT_EQ(counters.malformed + counters.forged + counters.unknown + counters.replayed, 4u * kMaxDatagram);
}

TEST_F(SealedTransportTest, APayloadThatIsTooLongIsNotSent) {
  run();
  const std::size_t before = wire.sent.size();
  anna.send(toBert, Bytes(SealedTransport::kMaxPayload + 1));

  EXPECT_EQ(wire.sent.size(), before);
  EXPECT_EQ(anna.counters().unsent, 1u);
}

TEST(ReplayWindow, NumbersAreTakenOnceAndOldOnesNever) {
  ReplayWindow window;
  EXPECT_FALSE(window.seen(0));
  window.mark(0);
  window.mark(5000);

  EXPECT_TRUE(window.seen(0));
  EXPECT_TRUE(window.seen(5000));
  EXPECT_FALSE(window.seen(5000 - ReplayWindow::kSize + 1));
  EXPECT_TRUE(window.seen(5000 - ReplayWindow::kSize));
  EXPECT_FALSE(window.seen(5001));
}

TEST(ReplayWindow, WholeNumbersAreTheNearestOnes) {
  ReplayWindow window;
  EXPECT_EQ(window.wholeOf(3), 3u);
  EXPECT_EQ(window.wholeOf(0xfff0), 0xfff0u);
  window.mark(0x1fff0);
  EXPECT_EQ(window.wholeOf(0x0003), 0x20003u);
  EXPECT_EQ(window.wholeOf(0xffe0), 0x1ffe0u);
}

}  // namespace
}  // namespace samestep
