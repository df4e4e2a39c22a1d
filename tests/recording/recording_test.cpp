// SPDX-License-Identifier: MIT
#include <samestep/recorder.h>
#include <samestep/recording.h>
#include <samestep/verify.h>
#include <samestep/version.h>

#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "support/recordings.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class RecordingTest : public ::testing::Test {};
TYPED_TEST_SUITE(RecordingTest, AllScalars);

/// The offset that a reader complains of; -1 where it does not.
template <Scalar S>
std::int64_t offsetOfComplaint(const Bytes& bytes) {
  try {
    RecordingReader<S> reader(bytes);
    return -1;
  } catch (const FormatError& error) {
    return static_cast<std::int64_t>(error.offset());
  }
}

TYPED_TEST(RecordingTest, KeepsEveryCommandAndHash) {
  const Bytes bytes = recordSmallMatch<TypeParam>();

  RecordingReader<TypeParam> reader(bytes);

  EXPECT_EQ(reader.ticks(), 24u);
  EXPECT_EQ(reader.timeStep(), kTick<TypeParam>);
  std::vector<CommandKind> kinds;
  std::uint32_t steps = 0;
  for (RecordingItem item = reader.next(); item != RecordingItem::end; item = reader.next()) {
    if (item == RecordingItem::command) kinds.push_back(kindOf(reader.command()));
    if (item == RecordingItem::step) ++steps;
  }
  EXPECT_EQ(steps, 24u);
  const std::vector<CommandKind> all = {CommandKind::applyImpulse,
                                        CommandKind::applyForce,
                                        CommandKind::spawn,
                                        CommandKind::setVelocity,
                                        CommandKind::setAngularVelocity,
                                        CommandKind::userInput,
                                        CommandKind::setPosition,
                                        CommandKind::setAngle,
                                        CommandKind::spawn,
                                        CommandKind::join,
                                        CommandKind::adjust,
                                        CommandKind::join,
                                        CommandKind::unjoin,
                                        CommandKind::remove};
  EXPECT_EQ(kinds, all);
}

TYPED_TEST(RecordingTest, SaysWhatItIsInItsFirstBytes) {
  const RecordingInfo info = recordingInfo(recordSmallMatch<TypeParam>(1));

  EXPECT_EQ(info.version, kRecordingVersion);
  EXPECT_EQ(info.revision, kSimulationRevision);
  EXPECT_EQ(info.scalar, ScalarTraits<TypeParam>::kKind);
}

TYPED_TEST(RecordingTest, IsRefusedWhereverItIsCutShort) {
  const Bytes bytes = recordSmallMatch<TypeParam>();

  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    const std::int64_t offset = offsetOfComplaint<TypeParam>(cut);
    ASSERT_GE(offset, 0) << length;
    ASSERT_LE(offset, static_cast<std::int64_t>(length));
  }
}

TYPED_TEST(RecordingTest, NothingMayFollowItsEnd) {
  Bytes bytes = recordSmallMatch<TypeParam>(2);
  const auto end = static_cast<std::int64_t>(bytes.size());
  bytes.push_back(0);

  EXPECT_EQ(offsetOfComplaint<TypeParam>(bytes), end);
}

TYPED_TEST(RecordingTest, ASingleAlteredByteIsFound) {
  const Bytes bytes = recordSmallMatch<TypeParam>(4);

  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes altered = bytes;
    altered[i] ^= 0x10;
    ASSERT_GE(offsetOfComplaint<TypeParam>(altered), 0) << i;
  }
}

TYPED_TEST(RecordingTest, OtherVersionsRevisionsAndScalarsAreRefusedAtTheirPlace) {
  const Bytes bytes = recordSmallMatch<TypeParam>(1);
  for (const std::int64_t offset : {0, 8, 12, 16}) {
    Bytes altered = bytes;
    altered[static_cast<std::size_t>(offset)] ^= 3;
    mendChecksum(altered);
    EXPECT_EQ(offsetOfComplaint<TypeParam>(altered), offset);
  }
}

TYPED_TEST(RecordingTest, VerifyRefusesAnotherRevisionAndNamesBoth) {
  Bytes altered = recordSmallMatch<TypeParam>(1);
  altered[12] = kSimulationRevision + 41;
  mendChecksum(altered);

  try {
    verify<TypeParam>(altered, namedHandlerWiring<TypeParam>());
    ADD_FAILURE() << "another revision was verified";
  } catch (const RevisionError& error) {
    EXPECT_EQ(error.offset(), 12u);
    const std::string text = error.what();
    EXPECT_NE(text.find(std::to_string(kSimulationRevision + 41)), std::string::npos) << text;
    EXPECT_EQ(error.own(), kSimulationRevision);
  }
}

