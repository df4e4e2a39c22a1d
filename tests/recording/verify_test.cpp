// SPDX-License-Identifier: MIT
#include <samestep/verify.h>
#include <samestep/workers.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "support/recordings.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class VerifyTest : public ::testing::Test {};
TYPED_TEST_SUITE(VerifyTest, AllScalars);

/// Offsets of the hash of each step.
template <Scalar S>
std::vector<std::size_t> hashOffsets(const Bytes& bytes) {
  std::vector<std::size_t> offsets;
  RecordingReader<S> reader(bytes);
  for (RecordingItem item = reader.next(); item != RecordingItem::end; item = reader.next()) {
    if (item == RecordingItem::step) offsets.push_back(static_cast<std::size_t>(reader.offset()) + 1);
  }
  return offsets;
}

TYPED_TEST(VerifyTest, AFaithfulRecordingMatches) {
  const Bytes bytes = recordSmallMatch<TypeParam>(100);

  const VerifyResult result = verify<TypeParam>(bytes, testWiring<TypeParam>());

  EXPECT_TRUE(result.matches);
  EXPECT_EQ(result.ticks, 100u);
  EXPECT_EQ(result.recordedHash, result.computedHash);
}

TYPED_TEST(VerifyTest, TheFirstWrongTickIsNamed) {
  Bytes bytes = recordSmallMatch<TypeParam>(20);
  const std::vector<std::size_t> hashes = hashOffsets<TypeParam>(bytes);
  bytes[hashes[12]] ^= 1;
  bytes[hashes[16]] ^= 1;
  mendChecksum(bytes);

  const VerifyResult result = verify<TypeParam>(bytes, testWiring<TypeParam>());

  EXPECT_FALSE(result.matches);
  EXPECT_EQ(result.firstWrongTick, 13u);
  EXPECT_EQ(result.recordedHash ^ 1, result.computedHash);
}

TYPED_TEST(VerifyTest, AWrongFirstWorldIsTickZero) {
  Bytes bytes = recordSmallMatch<TypeParam>(5);
  // The hash of the first world stands behind the head of its section and its tick.
  const std::size_t initial = by_hand::kHeaderBytes + 5 + 8;
  bytes[initial] ^= 0x80;
  mendChecksum(bytes);

  const VerifyResult result = verify<TypeParam>(bytes, testWiring<TypeParam>());

  EXPECT_FALSE(result.matches);
  EXPECT_EQ(result.firstWrongTick, 0u);
}

TYPED_TEST(VerifyTest, MoreBodiesShapesOrPairsThanAllowedAreRefused) {
  const Bytes bytes = recordSmallMatch<TypeParam>(20);
  const auto verifyWithin = [&](const WorldLimits& limits) {
    VerifyOptions options;
    options.limits = limits;
    return verify<TypeParam>(bytes, testWiring<TypeParam>(), options).matches;
  };
  std::uint32_t most = 0;
  Replay<TypeParam> replay(bytes, testWiring<TypeParam>());
  do {
    most = std::max(most, static_cast<std::uint32_t>(replay.space().state().pairs.size()));
  } while (replay.step());
  ASSERT_GT(most, 0u);

  WorldLimits limits;
  limits.pairs = most;
  EXPECT_TRUE(verifyWithin(limits));
  limits.pairs = most - 1;
  EXPECT_THROW(verifyWithin(limits), FormatError);
  limits = {};
  limits.bodies = 1;
  EXPECT_THROW(verifyWithin(limits), FormatError);
  limits = {};
  limits.shapes = 1;
  EXPECT_THROW(verifyWithin(limits), FormatError);
}

TYPED_TEST(VerifyTest, MoreBytesOrCommandsBeforeAStepThanAllowedAreRefused) {
  using S = TypeParam;
  Space<S> space;
  const BodyId player = fillSmall(space);
  Bytes bytes;
  Recorder<S> recorder(space, kTick<S>, bytes, testWiring<S>());
  for (int tick = 0; tick < 3; ++tick) {
    for (int i = 0; i < 5; ++i) recorder.apply(SetAngularVelocity<S>{player, S(i)});
    recorder.step();
  }
  recorder.finish();
  const auto complaint = [&](const RecordingLimits& limits) -> std::string {
    VerifyOptions options;
    options.limits = limits;
    try {
      return verify<S>(bytes, testWiring<S>(), options).matches ? "" : "does not match";
    } catch (const FormatError& error) {
      return error.what();
    }
  };
  RecordingLimits limits;
  limits.bytes = bytes.size();
  limits.commandsPerTick = 5;
  EXPECT_EQ(complaint(limits), "");
  limits.commandsPerTick = 4;
  EXPECT_EQ(complaint(limits), "more commands before a step than allowed");
  limits = {};
  limits.bytes = bytes.size() - 1;
  EXPECT_EQ(complaint(limits), "more bytes than allowed");
}

