// SPDX-License-Identifier: MIT
// A player for people, and verdicts as values.
#include <samestep/judge.h>
#include <samestep/player.h>
#include <samestep/version.h>

#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "support/recordings.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class PlayerTest : public ::testing::Test {
 protected:
  static constexpr KeyframeBudget kEveryFour{4, 1u << 20};

  static Bytes match() { return recordSmallMatch<S>(24, kEveryFour); }
  /// Recording with another keyframe after tick 8 and the hash to it: a lie all of a piece.
  static Bytes forged() {
    by_hand::Recording parts = by_hand::takeApart(match());
    std::size_t eighth = 0;
    std::size_t twelfth = 0;
    for (std::size_t i = 0, keyframe = 0; i < parts.sections.size(); ++i) {
      if (parts.sections[i].kind != by_hand::kKeyframe) continue;
      if (keyframe == 2) eighth = i;
      if (keyframe++ == 3) twelfth = i;
    }
    Bytes& world = parts.sections[eighth].payload;
    const Bytes& other = parts.sections[twelfth].payload;
    world.assign(other.begin(), other.end());
    world[0] = 8;
    Bytes& items = parts.sections[eighth - 1].payload;
    std::copy(other.begin() + 8, other.begin() + 16, items.end() - 8);
    return by_hand::putTogether(parts);
  }
};
TYPED_TEST_SUITE(PlayerTest, AllScalars);

TYPED_TEST(PlayerTest, WhatIsPlayedIsProvenAndWhatIsSoughtIsClaimed) {
  const Bytes bytes = this->match();
  Player<TypeParam> player(bytes, testWiring<TypeParam>());
  EXPECT_EQ(player.ticks(), 24u);
  EXPECT_EQ(player.trust(), Trust::proven);
  EXPECT_TRUE(player.seek(13));
  EXPECT_EQ(player.tick(), 13u);
  EXPECT_EQ(player.trust(), Trust::claimed);
  EXPECT_EQ(player.provenTicks(), 0u);

  EXPECT_TRUE(player.seek(0));
  EXPECT_EQ(player.trust(), Trust::proven);
  while (player.step()) {
  }
  EXPECT_EQ(player.provenTicks(), 24u);
  // A keyframe within what is proven is as good.
  EXPECT_TRUE(player.seek(9));
  EXPECT_EQ(player.trust(), Trust::proven);
  EXPECT_FALSE(player.wrongTick());
  EXPECT_THROW(player.seek(25), ValueOutOfRange);
}

TYPED_TEST(PlayerTest, AForgedKeyframeIsShownAsClaimedAndFoundByPlaying) {
  const Bytes bytes = this->forged();
  Player<TypeParam> player(bytes, testWiring<TypeParam>());
  EXPECT_TRUE(player.seek(8));
  EXPECT_EQ(player.trust(), Trust::claimed);
  EXPECT_TRUE(player.step());
  EXPECT_EQ(player.trust(), Trust::refuted);
  EXPECT_TRUE(player.seek(0));
  while (player.tick() < 7) player.step();
  EXPECT_EQ(player.trust(), Trust::proven);
  player.step();
  EXPECT_EQ(player.trust(), Trust::refuted);
  EXPECT_EQ(player.wrongTick(), 8u);
  EXPECT_EQ(player.provenTicks(), 7u);
}

TYPED_TEST(PlayerTest, ManyPlayOneRecordingAtOnce) {
  const Bytes bytes = this->match();
  std::vector<std::uint64_t> hashes(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    threads.emplace_back([&, i] {
      Player<TypeParam> player(bytes, testWiring<TypeParam>());
      for (std::uint64_t tick = i; tick + 5 < 24; tick += 5) player.seek(tick);
      player.seek(24);
      hashes[i] = player.space().hash();
    });
  }
  for (std::thread& thread : threads) thread.join();
  const std::uint64_t last = verify<TypeParam>(bytes, testWiring<TypeParam>()).computedHash;
  EXPECT_EQ(hashes, std::vector<std::uint64_t>(4, last));
}

