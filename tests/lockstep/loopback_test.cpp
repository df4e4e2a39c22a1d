// SPDX-License-Identifier: MIT
#include "loopback/match.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace samestep::loopback {
namespace {

MatchOptions badNetwork(std::uint32_t players) {
  MatchOptions options;
  options.players = players;
  options.ticks = 240;
  options.crates = 6;
  options.speed = 8;
  options.link.delay = 40'000;
  options.link.jitter = 20'000;
  options.link.loss = 50;
  return options;
}

TEST(LoopbackTest, ProcessesThatPlayOverUdpRecordTheSameMatch) {
  const MatchOptions options = badNetwork(3);
  const std::vector<PeerResult> peers = playMatch(options);

  EXPECT_EQ(compareRecordings(options, peers), "");
  for (const PeerResult& peer : peers) {
    EXPECT_TRUE(peer.ended);
    EXPECT_EQ(peer.report.reason, EndReason::left);
    EXPECT_FALSE(peer.report.desynced);
    EXPECT_EQ(peer.report.refused, 0u);
    EXPECT_GT(peer.report.lost, 0u);
  }
}

// Negative control.
TEST(LoopbackTest, AWorldThatIsNotWhatItsInputsLeadToIsFound) {
  MatchOptions options = badNetwork(2);
  options.flipSeat = 1;
  options.flipTick = 100;
  const std::vector<PeerResult> peers = playMatch(options);

  EXPECT_THAT(compareRecordings(options, peers), testing::HasSubstr("peer 1: its world after tick 101"));
  for (const PeerResult& peer : peers) {
    EXPECT_TRUE(peer.report.desynced);
    EXPECT_THAT(peer.words, testing::HasSubstr("desync: body 2, center.x"));
    EXPECT_THAT(peer.words, testing::Not(testing::HasSubstr("most")));
  }
}

TEST(LoopbackTest, EachOfThreeNamesBodyAndFieldAndWhoDiffers) {
  MatchOptions options = badNetwork(3);
  options.flipSeat = 2;
  options.flipTick = 100;

  for (const PeerResult& peer : playMatch(options)) {
    EXPECT_THAT(peer.words, testing::HasSubstr("desync: body 3, center.x after "));
    EXPECT_THAT(peer.words, testing::HasSubstr("peer 2 differs from most"));
  }
}

}  // namespace
}  // namespace samestep::loopback
