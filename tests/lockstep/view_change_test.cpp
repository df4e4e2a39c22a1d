// SPDX-License-Identifier: MIT
#include "session/view_change.h"

#include <array>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace samestep::lockstep {
namespace {

TEST(ViewChangeTest, AnyTwoQuorumsShareAVoter) {
  for (const SeatMask voters :
       std::array<SeatMask, 7>{0b1, 0b11, 0b111, 0b1111, 0b110110, 0b11111, 0b1010101}) {
    for (SeatMask a = 0; a < 128; ++a) {
      for (SeatMask b = 0; b < 128; ++b) {
        if (!quorum(a, voters) || !quorum(b, voters)) continue;
        ASSERT_NE(a & b & voters, 0) << a << " and " << b;
      }
    }
  }
}

TEST(ViewChangeTest, OfTwoHalvesTheOneWithTheLowestSeatDecides) {
  EXPECT_TRUE(quorum(0b0011, 0b1111));
  EXPECT_FALSE(quorum(0b1100, 0b1111));
  EXPECT_TRUE(quorum(0b01, 0b11));
  EXPECT_FALSE(quorum(0b10, 0b11));
  EXPECT_FALSE(quorum(0b00011, 0b11111));
}

/// Voters who talk in any order, lose what they say and start ballots whenever they like.
class Chaos {
 public:
  Chaos(Seat voters, std::uint64_t seed) : random_(seed), peers_(voters), ends_(voters) {
    for (ViewChange& peer : peers_) peer.begin(static_cast<SeatMask>((1u << voters) - 1));
    for (auto& ends : ends_) {
      for (Tick& end : ends) end = static_cast<Tick>(random_() % 50);
    }
  }

  void act() {
    const Seat from = seat(), to = seat();
    ViewChange& proposer = peers_[from];
    if (random_() % 20 == 0) {
      const SeatMask gone =
          random_() % 3 == 0 ? SeatMask{0} : static_cast<SeatMask>(bit(seat()) & ~bit(from));
      proposer.propose(from, static_cast<SeatMask>(proposer.voters() & ~gone), gone);
    }
    const bool asked = proposer.proposing() && (proposer.missing() & bit(to)) != 0;
    if (!asked || random_() % 3 == 0) return;
    proposer.asking() ? askToAccept(from, to) : askToPromise(from, to);
  }
  const std::optional<View>& decided() const { return decided_; }

 private:
  Seat seat() { return static_cast<Seat>(random_() % peers_.size()); }
  void askToPromise(Seat from, Seat to) {
    ViewChange& proposer = peers_[from];
    if (!peers_[to].promise(proposer.ballot(), proposer.dropped()) || random_() % 4 == 0) return;
    proposer.promisedBy(to,
                        {proposer.ballot(), peers_[to].acceptedBallot(), peers_[to].accepted(), ends_[to]});
  }
  void askToAccept(Seat from, Seat to) {
    ViewChange& proposer = peers_[from];
    const View view = proposer.value();
    if (!peers_[to].accept(proposer.ballot(), view) || random_() % 4 == 0) return;
    if (!proposer.acceptedBy(to, proposer.ballot())) return;
    EXPECT_EQ(decided_.value_or(view), view);
    decided_ = view;
    for (Seat peer = 0; peer < peers_.size(); ++peer) {
      for (Seat gone = 0; gone < peers_.size(); ++gone) {
        if ((view.voters & bit(peer)) == 0 || (view.dropped & bit(gone)) == 0) continue;
        // A peer that goes on has no input that is not part of the decision.
        EXPECT_LE(ends_[peer][gone], view.end[gone]);
      }
    }
  }

  std::mt19937_64 random_;
  std::vector<ViewChange> peers_;
  std::vector<std::array<Tick, kMaxPlayers>> ends_;
  std::optional<View> decided_;
};

TEST(ViewChangeTest, WhateverIsLostThereIsOneDecisionAtMost) {
  int decided = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Chaos chaos(static_cast<Seat>(2 + seed % 6), seed);
    for (int i = 0; i < 600; ++i) chaos.act();
    decided += chaos.decided() ? 1 : 0;
  }
  EXPECT_GT(decided, 500);
}

TEST(ViewChangeTest, WhoMayBeDroppedIsFrozenUntilTheDecision) {
  ViewChange change;
  change.begin(0b111);

  change.promise(16, 0b100);
  change.promise(33, 0b000);

  EXPECT_EQ(change.frozen(), 0b100);
  EXPECT_FALSE(change.promise(17, 0b010));
  EXPECT_EQ(change.frozen(), 0b100);
}

}  // namespace
}  // namespace samestep::lockstep