/// Discs in one place, and commands that remove some of them.
template <Scalar S>
Bytes recordHeap() {
  Space<S> space;
  for (int i = 0; i < 100; ++i) addDisc<S>(space, {}, S(1), S(1));
  Bytes bytes;
  Recorder<S> recorder(space, kTick<S>, bytes, {});
  for (std::uint32_t tick = 0; tick < 3; ++tick) {
    for (std::uint32_t i = 0; i < 10; ++i)
      recorder.apply(Remove{space.state().bodies.idAt(1 + 10 * tick + i)});
    recorder.step();
  }
  recorder.finish();
  return bytes;
}

TYPED_TEST(VerifyTest, AnInterruptEndsItWhereverItIsAsked) {
  using S = TypeParam;
  const Bytes bytes = recordHeap<S>();
  struct Asked {
    int left;
    int asked = 0;
  };
  const auto verifyUntil = [&](Asked& asked) {
    VerifyOptions options;
    options.interrupt = {[](void* data) {
                           Asked& to = *static_cast<Asked*>(data);
                           return ++to.asked == to.left;
                         },
                         &asked};
    return verify<S>(bytes, {}, options);
  };
  Asked never{-1};
  EXPECT_TRUE(verifyUntil(never).matches);
  // Thirty commands, and in each of three steps eight stages and four substeps of two passes.
  ASSERT_GT(never.asked, 30 + 3 * (8 + 8));
  for (int place = 1; place <= never.asked; ++place) {
    Asked asked{place};
    const VerifyResult result = verifyUntil(asked);
    EXPECT_TRUE(result.stopped) << place;
    EXPECT_FALSE(result.matches) << place;
    EXPECT_EQ(asked.asked, place);
  }
}

TYPED_TEST(VerifyTest, MoreWorkThanAllowedIsRefusedInTheSamePlaceWhoeverComputes) {
  using S = TypeParam;
  const Bytes bytes = recordHeap<S>();
  Replay<S> replay(bytes);
  while (replay.step()) {
  }
  const std::uint64_t work = replay.space().work();
  WorkerPool pool(3);
  for (TaskRunner* workers : {static_cast<TaskRunner*>(nullptr), static_cast<TaskRunner*>(&pool)}) {
    VerifyOptions options;
    options.workers = workers;
    options.limits.work = work;
    EXPECT_TRUE(verify<S>(bytes, {}, options).matches);
    options.limits.work = work - 1;
    try {
      verify<S>(bytes, {}, options);
      ADD_FAILURE() << "not refused";
    } catch (const FormatError& error) {
      EXPECT_STREQ(error.what(), "more work than allowed");
    }
  }
}

// A few bytes a body, and every body is near all others: 50 million pairs.
TYPED_TEST(VerifyTest, AHeapOfTenThousandIsRefusedInItsFirstStep) {
  using S = TypeParam;
  Space<S> space;
  for (int i = 0; i < 10000; ++i) {
    const BodyId body = space.add(Body<S>(S(1), S(1)));
    space.add(circleShape<S>(body, S(1)));
  }
  Bytes bytes;
  Recorder<S>(space, ratio<S>(1, 60), bytes, {}).finish();
  EXPECT_THROW(space.step(ratio<S>(1, 60)), TooManyPairs);
  // A step is put in by hand, before the index: its item and a hash.
  by_hand::Recording parts = by_hand::takeApart(bytes);
  parts.sections.insert(parts.sections.begin() + 1, {by_hand::kTicks, 0, Bytes(1 + 8, 0)});
  parts.sections.back().payload[0] = 1;
  bytes = by_hand::putTogether(parts);

  EXPECT_LT(bytes.size(), 400000u);
  try {
    verify<S>(bytes, {});
    ADD_FAILURE() << "not refused";
  } catch (const FormatError& error) {
    EXPECT_STREQ(error.what(),
                 "Space::step: more shapes are near each other than the 262144 pairs allowed; see "
                 "Space::setMaxPairs");
  }
}

