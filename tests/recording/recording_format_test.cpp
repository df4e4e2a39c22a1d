// SPDX-License-Identifier: MIT
// Sections, keyframes, index, claims, notes and packing of recordings, and what is refused of them.
#include <samestep/recorder.h>
#include <samestep/recording.h>
#include <samestep/scene.h>
#include <samestep/verify.h>
#include <samestep/version.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#ifdef SAMESTEP_ZSTD
#include <zstd.h>
#endif

#include "support/recordings.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class RecordingFormatTest : public ::testing::Test {
 protected:
  static constexpr KeyframeBudget kEveryFour{4, 1u << 20};

  /// Complaint of a reader that refuses it, and where; empty where it does not.
  static std::string complaint(const Bytes& bytes, std::uint64_t* offset = nullptr) {
    try {
      RecordingReader<S> reader(bytes);
      return {};
    } catch (const FormatError& error) {
      if (offset != nullptr) *offset = error.offset();
      return error.what();
    }
  }
  static VerifyResult verified(const Bytes& bytes, Ending ending = Ending::whole) {
    VerifyOptions options;
    options.ending = ending;
    return verify<S>(bytes, testWiring<S>(), options);
  }
  /// Each item, as text: what is told, whatever the format.
  static std::vector<std::string> itemsOf(const Bytes& bytes) {
    std::vector<std::string> items;
    RecordingReader<S> reader(bytes);
    for (RecordingItem item = reader.next(); item != RecordingItem::end; item = reader.next()) {
      const auto from = reader.items().begin();
      items.emplace_back(from + static_cast<std::ptrdiff_t>(reader.itemAt()),
                         from + static_cast<std::ptrdiff_t>(reader.nextAt()));
    }
    return items;
  }
  /// The places of its sections.
  static std::vector<std::size_t> placesOf(const by_hand::Recording& parts) {
    std::vector<std::size_t> places;
    std::size_t at = by_hand::kHeaderBytes;
    for (const by_hand::Section& section : parts.sections) {
      places.push_back(at);
      at += ((section.kind & by_hand::kPacked) != 0 ? 9 : 5) + section.payload.size() + 8;
    }
    return places;
  }
  static std::size_t find(const by_hand::Recording& parts, std::uint8_t kind, std::size_t nth = 0) {
    for (std::size_t i = 0; i < parts.sections.size(); ++i) {
      if (parts.sections[i].kind == kind && nth-- == 0) return i;
    }
    return parts.sections.size();
  }
};
TYPED_TEST_SUITE(RecordingFormatTest, AllScalars);

TYPED_TEST(RecordingFormatTest, KeyframesStandWhereTheBudgetSaysAndAreTheWorldsThere) {
  const Bytes bytes = recordSmallMatch<TypeParam>(24, this->kEveryFour);
  RecordingReader<TypeParam> reader(bytes);

  ASSERT_EQ(reader.keyframes().size(), 7u);
  Replay<TypeParam> replay(bytes, testWiring<TypeParam>());
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(reader.keyframes()[i].tick, 4 * i);
    while (replay.tick() < 4 * i) replay.step();
    EXPECT_EQ(reader.keyframes()[i].hash, replay.space().hash());
    EXPECT_TRUE(reader.isWorld(i, replay.space().state()));
    Space<TypeParam> space;
    registerNamedHandlers(space);
    space.adopt(reader.world(i));
    EXPECT_EQ(space.hash(), replay.space().hash());
  }
  EXPECT_TRUE(this->verified(bytes).matches);
}

