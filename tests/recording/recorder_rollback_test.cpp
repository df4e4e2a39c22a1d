// SPDX-License-Identifier: MIT
#include <samestep/recorder.h>
#include <samestep/verify.h>

#include <new>
#include <utility>

#include <gtest/gtest.h>

#include "support/allocation_count.h"
#include "support/recordings.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class RecorderRollbackTest : public ::testing::Test {
 protected:
  /// The section of one step, the index of one keyframe and the end.
  static constexpr std::size_t kBytesFromTicksToEnd = (5 + 9 + 8) + (5 + 24 + 8) + (5 + 16 + 8);

  static void expectRefusedAt(const Bytes& bytes, std::uint64_t offset) {
    try {
      verify<S>(bytes, namedHandlerWiring<S>());
      ADD_FAILURE() << "not refused";
    } catch (const FormatError& error) {
      EXPECT_EQ(error.offset(), offset);
    }
  }
};
TYPED_TEST_SUITE(RecorderRollbackTest, AllScalars);

template <Scalar S>
ApplyImpulse<S> push(BodyId player, int strength) {
  return {player, {S(strength), S(0)}, {}};
}

/// A match in which each guess of a player's input is taken back after `depth` steps, or one without guesses.
template <Scalar S>
Bytes match(int depth, std::uint64_t& lastHash) {
  Space<S> space;
  const BodyId player = fillSmall(space);
  Bytes bytes;
  Recorder<S> recorder(space, kTick<S>, bytes);
  SavedSpace<S> saved;
  for (int tick = 0; tick < 60; ++tick) {
    space.save(saved);
    for (int guess = 0; guess < depth; ++guess) {
      recorder.apply(push<S>(player, -1));
      recorder.step();
    }
    if (depth > 0) space.restore(saved);
    if (tick % 5 == 0) recorder.apply(push<S>(player, 1));
    recorder.step();
  }
  lastHash = space.hash();
  recorder.finish();
  return bytes;
}

TYPED_TEST(RecorderRollbackTest, WhatWasTakenBackIsNotInTheRecording) {
  std::uint64_t hashOfPlain = 0;
  const Bytes plain = match<TypeParam>(0, hashOfPlain);
  for (const int depth : {1, 2, 8}) {
    std::uint64_t hash = 0;
    EXPECT_EQ(match<TypeParam>(depth, hash), plain) << depth;
    EXPECT_EQ(hash, hashOfPlain) << depth;
  }
  EXPECT_TRUE(verify<TypeParam>(plain, namedHandlerWiring<TypeParam>()).matches);
}

/// Plays what the players do before a step: the same each time, or a wrong guess.
template <Scalar S>
void play(Recorder<S>& recorder, BodyId player, std::uint64_t tick, bool guess) {
  if (tick % 3 == 0 || guess) recorder.apply(push<S>(player, guess ? -2 : 1));
  const std::uint8_t input[] = {static_cast<std::uint8_t>(guess ? 255 : tick)};
  if (tick % 4 == 1) recorder.input(input);
  recorder.step();
}

/// A match of so many steps with the worlds before the last few of them in a ring, as a session keeps them.
template <Scalar S>
struct RingMatch {
  static constexpr std::uint64_t kSaves = 8;
  Space<S> space;
  BodyId player = fillSmall(space);
  Bytes bytes;
  Recorder<S> recorder{space, kTick<S>, bytes, testWiring<S>()};
  SavedSpace<S> saves[kSaves];

  /// @return its bytes
  Bytes straight(std::uint64_t ticks) {
    for (std::uint64_t tick = 0; tick < ticks; ++tick) play(recorder, player, tick, false);
    recorder.finish();
    return bytes;
  }
  void advance(std::uint64_t tick, bool guess) {
    space.save(saves[tick % kSaves]);
    play(recorder, player, tick, guess);
  }
  /// Goes back to `tick` and on to where it was, without guesses.
  void correct(std::uint64_t tick) {
    const std::uint64_t end = recorder.ticks();
    space.restore(saves[tick % kSaves]);
    while (tick < end) advance(tick++, false);
  }
};

TYPED_TEST(RecorderRollbackTest, GoingBackAtEveryTickByEveryDepthGivesTheSameBytes) {
  constexpr std::uint64_t kTicks = 40;
  const Bytes plain = RingMatch<TypeParam>().straight(kTicks);
  for (std::uint64_t depth = 1; depth <= RingMatch<TypeParam>::kSaves; ++depth) {
    RingMatch<TypeParam> match;
    for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
      match.advance(tick, true);
      match.correct(tick + 1 < depth ? 0 : tick + 1 - depth);
    }
    match.recorder.finish();
    EXPECT_EQ(match.bytes, plain) << depth;
  }
}