TYPED_TEST(VerifyTest, MissingFunctionsAreNamedAsSuch) {
  const Bytes bytes = recordSmallMatch<TypeParam>(10);

  EXPECT_THROW(verify<TypeParam>(bytes, {}), MissingCallback);
  EXPECT_THROW(verify<TypeParam>(bytes, namedHandlerWiring<TypeParam>()), MissingCallback);
}

TYPED_TEST(VerifyTest, ACommandThatTheWorldRefusesHasAnOffset) {
  Space<TypeParam> space;
  const BodyId player = fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);
  recorder.apply(SetVelocity<TypeParam>{player, {TypeParam(1), TypeParam(0)}});
  recorder.step();
  recorder.finish();
  // Item, kind, then the index of the body.
  const std::size_t command = hashOffsets<TypeParam>(bytes)[0] - 1 - (2 + 8 + 16);
  bytes[command + 2] ^= 0x40;
  mendChecksum(bytes);

  try {
    verify<TypeParam>(bytes, namedHandlerWiring<TypeParam>());
    FAIL() << "accepted";
  } catch (const FormatError& error) {
    EXPECT_EQ(error.offset(), command);
  }
}

TYPED_TEST(VerifyTest, WorldsLargerThanAllowedAreRefused) {
  const Bytes bytes = recordSmallMatch<TypeParam>(9);
  VerifyOptions options;
  options.limits.bodies = 3;

  EXPECT_THROW(verify<TypeParam>(bytes, testWiring<TypeParam>(), options), FormatError);
  // The match begins with four bodies and spawns a fifth.
  options.limits.bodies = 4;
  EXPECT_THROW(verify<TypeParam>(bytes, testWiring<TypeParam>(), options), FormatError);
  options.limits.bodies = 5;
  EXPECT_TRUE(verify<TypeParam>(bytes, testWiring<TypeParam>(), options).matches);
}

TYPED_TEST(VerifyTest, StopsWhenAskedTo) {
  const Bytes bytes = recordSmallMatch<TypeParam>(50);
  VerifyOptions options;
  options.progress = [](std::uint64_t done, std::uint64_t total, void*) { return done < 10 && total == 50; };

  const VerifyResult result = verify<TypeParam>(bytes, testWiring<TypeParam>(), options);

  EXPECT_TRUE(result.stopped);
  EXPECT_FALSE(result.matches);
}

/// Alters bytes as files are spoilt and as attackers try: flips, numbers, cuts, copies, splices.
void corrupt(Random& random, Bytes& bytes, const Bytes& other) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  const std::uint32_t at = random.below(size);
  const auto from = bytes.begin() + at;
  switch (random.below(8)) {
    case 0:
      bytes[at] ^= static_cast<std::uint8_t>(1u << random.below(8));
      break;
    case 1:
      bytes[at] = static_cast<std::uint8_t>(random.below(256));
      break;
    case 2:
      bytes.resize(at);
      break;
    case 3:
      for (std::uint32_t i = at; i < at + 4 && i < size; ++i) bytes[i] = random.oneIn(4) ? 0x7f : 0xff;
      break;
    case 4:
      bytes.erase(from, from + random.below(size - at));
      break;
    case 5:
      bytes.insert(from, bytes.begin(), bytes.begin() + random.below(64));
      break;
    case 6:
      for (std::uint32_t i = at; i < at + random.below(64) && i < size && i < other.size(); ++i)
        bytes[i] = other[i];
      break;
    default:
      for (std::uint32_t i = at; i < at + 8 && i < size; ++i)
        bytes[i] = static_cast<std::uint8_t>(random.below(256));
      break;
  }
}

/// The hashes of all worlds of a recording, as it claims them.
template <Scalar S>
std::vector<std::uint64_t> claimedHashes(const Bytes& bytes) {
  std::vector<std::uint64_t> hashes;
  RecordingReader<S> reader(bytes);
  hashes.push_back(reader.initialHash());
  for (RecordingItem item = reader.next(); item != RecordingItem::end; item = reader.next()) {
    if (item == RecordingItem::step) hashes.push_back(reader.hash());
  }
  return hashes;
}

/// More rounds by the environment, for a machine that has the time.
std::uint32_t corruptionRounds() {
  const char* more = std::getenv("SAMESTEP_CORRUPTIONS");
  return more == nullptr ? 4000 : static_cast<std::uint32_t>(std::atoi(more));
}