TYPED_TEST(RecordingFormatTest, KeyframesTakeNoMoreThanTheirShare) {
  Scene<TypeParam> scene(SceneSource::find("stack"));
  Bytes bytes;
  Recorder<TypeParam> recorder(scene.space(), scene.timeStep(), bytes);
  std::uint64_t commandBytes = 0;
  const std::size_t start = bytes.size();
  // Sooner than usual, but with the usual share.
  recorder.setKeyframes({100, KeyframeBudget{}.bytesPerTick});
  constexpr std::uint64_t kTicks = 600;
  for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
    while (const Command<TypeParam>* command = scene.nextCommand()) recorder.apply(*command);
    recorder.step();
  }
  recorder.finish();
  RecordingReader<TypeParam> reader(bytes);
  EXPECT_GE(reader.keyframes().size(), 2u);
  for (RecordingItem item = reader.next(); item != RecordingItem::end; item = reader.next()) {
    if (item == RecordingItem::command) commandBytes += reader.nextAt() - reader.itemAt();
  }

  EXPECT_LT(bytes.size() - start - commandBytes, 40 * kTicks);
}

TYPED_TEST(RecordingFormatTest, CutAnywhereItIsPlayedToItsLastWholeTick) {
  const Bytes bytes = recordSmallMatch<TypeParam>(24, this->kEveryFour);
  std::uint64_t last = 0;
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    std::uint64_t ticks = 0;
    try {
      RecordingReader<TypeParam> reader(cut, {}, {}, Ending::mayBeCut);
      ticks = reader.ticks();
      EXPECT_FALSE(reader.isWhole());
    } catch (const FormatError& error) {
      ASSERT_EQ(last, 0u) << length << ": " << error.what();
    }
    // A tick more at a time, once its hash is there.
    ASSERT_GE(ticks, last);
    ASSERT_LE(ticks, last + 1);
    if (ticks == last) continue;
    last = ticks;
    const VerifyResult result = this->verified(cut, Ending::mayBeCut);
    EXPECT_TRUE(result.matches && result.cut) << length;
    EXPECT_EQ(result.ticks, ticks);
  }
  EXPECT_EQ(last, 24u);
  EXPECT_FALSE(this->verified(bytes, Ending::mayBeCut).cut);
}

TYPED_TEST(RecordingFormatTest, WhatTheSinkHasAtAnyTimeCanBePlayed) {
  Space<TypeParam> space;
  fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes, testWiring<TypeParam>());
  recorder.setRewindTicks(2);
  for (int i = 0; i < 600; ++i) recorder.step();

  const VerifyResult result = this->verified(bytes, Ending::mayBeCut);

  EXPECT_TRUE(result.matches && result.cut);
  EXPECT_EQ(result.ticks, 480u);
}

#ifdef SAMESTEP_ZSTD
TYPED_TEST(RecordingFormatTest, PackedItTellsTheSame) {
  const Bytes plain = recordSmallMatch<TypeParam>(24, this->kEveryFour);
  const Bytes packed = recordSmallMatch<TypeParam>(24, this->kEveryFour, true);

  EXPECT_LT(packed.size(), plain.size());
  EXPECT_EQ(this->itemsOf(packed), this->itemsOf(plain));
  EXPECT_TRUE(this->verified(packed).matches);
  std::uint64_t last = 0;
  for (std::size_t length = 0; length < packed.size(); ++length) {
    const Bytes cut(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(length));
    try {
      const std::uint64_t ticks = RecordingReader<TypeParam>(cut, {}, {}, Ending::mayBeCut).ticks();
      EXPECT_GE(ticks, last);
      last = ticks;
    } catch (const FormatError&) {
      ASSERT_EQ(last, 0u);
    }
  }
}

Bytes zstdOf(const Bytes& plain) {
  Bytes packed(ZSTD_compressBound(plain.size()));
  packed.resize(ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), 19));
  return packed;
}