TYPED_TEST(RecorderRollbackTest, OneLateInputAtAnyTickGivesTheSameBytes) {
  constexpr std::uint64_t kTicks = 40;
  const Bytes plain = RingMatch<TypeParam>().straight(kTicks);
  for (std::uint64_t late = 0; late < kTicks; ++late) {
    RingMatch<TypeParam> match;
    for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
      match.advance(tick, tick == late);
      if (tick == late + 3 || tick + 1 == kTicks) match.correct(tick < late + 3 ? late : tick - 3);
    }
    match.recorder.finish();
    EXPECT_EQ(match.bytes, plain) << late;
  }
}

TYPED_TEST(RecorderRollbackTest, WhatIsConfirmedIsFinalAndWhatIsNotCanBeLeftOut) {
  const Bytes plain = RingMatch<TypeParam>().straight(20);
  RingMatch<TypeParam> match;
  for (std::uint64_t tick = 0; tick < 20; ++tick) match.advance(tick, false);
  for (std::uint64_t tick = 20; tick < 24; ++tick) match.advance(tick, true);
  EXPECT_THROW(match.recorder.confirm(25), ValueOutOfRange);
  match.recorder.confirm(20);
  match.recorder.confirm(3);
  match.space.restore(match.saves[19 % match.kSaves]);
  EXPECT_THROW(match.recorder.step(), ForeignWorld);
  EXPECT_THROW(match.recorder.finish(19), ValueOutOfRange);
  EXPECT_THROW(match.recorder.finish(25), ValueOutOfRange);
  match.recorder.finish(20);

  EXPECT_EQ(match.bytes, plain);
}

TYPED_TEST(RecorderRollbackTest, AConfirmedMatchReachesTheSinkWithoutDelay) {
  Space<TypeParam> space;
  fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);
  recorder.setRewindTicks(kMostRewindTicks);
  recorder.setKeyframes({0, 0});
  const std::size_t first = bytes.size();
  for (int i = 0; i < 3000; ++i) recorder.step();
  EXPECT_EQ(bytes.size(), first);
  recorder.confirm(3000);

  // All but the last section.
  EXPECT_GT(bytes.size(), first + (3000 - 240) * 9);
}

TYPED_TEST(RecorderRollbackTest, ACommandWithoutAStepIsTakenBack) {
  Space<TypeParam> space;
  const BodyId player = fillSmall(space);
  const SavedSpace<TypeParam> start = space.save();
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);
  recorder.apply(push<TypeParam>(player, 3));
  space.restore(start);
  recorder.step();
  recorder.finish();

  RecordingReader<TypeParam> reader(bytes);

  EXPECT_EQ(reader.next(), RecordingItem::step);
  EXPECT_TRUE(verify<TypeParam>(bytes, namedHandlerWiring<TypeParam>()).matches);
}

TYPED_TEST(RecorderRollbackTest, AGameThatStepsByItselfIsFollowed) {
  Space<TypeParam> space;
  fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);
  SavedSpace<TypeParam> saved;
  for (int i = 0; i < 40; ++i) {
    if (i == 20) space.save(saved);
    if (i == 30) space.restore(saved);
    space.step(kTick<TypeParam>);
    recorder.stepped();
  }
  EXPECT_EQ(recorder.ticks(), 30u);
  recorder.finish();

  EXPECT_TRUE(verify<TypeParam>(bytes, namedHandlerWiring<TypeParam>()).matches);
}

// A long match has most of its recording with the sink when the world goes back.
TYPED_TEST(RecorderRollbackTest, WorldsThatAreNotTheRecordingsAreRefusedUntilOneIs) {
  Space<TypeParam> space;
  const BodyId player = fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);
  recorder.setRewindTicks(100);
  const SavedSpace<TypeParam> start = space.save();
  for (int i = 0; i < 1500; ++i) recorder.step();
  const SavedSpace<TypeParam> between = [&] {
    const SavedSpace<TypeParam> good = space.save();
    space.body(player).setUserData(77);
    const SavedSpace<TypeParam> strange = space.save();
    space.restore(good);
    return strange;
  }();
  SavedSpace<TypeParam> oldest;
  space.save(oldest);
  for (int i = 0; i < 100; ++i) recorder.step();

  space.restore(start);
  EXPECT_THROW(recorder.step(), ForeignWorld);
  space.restore(between);
  EXPECT_THROW(recorder.apply(push<TypeParam>(player, 1)), ForeignWorld);
  space.restore(oldest);
  recorder.step();
  recorder.finish();

  EXPECT_EQ(recorder.ticks(), 1501u);
  EXPECT_TRUE(verify<TypeParam>(bytes, namedHandlerWiring<TypeParam>()).matches);
}