/// Changes what a recording is made of as a forger would, who knows the format: fields of payloads, sections
/// left out, doubled and moved.
void forge(Random& random, Bytes& bytes) {
  by_hand::Recording parts = by_hand::takeApart(bytes);
  const auto any = [&] { return random.below(static_cast<std::uint32_t>(parts.sections.size())); };
  by_hand::Section& section = parts.sections[any()];
  switch (random.below(6)) {
    case 0:
      std::swap(section, parts.sections[any()]);
      break;
    case 1:
      section.payload = parts.sections[any()].payload;
      break;
    case 2:
      parts.sections.erase(parts.sections.begin() + any());
      break;
    case 3:
      section.kind = static_cast<std::uint8_t>(random.below(7) | (random.oneIn(2) ? by_hand::kPacked : 0));
      section.unpacked = random.oneIn(2) ? 0xffffffff : random.below(1u << 20);
      break;
    default:
      if (section.payload.empty()) break;
      section.payload[random.below(static_cast<std::uint32_t>(section.payload.size()))] ^=
          static_cast<std::uint8_t>(1 + random.below(255));
  }
  bytes = by_hand::putTogether(parts, random.oneIn(2));
}

/// One that is taken for good must tell the same history: an input that had no effect, or a shorter match, is
/// all that may have changed.
template <Scalar S>
void corruptAndVerify(const Bytes& original, const Bytes& other, Random& random, std::uint32_t& refused) {
  const std::vector<std::uint64_t> history = claimedHashes<S>(original);
  Bytes bytes = original;
  const bool forged = original[8] != 2 && random.oneIn(3);
  if (forged) forge(random, bytes);
  const std::uint32_t times = forged ? 0 : 1 + random.below(3);
  for (std::uint32_t i = 0; i < times && !bytes.empty(); ++i) corrupt(random, bytes, other);
  const bool mended = forged || random.oneIn(2);
  if (mended && !forged) mendChecksum(bytes);
  if (bytes == original) return;
  VerifyOptions options;
  options.ending = random.oneIn(4) ? Ending::mayBeCut : Ending::whole;
  VerifyResult result;
  try {
    result = verify<S>(bytes, testWiring<S>(), options);
  } catch (const Error&) {
    ++refused;
  }
  if (!result.matches) return;
  ASSERT_TRUE(mended || result.cut);
  RecordingReader<S> reader(bytes, {}, {}, options.ending);
  std::size_t at = 0;
  ASSERT_EQ(reader.initialHash(), history[at++]);
  for (RecordingItem item = reader.next(); item != RecordingItem::end; item = reader.next()) {
    if (item != RecordingItem::step) continue;
    ASSERT_LT(at, history.size());
    ASSERT_EQ(reader.hash(), history[at++]);
  }
}

TYPED_TEST(VerifyTest, NoneOfThousandsOfCorruptionsCrashesOrIsTakenForAnotherHistory) {
  const Bytes plain = recordSmallMatch<TypeParam>(24, {5, 1u << 20});
  std::vector<Bytes> originals = {plain, asVersion2<TypeParam>(plain), recordSmallMatch<TypeParam>()};
  if (packingAvailable()) originals.push_back(recordSmallMatch<TypeParam>(24, {5, 1u << 20}, true));
  Random random(20260721);
  std::uint32_t refused = 0;
  const std::uint32_t rounds = corruptionRounds();
  for (std::uint32_t round = 0; round < rounds; ++round) {
    const Bytes& original = originals[round % originals.size()];
    const Bytes& other = originals[random.below(static_cast<std::uint32_t>(originals.size()))];
    ASSERT_NO_FATAL_FAILURE(corruptAndVerify<TypeParam>(original, other, random, refused)) << round;
  }
  EXPECT_GT(refused, rounds / 3);
}

// Worlds that decode can be stepped: hashes do not protect a reader that has been given worlds made to harm
// it.
TYPED_TEST(VerifyTest, AlteredWorldsThatAreAcceptedCanBeStepped) {
  const Bytes original = recordSmallMatch<TypeParam>();
  const std::size_t commands = hashOffsets<TypeParam>(original)[0];
  Random random(7);
  std::uint32_t stepped = 0;
  for (std::uint32_t round = 0; round < 3000; ++round) {
    Bytes bytes = original;
    const std::uint32_t times = 1 + random.below(4);
    for (std::uint32_t i = 0; i < times; ++i) {
      bytes[28 + random.below(static_cast<std::uint32_t>(commands) - 28)] =
          static_cast<std::uint8_t>(random.below(256));
    }
    mendChecksum(bytes);
    try {
      Replay<TypeParam> replay(bytes, testWiring<TypeParam>());
      while (replay.step()) ++stepped;
      replay.space().hash();
    } catch (const Error&) {
      continue;
    }
  }
  EXPECT_GT(stepped, 1000u);
}