TYPED_TEST(RecordingFormatTest, WhatUnpacksToMoreOrElseThanItSaysIsRefused) {
  const by_hand::Recording good = by_hand::takeApart(recordSmallMatch<TypeParam>(3));
  const auto refused = [&](const Bytes& payload, std::uint32_t unpacked) {
    by_hand::Recording parts = good;
    parts.sections[1] = {by_hand::kTicks | by_hand::kPacked, unpacked, payload};
    return this->complaint(by_hand::putTogether(parts));
  };
  const Bytes items = good.sections[1].payload;
  const Bytes packed = zstdOf(items);
  const auto size = static_cast<std::uint32_t>(items.size());
  EXPECT_EQ(refused(packed, size), "");

  // 60 MB of nothing in some KB.
  const Bytes bomb = zstdOf(Bytes(60u << 20, 0));
  EXPECT_EQ(refused(bomb, 60u << 20), "unpacks to more than is allowed");
  EXPECT_EQ(refused(bomb, size), "not one whole zstd frame of the size it should have");
  EXPECT_EQ(refused(packed, 0xffffffffu), "unpacks to more than is allowed");
  EXPECT_EQ(refused(packed, 0), "unpacks to more than is allowed");
  for (const std::uint32_t wrong : {size - 1, size + 1}) {
    EXPECT_EQ(refused(packed, wrong), "not one whole zstd frame of the size it should have");
  }
  Bytes twice = packed;
  twice.insert(twice.end(), packed.begin(), packed.end());
  EXPECT_EQ(refused(twice, size), "not one whole zstd frame of the size it should have");
  EXPECT_EQ(refused({1, 2, 3}, size), "not one whole zstd frame of the size it should have");
  Bytes shorter = packed;
  shorter.pop_back();
  EXPECT_NE(refused(shorter, size), "");
}
#else
TYPED_TEST(RecordingFormatTest, WithoutZstdPackingIsRefusedByName) {
  Space<TypeParam> space;
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes);
  EXPECT_THROW(recorder.setPacking(true), ValueOutOfRange);
  by_hand::Recording parts = by_hand::takeApart(recordSmallMatch<TypeParam>(3));
  parts.sections[1].kind |= by_hand::kPacked;
  EXPECT_EQ(this->complaint(by_hand::putTogether(parts)), "packed by zstd, which this build lacks");
}
#endif

TYPED_TEST(RecordingFormatTest, ABrokenChainIsFoundInItsSection) {
  const by_hand::Recording parts = by_hand::takeApart(recordSmallMatch<TypeParam>(24, this->kEveryFour));
  const Bytes bytes = by_hand::putTogether(parts);
  const std::vector<std::size_t> places = this->placesOf(parts);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t end = i + 1 < places.size() ? places[i + 1] : bytes.size();
    Bytes altered = bytes;
    altered[end - 1] ^= 1;
    std::uint64_t offset = 0;
    EXPECT_EQ(this->complaint(altered, &offset), "the chain is broken: the bytes were altered");
    EXPECT_EQ(offset, end - 8);
  }
}

TYPED_TEST(RecordingFormatTest, AFalseIndexIsRefusedAtItsPlace) {
  const by_hand::Recording good = by_hand::takeApart(recordSmallMatch<TypeParam>(24, this->kEveryFour));
  const std::size_t index = this->find(good, by_hand::kIndex);
  const std::size_t payload = this->placesOf(good)[index] + 5;
  ASSERT_EQ(good.sections[index].payload.size(), 7u * 24);
  for (std::size_t i = 0; i < 7 * 24; ++i) {
    by_hand::Recording parts = good;
    parts.sections[index].payload[i] ^= 1;
    std::uint64_t offset = 0;
    EXPECT_EQ(this->complaint(by_hand::putTogether(parts, false), &offset), "the index is false") << i;
    EXPECT_EQ(offset, payload + i / 24 * 24);
  }
  by_hand::Recording parts = good;
  parts.sections[index].payload.resize(6 * 24);
  EXPECT_EQ(this->complaint(by_hand::putTogether(parts)), "the index has another number of keyframes");
  parts = good;
  std::swap(parts.sections[index], parts.sections[index + 1]);
  EXPECT_EQ(this->complaint(by_hand::putTogether(parts)), "an end without an index");
  parts = good;
  parts.sections[index + 1].payload[8] ^= 1;
  EXPECT_EQ(this->complaint(by_hand::putTogether(parts, false)), "the index is elsewhere");
}

