// SPDX-License-Identifier: MIT
#include "netsim/match.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace samestep::netsim {
namespace {

MatchOptions options(std::uint64_t seed, std::uint32_t faults, Tick ticks = 300) {
  MatchOptions options;
  options.seed = seed;
  options.peers = static_cast<std::uint32_t>(2 + seed % 15);
  options.faults = faults;
  options.ticks = ticks;
  return options;
}

std::string all(const MatchReport& report) {
  return std::accumulate(report.violations.begin(), report.violations.end(), std::string(),
                         [](const std::string& text, const std::string& next) { return text + next + "\n"; });
}

class FaultTest : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(FaultTest, LeavesPeersTheSame) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    EXPECT_EQ(all(runMatch(options(seed, GetParam()))), "") << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Netsim, FaultTest,
                         ::testing::Values(0, kLoss, kPartition, kStall, kCrash, kLeave, kChange, kDrift,
                                           kHostile, kAsymmetric, kJoin, kJoin | kLie, kCrash | kRejoin,
                                           kCorrupt, kMove, kMove | kPartition, kAllFaults),
                         [](const auto& fault) {
                           std::string name = faultNames(fault.param);
                           std::replace(name.begin(), name.end(), ',', '_');
                           return name;
                         });

TEST(NetsimTest, PeersOfAPhysicsGameStayTheSame) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    MatchOptions physics = options(seed, kAllFaults, 300);
    physics.makeGame = makeArenaGame;
    EXPECT_EQ(all(runMatch(physics)), "") << "seed " << seed;
  }
}

// Negative control: one bit in the position of one body, 2^-16 m.
TEST(NetsimTest, OneBitOfOneBodyIsCaughtAndNamedByEveryPeer) {
  MatchOptions physics = options(3, kLoss, 300);
  physics.makeGame = makeArenaGame;
  physics.planted = Planted::flip;

  const MatchReport report = runMatch(physics);

  EXPECT_THAT(report.violations, ::testing::Contains(::testing::HasSubstr("states of tick")));
  EXPECT_EQ(report.desynced, (1u << physics.peers) - 1) << all(report);
  EXPECT_EQ(report.named, (1u << physics.peers) - 1) << ::testing::PrintToString(report.findings);
  for (const std::string& finding : report.findings) EXPECT_THAT(finding, ::testing::HasSubstr("body 1, "));
}

TEST(NetsimTest, PeersOfARelayStayTheSame) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    MatchOptions relayed = options(seed, kLoss | kCrash | kRejoin | kJoin | kMove | kCorrupt, 300);
    relayed.relay = true;
    EXPECT_EQ(all(runMatch(relayed)), "") << "seed " << seed;
  }
}