// A count of billions costs no memory.
TYPED_TEST(RecordingTest, HugeCountsAreRefusedBeforeMemoryIsTaken) {
  const Bytes bytes = recordSmallMatch<TypeParam>(4);
  for (std::size_t i = 28; i + 4 < bytes.size(); ++i) {
    Bytes altered = bytes;
    for (std::size_t j = 0; j < 4; ++j) altered[i + j] = 0xff;
    mendChecksum(altered);
    const std::int64_t offset = offsetOfComplaint<TypeParam>(altered);
    ASSERT_LT(offset, static_cast<std::int64_t>(bytes.size()));
  }
}

TYPED_TEST(RecordingTest, AMatchCanBeRecordedFromItsMiddle) {
  Space<TypeParam> space;
  fillAtRandom(space, 5);
  hashesOf(space, 90);
  ASSERT_FALSE(space.state().pairs.empty());
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);
  for (int i = 0; i < 60; ++i) recorder.step();
  recorder.finish();

  const VerifyResult result = verify<TypeParam>(bytes, {});

  EXPECT_TRUE(result.matches);
  EXPECT_EQ(result.computedHash, space.hash());
}

TYPED_TEST(RecordingTest, ASinkGetsTheSameBytes) {
  Space<TypeParam> space;
  fillAtRandom(space, 3);
  SavedSpace<TypeParam> start = space.save();
  Bytes direct;
  Recorder<TypeParam> first(space, kTick<TypeParam>, direct);
  for (int i = 0; i < 50; ++i) first.step();
  first.finish();
  space.restore(start);
  Bytes collected;
  const auto collect = [](std::span<const std::uint8_t> piece, void* data) {
    auto& all = *static_cast<Bytes*>(data);
    all.insert(all.end(), piece.begin(), piece.end());
  };
  Recorder<TypeParam> second(space, kTick<TypeParam>, collect, &collected);
  for (int i = 0; i < 50; ++i) {
    space.step(kTick<TypeParam>);
    second.stepped();
  }
  second.finish();

  EXPECT_EQ(collected, direct);
}

TYPED_TEST(RecordingTest, ARefusedCommandIsNotRecorded) {
  Space<TypeParam> space;
  const BodyId player = fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);

  expectRefused<BodyNotFound>(space, [&] { recorder.apply(Remove{}); });
  expectRefused<IllegalBody>(space, [&] {
    recorder.apply(SetVelocity<TypeParam>{player, {TypeParam(5000), TypeParam(0)}});
  });
  expectRefused<MissingCallback>(space, [&] { recorder.apply(UserInput{{1}}); });

  recorder.step();
  recorder.finish();
  EXPECT_TRUE(verify<TypeParam>(bytes, namedHandlerWiring<TypeParam>()).matches);
}

TYPED_TEST(RecordingTest, ASpawnIsAllOrNothing) {
  Space<TypeParam> space;
  fillSmall(space);
  Spawn<TypeParam> heavy = discToSpawn<TypeParam>();
  // Each may be this heavy, both together may not.
  heavy.shapes[0].setMass(TypeParam(900000));
  heavy.shapes.push_back(heavy.shapes[0]);

  expectRefused<IllegalBody>(space, [&] { applyCommand<TypeParam>(space, heavy); });
}

TYPED_TEST(RecordingTest, ASpawnUnderGivenIdsIsAllOrNothing) {
  using S = TypeParam;
  Space<S> space;
  fillSmall(space);
  EXPECT_EQ(applyCommand<S>(space, underGivenIds(discToSpawn<S>(), {12, 3}, {9, 1})), (BodyId{12, 3}));
  EXPECT_EQ(space.shape({9, 1}).body(), (BodyId{12, 3}));
  const auto refuses = [&](Spawn<S> spawn) {
    expectRefused<IllegalId>(space, [&] { applyCommand<S>(space, spawn); });
  };

  refuses(underGivenIds(discToSpawn<S>(), {12, 5}, {10, 1}));
  refuses(underGivenIds(discToSpawn<S>(), {13, 1}, {9, 3}));
  Spawn<S> twice = underGivenIds(discToSpawn<S>(), {13, 1}, {10, 1});
  twice.shapes.push_back(twice.shapes[0]);
  refuses(twice);
}

TYPED_TEST(RecordingTest, AGivenIdBeyondTheLimitsTakesNoRoom) {
  const Bytes bytes = recordSmallMatch<TypeParam>();
  VerifyOptions options;
  options.limits.bodies = 12;
  EXPECT_THROW(verify<TypeParam>(bytes, testWiring<TypeParam>(), options), FormatError);
  options.limits.bodies = 13;
  options.limits.shapes = 9;
  EXPECT_THROW(verify<TypeParam>(bytes, testWiring<TypeParam>(), options), FormatError);
  options.limits.shapes = 10;
  EXPECT_TRUE(verify<TypeParam>(bytes, testWiring<TypeParam>(), options).matches);
}