TYPED_TEST(RecordingFormatTest, AKeyframeIsNeverTakenForWhatItSays) {
  const by_hand::Recording good = by_hand::takeApart(recordSmallMatch<TypeParam>(24, this->kEveryFour));
  const std::size_t second = this->find(good, by_hand::kKeyframe, 2);
  const std::size_t third = this->find(good, by_hand::kKeyframe, 3);
  // The tick it stands for, the hash.
  by_hand::Recording parts = good;
  parts.sections[second].payload[0] ^= 1;
  EXPECT_EQ(this->complaint(by_hand::putTogether(parts)),
            "a keyframe stands after another tick than it says");
  parts = good;
  parts.sections[second].payload[8] ^= 1;
  EXPECT_EQ(this->complaint(by_hand::putTogether(parts)),
            "a keyframe has another hash than the tick it stands after");

  // Another world under the right hash, which a reader refuses when it is asked for it, and verify at once.
  parts = good;
  Bytes& world = parts.sections[second].payload;
  world.resize(16);
  world.insert(world.end(), good.sections[third].payload.begin() + 16, good.sections[third].payload.end());
  Bytes bytes = by_hand::putTogether(parts);
  ASSERT_EQ(this->complaint(bytes), "");
  EXPECT_THROW(RecordingReader<TypeParam>(bytes).world(2), FormatError);
  VerifyResult result = this->verified(bytes);
  EXPECT_FALSE(result.matches);
  EXPECT_TRUE(result.keyframeDiffers);
  EXPECT_EQ(result.firstWrongTick, 8u);

  // The hash of its tick is forged with it: a lie all of a piece, which only playing finds.
  for (std::size_t i = 0; i < 8; ++i) {
    const std::uint8_t byte = good.sections[third].payload[8 + i];
    parts.sections[second].payload[8 + i] = byte;
    Bytes& items = parts.sections[second - 1].payload;
    items[items.size() - 8 + i] = byte;
  }
  bytes = by_hand::putTogether(parts);
  EXPECT_NO_THROW(RecordingReader<TypeParam>(bytes).world(2));
  result = this->verified(bytes);
  EXPECT_FALSE(result.matches);
  EXPECT_EQ(result.firstWrongTick, 8u);
}

TYPED_TEST(RecordingFormatTest, SectionsOutOfPlaceAreRefused) {
  const by_hand::Recording good = by_hand::takeApart(recordSmallMatch<TypeParam>(24, this->kEveryFour));
  const auto refused = [&](auto&& change) {
    by_hand::Recording parts = good;
    change(parts.sections);
    return this->complaint(by_hand::putTogether(parts));
  };
  using Sections = std::vector<by_hand::Section>;
  EXPECT_EQ(refused([](Sections& s) { s.erase(s.begin()); }), "a recording begins with its first world");
  EXPECT_EQ(refused([](Sections& s) { std::swap(s[0], s[1]); }), "a recording begins with its first world");
  EXPECT_EQ(refused([](Sections& s) { s.erase(s.begin() + 1); }),
            "a keyframe stands after another tick than it says");
  EXPECT_EQ(refused([](Sections& s) { s.insert(s.begin() + 2, s[2]); }),
            "a keyframe stands after another tick than it says");
  EXPECT_EQ(refused([](Sections& s) { s.push_back(s[1]); }), "something follows the end");
  EXPECT_EQ(refused([](Sections& s) { s.pop_back(); }), "cut short: a section goes beyond the end");
  EXPECT_EQ(refused([](Sections& s) { s[1].kind = 6; }), "unknown section");
  EXPECT_EQ(refused([](Sections& s) { s[1].kind = 0; }), "unknown section");
  EXPECT_EQ(refused([](Sections& s) { s.back().kind |= by_hand::kPacked; }),
            "a section that is never packed");
  EXPECT_EQ(refused([](Sections& s) { s.back().payload[0] ^= 1; }), "the number of steps is another");
  EXPECT_EQ(refused([](Sections& s) { s[1].payload[0] = 2; }), "no item of a recording");
}