TYPED_TEST(RecorderRollbackTest, WhatComesAfterTheLastStepIsLeftOutAndRefusedByReaders) {
  Space<TypeParam> space;
  const BodyId player = fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);
  recorder.step();
  recorder.apply(push<TypeParam>(player, 3));
  recorder.finish();
  EXPECT_TRUE(verify<TypeParam>(bytes, namedHandlerWiring<TypeParam>()).matches);

  // A remove of that body, by hand: item, kind, id.
  const auto index = static_cast<std::uint8_t>(player.index);
  const auto generation = static_cast<std::uint8_t>(player.generation);
  const Bytes command = {1, 7, index, 0, 0, 0, generation, 0, 0, 0};
  by_hand::Recording parts = by_hand::takeApart(bytes);
  Bytes& items = parts.sections[1].payload;
  items.insert(items.end(), command.begin(), command.end());
  this->expectRefusedAt(by_hand::putTogether(parts), bytes.size() - this->kBytesFromTicksToEnd);

  Bytes old = asVersion2<TypeParam>(bytes);
  const std::size_t end = old.size() - (1 + 8 + 8);
  old.insert(old.begin() + static_cast<std::ptrdiff_t>(end), command.begin(), command.end());
  mendChecksum(old);
  this->expectRefusedAt(old, end);
}

TYPED_TEST(RecorderRollbackTest, ARecordingWithoutAStepIsRefused) {
  Space<TypeParam> space;
  fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam>(space, kTick<TypeParam>, bytes).finish();

  EXPECT_THROW(verify<TypeParam>(bytes, namedHandlerWiring<TypeParam>()), FormatError);
}

TYPED_TEST(RecorderRollbackTest, AWarmMatchWithARingOfSavesTakesNoMemory) {
  Space<TypeParam> space;
  const BodyId player = fillSmall(space);
  std::uint64_t given = 0;
  const auto count = [](std::span<const std::uint8_t> bytes, void* data) {
    *static_cast<std::uint64_t*>(data) += bytes.size();
  };
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, count, &given, testWiring<TypeParam>());
  SavedSpace<TypeParam> saves[8];
  const auto play = [&](std::uint64_t ticks) {
    const std::uint64_t end = recorder.ticks() + ticks;
    while (recorder.ticks() < end) {
      const std::uint64_t tick = recorder.ticks();
      for (std::uint64_t guess = 0; guess < 8; ++guess) {
        space.save(saves[(tick + guess) % 8]);
        recorder.apply(push<TypeParam>(player, guess % 2 == 0 ? -1 : 1));
        const std::uint8_t input[] = {static_cast<std::uint8_t>(guess)};
        recorder.input(input);
        recorder.step();
      }
      space.restore(saves[tick % 8]);
      recorder.apply(push<TypeParam>(player, tick % 2 == 0 ? 1 : -1));
      recorder.step();
      recorder.confirm(recorder.ticks());
    }
  };
  // The busiest stretch of this world, whose trees still grow by then, and of what waits for the sink.
  play(6000);
  const std::uint64_t before = allocationCount, givenBefore = given;
  play(600);

  EXPECT_EQ(allocationCount, before);
  EXPECT_GT(given, givenBefore);
}

/// Plays a tick of a match, all of it recorded.
template <Scalar S>
void playTick(Recorder<S>& recorder, BodyId player, std::uint64_t tick, std::size_t& done) {
  std::vector<Command<S>> commands;
  if (tick % 2 == 0) commands.push_back(push<S>(player, 1));
  if (tick == 1) commands.push_back(discToSpawn<S>());
  if (tick == 2) commands.push_back(underGivenIds(discToSpawn<S>(), {12, 3}, {9, 1}));
  if (tick == 4) commands.push_back(Remove{{12, 3}});
  for (; done < commands.size(); ++done) recorder.apply(commands[done]);
  recorder.step();
}

/// A match of which one call for memory fails; what failed is done again, from the last step where the world
/// was left midway.
template <Scalar S>
Bytes matchWithFailure(std::int64_t failing, bool& failed) {
  Space<S> space;
  const BodyId player = fillSmall(space);
  Bytes bytes;
  SavedSpace<S> saved;
  Recorder<S> recorder(space, kTick<S>, bytes, testWiring<S>());
  failed = false;
  allocationsUntilFailure = failing;
  for (std::uint64_t tick = 0; tick < 6; ++tick) {
    const std::int64_t left = std::exchange(allocationsUntilFailure, -1);
    space.save(saved);
    allocationsUntilFailure = left;
    std::size_t done = 0;
    while (recorder.ticks() == tick) {
      try {
        playTick(recorder, player, tick, done);
      } catch (const std::bad_alloc&) {
        EXPECT_FALSE(std::exchange(failed, true));
        if (space.isUsable()) continue;
        space.restore(saved);
        done = 0;
      }
    }
  }
  failed = failed || allocationsUntilFailure < 0;
  allocationsUntilFailure = -1;
  recorder.finish();
  return bytes;
}

TYPED_TEST(RecorderRollbackTest, WhereMemoryFailsTheRecordingIsThatOfTheMatchAsItWasPlayed) {
  bool failed = false;
  const Bytes whole = matchWithFailure<TypeParam>(-1, failed);
  ASSERT_TRUE(verify<TypeParam>(whole, testWiring<TypeParam>()).matches);
  std::int64_t failing = 0;
  do {
    ASSERT_EQ(matchWithFailure<TypeParam>(failing, failed), whole) << failing;
    ++failing;
  } while (failed);
  EXPECT_GT(failing, 50);
}

}  // namespace
}  // namespace samestep
