// SPDX-License-Identifier: MIT
#include "session/input_stream.h"

#include <array>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace samestep::lockstep {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes copyOf(std::span<const std::uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

InputStream filled(Tick first, Tick count, std::uint64_t seed) {
  InputStream stream(8, 16);
  stream.reset(first);
  std::mt19937_64 random(seed);
  Bytes held(4, 0);
  for (Tick i = 0; i < count; ++i) {
    if (random() % 3 == 0) held.assign(random() % 9, static_cast<std::uint8_t>(random()));
    // Often a byte or two of several.
    for (int change = 0; change < 2 && !held.empty() && random() % 3 == 0; ++change) {
      held[random() % held.size()] = static_cast<std::uint8_t>(random());
    }
    const Bytes commands(random() % 5 == 0 ? random() % 17 : 0, static_cast<std::uint8_t>(random()));
    stream.append({held, commands, i + 1 == count && random() % 2 == 0 ? Control::leave : Control::none});
  }
  return stream;
}

TEST(InputStreamTest, KeepsWhatCameLastForItsCapacity) {
  const InputStream stream = filled(5, 300, 1);

  EXPECT_FALSE(stream.has(5 + 300 - InputStream::kCapacity - 1));
  EXPECT_TRUE(stream.has(5 + 300 - InputStream::kCapacity));
  EXPECT_TRUE(stream.has(304));
  EXPECT_FALSE(stream.has(305));
}

TEST(InputStreamTest, OfAnInputInWhichOneByteChangesOnlyThatIsSent) {
  InputStream stream(8, 16);
  stream.reset(0);
  const Bytes first{1, 2, 3, 4, 5, 6, 7, 8}, second{1, 2, 3, 9, 5, 6, 7, 8};
  stream.append({first, {}, Control::none});
  stream.append({second, {}, Control::none});
  std::array<std::uint8_t, 64> bytes;
  PacketWriter writer(bytes);
  encodeEntries(writer, stream, 1, 2);

  EXPECT_EQ(copyOf(writer.written()), (Bytes{0, 1u << 3, 9}));
}

TEST(InputStreamTest, EveryRunOfInputsSurvivesAPacket) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const InputStream sent = filled(3, 40, seed);
    InputStream received(8, 16);
    received.reset(3);
    Tick wrong = 0xffffffffu;

    while (received.end() < sent.end()) {
      // Some that it has already come along.
      const Tick base = received.end() - std::min<Tick>(received.end() - 3, static_cast<Tick>(seed % 4));
      std::array<std::uint8_t, 120> bytes;
      PacketWriter writer(bytes);
      ASSERT_GT(encodeEntries(writer, sent, base, sent.end()), received.end());
      PacketReader reader(writer.written());
      ASSERT_TRUE(decodeEntries(reader, received, base, 1000, wrong));
    }

    for (Tick tick = 3; tick < sent.end(); ++tick) {
      EXPECT_EQ(copyOf(received.at(tick).held), copyOf(sent.at(tick).held));
      EXPECT_EQ(copyOf(received.at(tick).commands), copyOf(sent.at(tick).commands));
      EXPECT_EQ(received.at(tick).control, sent.at(tick).control);
    }
    EXPECT_EQ(wrong, 0xffffffffu);
  }
}

TEST(InputStreamTest, AHeldButtonCostsOneByteForManyTicks) {
  InputStream stream(8, 16);
  const Bytes held{1, 2, 3, 4};
  for (int i = 0; i < 20; ++i) stream.append({held, {}});
  std::array<std::uint8_t, 100> bytes;
  PacketWriter writer(bytes);

  encodeEntries(writer, stream, 5, 20);

  EXPECT_EQ(writer.size(), 1u);
}

TEST(InputStreamTest, TellsWhereAStepWasMadeWithAnotherInput) {
  InputStream stream(8, 16);
  const Bytes a{1}, b{2};
  stream.append({a, {}});
  for (Tick tick = 1; tick < 4; ++tick) stream.predict(tick, stream.heldBefore(tick));

  EXPECT_TRUE(stream.append({a, {}}));
  EXPECT_FALSE(stream.append({b, {}}));
  // A command is never predicted.
  EXPECT_FALSE(stream.append({a, b}));
}

TEST(InputStreamTest, APredictionIsWhatWasHeldLast) {
  InputStream stream(8, 16);
  EXPECT_TRUE(stream.heldBefore(7).empty());
  const Bytes held{9};
  stream.append({held, {}});

  EXPECT_EQ(copyOf(stream.heldBefore(7)), held);
  EXPECT_TRUE(stream.heldBefore(0).empty());
}

TEST(InputStreamTest, NoBytesLeadPastTheLimits) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 20'000; ++i) {
    Bytes bytes(random() % 40);
    for (std::uint8_t& byte : bytes)
      byte = static_cast<std::uint8_t>(random() % (random() % 2 == 0 ? 256 : 12));
    InputStream stream(8, 16);
    stream.reset(10);
    Tick wrong = 0xffffffffu;
    PacketReader reader(bytes);

    decodeEntries(reader, stream, 10, 50, wrong);

    ASSERT_LE(stream.end(), 50u);
    for (Tick tick = 10; tick < stream.end(); ++tick) {
      ASSERT_LE(stream.at(tick).held.size(), 8u);
      ASSERT_LE(stream.at(tick).commands.size(), 16u);
    }
  }
}

TEST(InputStreamTest, APacketOfWhatIsLongForgottenChangesNothing) {
  InputStream stream = filled(0, 500, 3);
  const Bytes bytes{1 << 2};
  PacketReader reader(bytes);
  Tick wrong = 0xffffffffu;

  EXPECT_TRUE(decodeEntries(reader, stream, 3, 1000, wrong));

  EXPECT_EQ(stream.end(), 500u);
}

}  // namespace
}  // namespace samestep::lockstep