TYPED_TEST(RecordingFormatTest, ClaimsAndNotesAreReadAsTheyWereWritten) {
  Space<TypeParam> space;
  fillSmall(space);
  Bytes bytes;
  Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes, testWiring<TypeParam>());
  recorder.note("level", "foundry");
  recorder.claim("start", "yes");
  recorder.step();
  recorder.step();
  recorder.apply(UserInput{{5}});
  // It is of the world after the step before the input.
  recorder.claim("score", std::string_view("\0\1", 2));
  recorder.note("empty", "");
  recorder.step();
  recorder.finish();

  Replay<TypeParam> replay(bytes, testWiring<TypeParam>());
  std::vector<std::string> told;
  do {
    while (const Claim* claim = replay.nextClaim()) {
      told.push_back(std::to_string(replay.tick()) + std::string(claim->key) +
                     std::to_string(claim->value.size()));
    }
  } while (replay.step());
  EXPECT_EQ(told, (std::vector<std::string>{"0start3", "2score2"}));
  const std::vector<Note> notes = replay.reader().notes();
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0].key, "level");
  EXPECT_EQ(notes[0].value, "foundry");
  EXPECT_EQ(notes[1].value, "");
  EXPECT_EQ(this->verified(bytes).claimsUnknown, 2u);
  EXPECT_THROW(recorder.claim("", "x"), ValueOutOfRange);
  EXPECT_THROW(recorder.claim(std::string(256, 'k'), "x"), ValueOutOfRange);
  EXPECT_THROW(recorder.claim("k", std::string(4097, 'v')), ValueOutOfRange);
  EXPECT_THROW(recorder.note("k", std::string(65537, 'v')), ValueOutOfRange);
}

TYPED_TEST(RecordingFormatTest, AFalseClaimIsToldWithItsTick) {
  const auto match = [](const char* bodies) {
    Space<TypeParam> space;
    fillSmall(space);
    Bytes bytes;
    Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes, testWiring<TypeParam>());
    for (int i = 0; i < 3; ++i) recorder.step();
    recorder.claim("samestep.hash", namedClaim(space, "samestep.hash"));
    recorder.claim("samestep.bodies", bodies);
    recorder.claim("samestep.user-data.99", "0");
    recorder.step();
    recorder.finish();
    return bytes;
  };
  const VerifyResult result = this->verified(match("17"));

  EXPECT_FALSE(result.matches);
  EXPECT_EQ(result.claimsThatHold, 1u);
  EXPECT_EQ(result.claimsThatAreFalse, 2u);
  ASSERT_TRUE(result.falseClaim);
  EXPECT_EQ(result.falseClaim->tick, 3u);
  EXPECT_EQ(result.falseClaim->key, "samestep.bodies");
  EXPECT_EQ(result.falseClaim->value, (Bytes{'1', '7'}));
  EXPECT_EQ(result.recordedHash, result.computedHash);
}

TYPED_TEST(RecordingFormatTest, ClaimsAndKeyframesAreTakenBackWithTheirSteps) {
  const auto match = [](bool guesses) {
    Space<TypeParam> space;
    const BodyId player = fillSmall(space);
    Bytes bytes;
    Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes, testWiring<TypeParam>());
    recorder.setKeyframes({5, 1u << 20});
    SavedSpace<TypeParam> saved;
    for (int tick = 0; tick < 300; ++tick) {
      space.save(saved);
      for (int guess = 0; guesses && guess < 12; ++guess) {
        recorder.apply(ApplyImpulse<TypeParam>{player, {TypeParam(guess), TypeParam(0)}, {}});
        recorder.step();
        recorder.claim("lap", "wrong");
      }
      if (guesses) space.restore(saved);
      recorder.step();
      if (tick % 7 == 0) recorder.claim("lap", std::to_string(tick));
      if (guesses) recorder.confirm(recorder.ticks() > 3 ? recorder.ticks() - 3 : 0);
    }
    recorder.finish();
    return bytes;
  };

  EXPECT_EQ(match(true), match(false));
}