TYPED_TEST(RecordingTest, SteppingPastTheRecorderIsRefused) {
  Space<TypeParam> space;
  fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);

  EXPECT_THROW(recorder.stepped(), ForeignWorld);
  space.step(kTick<TypeParam> / TypeParam(2));
  EXPECT_THROW(recorder.stepped(), ForeignWorld);
  space.step(kTick<TypeParam>);
  EXPECT_THROW(recorder.stepped(), ForeignWorld);
}

TYPED_TEST(RecordingTest, CheckingFindsWhatWasNotRecorded) {
  Space<TypeParam> space;
  const BodyId player = fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);
  recorder.setChecking(true);
  recorder.apply(ApplyImpulse<TypeParam>{player, {TypeParam(1), TypeParam(0)}, {}});
  recorder.step();

  space.body(player).setAngularVelocity(TypeParam(1));

  EXPECT_THROW(recorder.step(), ForeignWorld);
}

// Fuzzing found that the end of the arm was worked out before it was checked, and overflowed.
template <class S>
class CommandTest : public ::testing::Test {};
TYPED_TEST_SUITE(CommandTest, AllScalarsAndChecked);
TYPED_TEST(CommandTest, ArmThatLeadsOutOfTheWorldIsRefused) {
  Space<TypeParam> space;
  const BodyId player = fillSmall(space);
  space.body(player).setPosition({TypeParam(50), TypeParam(0)});
  const Body<TypeParam> before = space.body(player);
  const Vector<TypeParam> up{TypeParam(0), TypeParam(1)};
  for (const TypeParam length : {TypeParam(0x7fffffff), -TypeParam(0x7fffffff), TypeParam(1 << 20)}) {
    const Vector<TypeParam> arm{length, TypeParam(0)};
    EXPECT_THROW(applyCommand<TypeParam>(space, ApplyImpulse<TypeParam>{player, up, arm}), IllegalBody);
    EXPECT_THROW(applyCommand<TypeParam>(space, ApplyForce<TypeParam>{player, up, arm}), IllegalBody);
  }
  EXPECT_EQ(space.body(player).velocity(), before.velocity());
  EXPECT_EQ(space.body(player).force(), before.force());
}

#ifndef SAMESTEP_FIXED_ONLY
TEST(RecordingBytesTest, AreTheSameForCheckedAndWrappingFixed) {
  EXPECT_EQ(recordSmallMatch<Fixed>(), recordSmallMatch<CheckedFixed>());
}
#endif

/// Question that a function called by a step or command asks of the recorder, and whether it was refused.
template <Scalar S>
struct FromWithin {
  Recorder<S>* recorder = nullptr;
  int refused = 0;

  void askAll() {
    const auto ask = [&](auto&& call) {
      try {
        call();
      } catch (const Error& error) {
        if (error.fault() == Fault::SpaceLocked) ++refused;
      }
    };
    ask([&] { recorder->apply(UserInput{{7}}); });
    ask([&] { recorder->step(); });
    ask([&] { recorder->stepped(); });
    ask([&] { recorder->claim("a", "b"); });
    ask([&] { recorder->note("a", "b"); });
    ask([&] { recorder->finish(); });
  }
};
constexpr int kAsked = 6;

TYPED_TEST(RecordingTest, FunctionsOfAStepOrCommandCannotWriteIntoIt) {
  FromWithin<TypeParam> within;
  Wiring<TypeParam> wiring;
  wiring.data = &within;
  wiring.applyInput = [](Space<TypeParam>&, std::span<const std::uint8_t> bytes, void* data) {
    static_cast<FromWithin<TypeParam>*>(data)->askAll();
    require<Fault::ValueOutOfRange>(bytes[0] != 0);
  };
  Space<TypeParam> space;
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes, wiring);
  within.recorder = &recorder;
  recorder.step();

  recorder.apply(UserInput{{1}});
  EXPECT_EQ(std::exchange(within.refused, 0), kAsked);
  EXPECT_THROW(recorder.apply(UserInput{{0}}), Error);
  EXPECT_EQ(std::exchange(within.refused, 0), kAsked);

  recorder.step();
  recorder.finish();
  wiring.applyInput = [](Space<TypeParam>&, std::span<const std::uint8_t>, void*) {};
  const VerifyResult result = verify<TypeParam>(bytes, wiring);
  EXPECT_TRUE(result.matches);
  EXPECT_EQ(result.ticks, 2u);
}

}  // namespace
}  // namespace samestep