TYPED_TEST(PlayerTest, ASeekStopsWhereItIsAskedTo) {
  const Bytes bytes = recordSmallMatch<TypeParam>(24, {0, 0});
  PlayerOptions options;
  options.progress = [](std::uint64_t tick, std::uint64_t target, void*) { return tick < 6 && target == 20; };
  Player<TypeParam> player(bytes, testWiring<TypeParam>(), options);

  EXPECT_FALSE(player.seek(20));
  EXPECT_EQ(player.tick(), 6u);
}

template <class S>
class JudgeTest : public PlayerTest<S> {
 protected:
  static Judgement judged(const Bytes& bytes, const VerifyOptions& options = {}) {
    return judge<S>(bytes, testWiring<S>(), options);
  }
};
TYPED_TEST_SUITE(JudgeTest, AllScalars);

TYPED_TEST(JudgeTest, WhatIsGoodIsVerified) {
  const Judgement judgement = this->judged(this->match());

  EXPECT_EQ(judgement.verdict, Verdict::verified);
  EXPECT_EQ(judgement.reason, "");
  EXPECT_EQ(judgement.tick, 24u);
  EXPECT_EQ(judgement.revision, kSimulationRevision);
  EXPECT_NE(judgement.content, this->judged(this->forged()).content);
}

TYPED_TEST(JudgeTest, AMismatchIsFollowedToTheEndWhereThatIsWanted) {
  const Bytes bytes = this->forged();
  EXPECT_EQ(this->judged(bytes).verdict, Verdict::mismatch);
  EXPECT_EQ(this->judged(bytes).tick, 8u);
  VerifyOptions options;
  options.toTheEnd = true;
  const Judgement judgement = this->judged(bytes, options);

  EXPECT_EQ(judgement.verdict, Verdict::mismatch);
  EXPECT_EQ(judgement.tick, 8u);
  EXPECT_EQ(judgement.result.wrongTicks, 1u);
  EXPECT_NE(judgement.reason.find("agree again after tick 8"), std::string::npos) << judgement.reason;
}

TYPED_TEST(JudgeTest, EachOtherVerdictHasItsGrounds) {
  const Bytes bytes = this->match();
  Bytes cut(bytes.begin(), bytes.end() - 40);
  EXPECT_EQ(this->judged(cut).verdict, Verdict::incomplete);
  VerifyOptions options;
  options.expected.ticks = 24;
  cut.resize(bytes.size() / 2);
  EXPECT_EQ(this->judged(cut, options).verdict, Verdict::incomplete);
  options.expected.ticks = 23;
  EXPECT_EQ(this->judged(bytes, options).verdict, Verdict::unexpected);

  Bytes other = bytes;
  other[12] ^= 0x40;
  mendRecording(other);
  const Judgement revision = this->judged(other);
  EXPECT_EQ(revision.verdict, Verdict::otherRevision);
  EXPECT_EQ(revision.revision, kSimulationRevision ^ 0x40u);
  EXPECT_EQ(revision.offset, 12u);

  other = bytes;
  other[100] ^= 1;
  EXPECT_EQ(this->judged(other).verdict, Verdict::unusable);
  EXPECT_EQ(this->judged({}).verdict, Verdict::unusable);
  EXPECT_EQ(judge<TypeParam>(bytes, {}).verdict, Verdict::unusable);

  options = {};
  options.progress = [](std::uint64_t done, std::uint64_t, void*) { return done < 3; };
  EXPECT_EQ(this->judged(bytes, options).verdict, Verdict::stopped);
}

TYPED_TEST(JudgeTest, AFalseClaimIsAVerdictOfItsOwn) {
  Space<TypeParam> space;
  fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes, testWiring<TypeParam>());
  recorder.step();
  recorder.claim("samestep.bodies", "3000");
  recorder.step();
  recorder.finish();
  const Judgement judgement = this->judged(bytes);

  EXPECT_EQ(judgement.verdict, Verdict::falseClaim);
  EXPECT_EQ(judgement.tick, 1u);
}

}  // namespace
}  // namespace samestep