/// Expectations of a server that knows recordSmallMatch(20).
template <Scalar S>
Expectations expectationsOfSmallMatch() {
  Space<S> space;
  fillSmall(space);
  Expectations expected;
  expected.firstHash = space.hash();
  expected.stepsPerSecond = 64;
  expected.scalar = ScalarTraits<S>::kKind;
  expected.ticks = 20;
  expected.firstTick = 0;
  return expected;
}

TYPED_TEST(VerifyTest, AMatchAsExpectedMatches) {
  VerifyOptions options;
  options.expected = expectationsOfSmallMatch<TypeParam>();

  const VerifyResult result =
      verify<TypeParam>(recordSmallMatch<TypeParam>(20), testWiring<TypeParam>(), options);

  EXPECT_TRUE(result.matches);
  EXPECT_EQ(result.unexpected, nullptr);
}

TYPED_TEST(VerifyTest, EachExpectationThatIsNotMetIsNamed) {
  const Bytes bytes = recordSmallMatch<TypeParam>(20);
  const auto unexpected = [&](auto&& change) {
    VerifyOptions options;
    options.expected = expectationsOfSmallMatch<TypeParam>();
    change(options.expected);
    const VerifyResult result = verify<TypeParam>(bytes, testWiring<TypeParam>(), options);
    EXPECT_FALSE(result.matches);
    return std::string(result.unexpected != nullptr ? result.unexpected : "nothing");
  };

  EXPECT_EQ(unexpected([](Expectations& e) { *e.firstHash ^= 1; }), "the first world");
  EXPECT_EQ(unexpected([](Expectations& e) { e.stepsPerSecond = 30; }), "the time step");
  EXPECT_EQ(unexpected([](Expectations& e) { e.ticks = 21; }), "the number of steps");
  EXPECT_EQ(unexpected([](Expectations& e) { e.firstTick = 1; }), "the step it begins after");
  EXPECT_EQ(unexpected([](Expectations& e) {
              e.scalar = *e.scalar == ScalarKind::fixed ? ScalarKind::float64 : ScalarKind::fixed;
            }),
            "the scalar");
}

TYPED_TEST(VerifyTest, ACommandThatNoPlayerMayGiveIsNamedWithItsOffset) {
  const Bytes bytes = recordSmallMatch<TypeParam>(20);
  for (std::uint32_t kind = 0; kind < kCommandKinds; ++kind) {
    VerifyOptions options;
    options.expected.commands &= ~(1u << kind);
    const VerifyResult result = verify<TypeParam>(bytes, testWiring<TypeParam>(), options);
    ASSERT_NE(result.unexpected, nullptr) << kind;
    EXPECT_FALSE(result.matches);
    EXPECT_EQ(result.unexpected, std::string("a command: ") + commandName(static_cast<CommandKind>(kind)));
    std::uint64_t offset = result.unexpectedOffset;
    EXPECT_EQ(kindOf(RecordingReader<TypeParam>::commandAt(bytes, offset)), static_cast<CommandKind>(kind));
  }
}

TYPED_TEST(VerifyTest, AMatchThatBeginsAfterMoreStepsThanAllowedIsRefused) {
  Space<TypeParam> space;
  fillSmall(space);
  for (int i = 0; i < 5; ++i) space.step(kTick<TypeParam>);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);
  recorder.step();
  recorder.finish();
  VerifyOptions options;
  options.mostFirstTick = 5;
  EXPECT_TRUE(verify<TypeParam>(bytes, testWiring<TypeParam>(), options).matches);
  options.mostFirstTick = 4;
  EXPECT_THROW(verify<TypeParam>(bytes, testWiring<TypeParam>(), options), FormatError);
}

TEST(VerifyAnyTest, TheScalarIsReadFromTheRecording) {
  Space<Fixed> space;
  fillSmall(space);
  Bytes bytes;
  Recorder<Fixed> recorder(space, kTick<Fixed>, bytes);
  for (int i = 0; i < 10; ++i) recorder.step();
  recorder.finish();

  EXPECT_TRUE(verify(bytes).matches);
}

}  // namespace
}  // namespace samestep