TYPED_TEST(RecordingFormatTest, EachTickCanBeSought) {
  const Bytes bytes = recordSmallMatch<TypeParam>(24, this->kEveryFour);
  Replay<TypeParam> straight(bytes, testWiring<TypeParam>());
  std::vector<std::uint64_t> hashes;
  do {
    hashes.push_back(straight.space().hash());
  } while (straight.step());
  Replay<TypeParam> replay(bytes, testWiring<TypeParam>());
  for (std::uint64_t from = 0; from <= 24; ++from) {
    for (std::uint64_t to = 0; to <= 24; to += 3) {
      replay.seek(from);
      if (to % 2 == 0) replay.applyCommands();
      replay.seek(to);
      ASSERT_EQ(replay.tick(), to);
      ASSERT_EQ(replay.space().hash(), hashes[to]) << from << " to " << to;
      ASSERT_EQ(replay.recordedHash(), hashes[to]);
    }
  }
  EXPECT_THROW(replay.seek(25), ValueOutOfRange);
  for (const std::uint64_t to : {24u, 3u, 9u, 0u}) {
    const Bytes oldBytes = asVersion2<TypeParam>(bytes);
    Replay<TypeParam> again(oldBytes, testWiring<TypeParam>());
    again.seek(24);
    again.seek(to);
    EXPECT_EQ(again.space().hash(), hashes[to]);
  }
}

TYPED_TEST(RecordingFormatTest, VersionTwoTellsTheSame) {
  const Bytes bytes = recordSmallMatch<TypeParam>(24, this->kEveryFour);
  const Bytes old = asVersion2<TypeParam>(bytes);
  ASSERT_EQ(recordingInfo(old).version, 2u);
  const VerifyResult result = this->verified(old);

  EXPECT_TRUE(result.matches);
  EXPECT_EQ(result.ticks, 24u);
  EXPECT_EQ(result.computedHash, this->verified(bytes).computedHash);
  for (std::size_t length = 0; length < old.size(); ++length) {
    const Bytes cut(old.begin(), old.begin() + static_cast<std::ptrdiff_t>(length));
    ASSERT_NE(this->complaint(cut), "") << length;
  }
}

template <Scalar S>
void expectRead(Bytes bytes, const std::string& name) {
  const std::uint32_t revision = recordingInfo(bytes).revision;
  by_hand::setNumber(bytes, 12, kSimulationRevision, 4);
  mendRecording(bytes);
  EXPECT_GE(RecordingReader<S>(bytes).ticks(), 60u) << name;
  if (revision == kSimulationRevision) {
    EXPECT_TRUE(verify<S>(bytes, testWiring<S>()).matches) << name;
  }
}

TEST(RecordingFilesTest, EveryVersionFromTwoOnIsRead) {
  std::uint32_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SAMESTEP_RECORDINGS)) {
    const std::string name = entry.path().filename().string();
    if (name == "README.md") continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    const Bytes bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    EXPECT_EQ(std::to_string(recordingInfo(bytes).version), name.substr(0, name.find('.')));
    ++files;
    if (recordingInfo(bytes).scalar == ScalarKind::fixed) {
      expectRead<Fixed>(bytes, name);
    } else if constexpr (ScalarTraits<double>::kSupported) {
      expectRead<double>(bytes, name);
    }
  }
  EXPECT_GE(files, 8u);
}

}  // namespace
}  // namespace samestep
