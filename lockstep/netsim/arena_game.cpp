// SPDX-License-Identifier: MIT
#include <samestep/space_game.h>

#include <array>

#include "arena/arena.h"
#include "netsim/random.h"
#include "netsim/sim_game.h"

namespace samestep::netsim {
namespace {

/// The arena of the example. The oracle's players hold numbers and give numbered commands; here they stand
/// for buttons, and now and then for a crate.
class ArenaGame : public SimGame {
 public:
  explicit ArenaGame(std::uint32_t players)
      : arena_(players, players / 3 + 1),
        game_(arena_.space(), ratio<Fixed>(1, 60), apply, &arena_),
        functions_(game_.functions()) {}

  void save(std::uint32_t slot) override { functions_.save(slot, functions_.data); }
  void load(std::uint32_t slot) override { functions_.load(slot, functions_.data); }
  void step(const TickInputs& inputs) override { functions_.step(inputs, functions_.data); }
  std::uint64_t hash() override { return functions_.hash(functions_.data); }
  std::uint64_t write(std::uint32_t slot, std::span<std::uint8_t> into) override {
    return functions_.write(slot, into, functions_.data);
  }
  bool read(std::span<const std::uint8_t> bytes) override { return functions_.read(bytes, functions_.data); }
  void flip() override {
    auto& body = arena_.space().body(arena_.player(0));
    const Vector<Fixed> at = body.position();
    body.setPosition({Fixed::fromRaw(at.x.raw() ^ std::int64_t{1} << 16), at.y});
  }
  const Game* values() override { return &functions_; }
  const char* flipped() const override { return "body 1"; }

 private:
  static void apply(Space<Fixed>& space, const TickInputs& inputs, void* data) {
    std::array<PlayerInput, kMaxPlayers> players{};
    std::array<std::uint8_t, kMaxPlayers> buttons{};
    for (Seat seat = 0; seat < inputs.players.size(); ++seat) {
      const PlayerInput& player = inputs.players[seat];
      players[seat].present = player.present && !player.held.empty();
      if (!players[seat].present) continue;
      buttons[seat] = static_cast<std::uint8_t>(lockstep::mix(player.held[0] + 256u * seat) & 31);
      players[seat].held = {&buttons[seat], 1};
      // The world stays small.
      const bool drops = !player.commands.empty() && player.commands[0] % 8 == 1;
      if (drops) players[seat].commands = {&arena::kDropCrate, 1};
    }
    arena::Arena<Fixed>::applyInputs(space, {inputs.tick, {players.data(), inputs.players.size()}}, data);
  }

  arena::Arena<Fixed> arena_;
  SpaceGame<Fixed> game_;
  Game functions_;
};

}  // namespace

std::unique_ptr<SimGame> makeArenaGame(std::uint32_t players) { return std::make_unique<ArenaGame>(players); }

}  // namespace samestep::netsim
