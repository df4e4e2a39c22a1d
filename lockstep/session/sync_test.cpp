// SPDX-License-Identifier: MIT
#include <samestep/error.h>
#include <samestep/sync_test.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace samestep {
namespace {

/// The inputs of one tick, with bytes of their own.
struct KeptInputs {
  std::array<PlayerInput, kMaxPlayers> players;
  std::array<std::array<std::uint8_t, 2 * SyncTest::kMaxBytes>, kMaxPlayers> bytes;
  std::uint32_t count = 0;

  void keep(std::span<const PlayerInput> inputs) {
    count = static_cast<std::uint32_t>(inputs.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      std::uint8_t* held = bytes[i].data();
      std::uint8_t* commands = held + SyncTest::kMaxBytes;
      std::copy(inputs[i].held.begin(), inputs[i].held.end(), held);
      std::copy(inputs[i].commands.begin(), inputs[i].commands.end(), commands);
      players[i] = {inputs[i].present, {held, inputs[i].held.size()}, {commands, inputs[i].commands.size()}};
    }
  }
};

}  // namespace

struct SyncTest::Impl {
  // The states after each step of the first time, by tick, and one for that of the second time.
  static constexpr std::uint32_t kRing = kMaxDistance + 1;
  static constexpr std::uint32_t kAgain = kRing;
  static_assert(kAgain < kSaveSlots);

  void step(Tick at) {
    const KeptInputs& kept = inputs[at % kRing];
    game.step({at, {kept.players.data(), kept.count}}, game.data);
  }
  bool differs(Tick after);

  Game game;
  Tick distance = 1;
  Tick tick = 0;
  bool good = true;
  Report report;
  std::array<KeptInputs, kRing> inputs;
  std::array<std::uint64_t, kRing> hashes{};
};

/// True if the state is another one than the first time after so many steps.
bool SyncTest::Impl::differs(Tick after) {
  const std::uint64_t hash = game.hash(game.data);
  bool other = hash != hashes[after % kRing];
  char text[sizeof report.text] = {};
  if (game.difference != nullptr) {
    game.save(kAgain, game.data);
    other |= game.difference(after % kRing, kAgain, std::span<char>(text), game.data);
  }
  if (!other) return false;
  report.tick = after - 1;
  report.first = hashes[after % kRing];
  report.again = hash;
  std::memcpy(report.text, text, sizeof text);
  report.text[sizeof text - 1] = 0;
  good = false;
  return true;
}

SyncTest::SyncTest(const Game& game, Tick distance) : impl_(nullptr) {
  require<Fault::ValueOutOfRange>(
      game.save != nullptr && game.load != nullptr && game.step != nullptr && game.hash != nullptr,
      "A game lacks one of its four functions.");
  require<Fault::ValueOutOfRange>(distance >= 1 && distance <= kMaxDistance,
                                  "A sync test takes back 1 to 8 steps.");
  impl_ = new Impl;
  impl_->game = game;
  impl_->distance = distance;
  game.save(0, game.data);
}

SyncTest::~SyncTest() { delete impl_; }

bool SyncTest::frame(std::span<const PlayerInput> players) {
  require<Fault::ValueOutOfRange>(players.size() <= kMaxPlayers, "A sync test has 16 players at most.");
  for (const PlayerInput& player : players) {
    require<Fault::ValueOutOfRange>(player.held.size() <= kMaxBytes && player.commands.size() <= kMaxBytes,
                                    "An input of a sync test is longer than 128 bytes.");
  }
  Impl& test = *impl_;
  if (!test.good) return false;
  test.inputs[test.tick % Impl::kRing].keep(players);
  test.step(test.tick);
  ++test.tick;
  test.game.save(test.tick % Impl::kRing, test.game.data);
  test.hashes[test.tick % Impl::kRing] = test.game.hash(test.game.data);

  const Tick from = test.tick - std::min(test.tick, test.distance);
  test.game.load(from % Impl::kRing, test.game.data);
  for (Tick again = from; again < test.tick; ++again) {
    test.step(again);
    if (test.differs(again + 1)) return false;
  }
  return true;
}

bool SyncTest::good() const { return impl_->good; }
const SyncTest::Report& SyncTest::report() const { return impl_->report; }
Tick SyncTest::tick() const { return impl_->tick; }

}  // namespace samestep