TEST(NetsimTest, SixteenPlayersOfARelaySendAndReceiveTwelveKilobytesASecond) {
  MatchOptions relayed = options(1, 0, 900);
  relayed.peers = kMaxPlayers;
  relayed.relay = true;
  relayed.delay = 50;
  relayed.loss = 5;

  const MatchReport report = runMatch(relayed);

  EXPECT_EQ(all(report), "");
  // IP and UDP take 28 bytes of each datagram, and a seal 21.
  const auto each = [&](std::uint64_t bytes, std::uint64_t datagrams) {
    return (bytes + 49 * datagrams) * 1000 / (report.milliseconds * report.peers);
  };
  EXPECT_LE(each(report.up, report.upDatagrams), 12'000u);
  EXPECT_LE(each(report.down, report.downDatagrams), 12'000u);
  EXPECT_GT(each(report.down, report.downDatagrams), 2'000u);
}

TEST(NetsimTest, AMatchIsTheSameEachTime) {
  const MatchReport first = runMatch(options(7, kAllFaults));
  const MatchReport again = runMatch(options(7, kAllFaults));

  EXPECT_EQ(first.trace, again.trace);
  EXPECT_EQ(first.datagrams, again.datagrams);
  EXPECT_NE(first.trace, runMatch(options(22, kAllFaults)).trace);
}

TEST(NetsimTest, TheSeedsCoverRollbacksDropsAndLeaving) {
  MatchReport sum;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const MatchReport report = runMatch(options(seed, kAllFaults));
    sum.rollbacks += report.rollbacks;
    sum.deepest = std::max(sum.deepest, report.deepest);
    sum.dropped += report.dropped;
    sum.left += report.left;
    sum.waited += report.waited;
    sum.joined += report.joined;
    sum.rejoined += report.rejoined;
    sum.refused += report.refused;
    sum.moved += report.moved;
    sum.spoilt += report.spoilt;
    sum.forged += report.forged;
  }
  EXPECT_GT(sum.rollbacks, 1000u);
  EXPECT_GE(sum.deepest, 8u);
  EXPECT_GT(sum.dropped, 2u);
  EXPECT_GT(sum.left, 2u);
  EXPECT_GT(sum.waited, 100u);
  EXPECT_GT(sum.joined, 10u);
  EXPECT_GT(sum.rejoined, 2u);
  EXPECT_GT(sum.refused, 2u);
  EXPECT_GT(sum.moved, 8u);
  EXPECT_GT(sum.spoilt, 1000u);
  EXPECT_GT(sum.forged, sum.spoilt / 2);
}

// Negative control: an oracle that cannot fail proves nothing.
TEST(NetsimTest, APlantedFaultIsCaughtByTheOracleAndByEveryPeer) {
  for (const Planted planted : {Planted::flip, Planted::deaf}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      MatchOptions broken = options(seed, kLoss | kDrift);
      broken.planted = planted;

      const MatchReport report = runMatch(broken);

      EXPECT_THAT(report.violations, ::testing::Contains(::testing::HasSubstr("states of tick"))) << seed;
      EXPECT_EQ(report.desynced, (1u << broken.peers) - 1) << seed << ": " << all(report);
    }
  }
}

// Negative control: nothing but the seal keeps out what was changed on the way.
TEST(NetsimTest, APeerWithoutASealIsCaught) {
  int caught = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    MatchOptions open = options(seed, kCorrupt, 900);
    open.planted = Planted::unsealed;
    caught += runMatch(open).violations.empty() ? 0 : 1;
  }
  EXPECT_GE(caught, 4);
}

TEST(NetsimTest, WhoTellsOtherHashesThanItHasIsNamedByAll) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    MatchOptions lying = options(seed, kLoss, 600);
    lying.planted = Planted::lies;

    const MatchReport report = runMatch(lying);

    // The states themselves are the same, and all play on.
    ASSERT_EQ(report.violations.size(), 1u) << all(report);
    EXPECT_THAT(report.violations[0], ::testing::HasSubstr("tells hashes of states that it does not have"));
    EXPECT_EQ(report.desynced, (1u << lying.peers) - 1) << seed;
    EXPECT_EQ(report.survivors, lying.peers);
  }
}

TEST(NetsimTest, AGameThatComesBackWronglyFromALoadIsCaught) {
  int caught = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    MatchOptions broken = options(seed, kLoss);
    broken.planted = Planted::forgets;
    caught += runMatch(broken).violations.empty() ? 0 : 1;
  }
  // Peers in pure lockstep load nothing, and a later load from before mends the state.
  EXPECT_GE(caught, 3);
}

TEST(NetsimTest, AFailureIsShrunkToAMatchThatStillFails) {
  MatchOptions broken = options(5, kAllFaults & ~(kCrash | kLeave | kStall | kPartition), 600);
  broken.planted = Planted::flip;
  ASSERT_FALSE(runMatch(broken).violations.empty());

  const MatchOptions small = shrink(broken);

  EXPECT_FALSE(runMatch(small).violations.empty());
  EXPECT_LT(small.ticks, broken.ticks);
  EXPECT_LT(small.peers, broken.peers);
  EXPECT_LT(std::popcount(small.faults), std::popcount(broken.faults));
}

}  // namespace
}  // namespace samestep::netsim
