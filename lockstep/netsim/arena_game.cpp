// SPDX-License-Identifier: MIT
#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>
#include <samestep/space_game.h>

#include <algorithm>
#include <array>

#include "netsim/random.h"
#include "netsim/sim_game.h"

namespace samestep::netsim {
namespace {

constexpr int kSize = 12;
constexpr int kCrates = 6;

/// Discs that players push about between four walls, among crates. What a command says is a crate dropped in
/// at a place; what is held is a direction.
class ArenaGame : public SimGame {
 public:
  ArenaGame() : game_(space_, ratio<Fixed>(1, 60), apply, this), functions_(game_.functions()) {
    space_.setGravity({Fixed(0), Fixed(0)});
    space_.setDamping(ratio<Fixed>(1, 4));
    const Fixed far(kSize);
    const Vector<Fixed> corners[] = {{-far, -far}, {far, -far}, {far, far}, {-far, far}};
    for (int i = 0; i < 4; ++i) {
      space_.add(
          segmentShape<Fixed>(space_.staticBody(), corners[i], corners[(i + 1) % 4], ratio<Fixed>(1, 2)));
    }
    for (Seat seat = 0; seat < kMaxPlayers; ++seat) {
      players_[seat] = place({Fixed(seat % 4 * 3 - 4), Fixed(seat / 4 * 3 - 4)});
      Shape<Fixed> disc = circleShape<Fixed>(players_[seat], ratio<Fixed>(1, 2));
      disc.setMass(Fixed(1));
      space_.add(disc);
    }
    for (int i = 0; i < kCrates; ++i) dropCrate({Fixed(2 * i - 6), Fixed(9 - i % 2)});
  }

  void save(std::uint32_t slot) override { functions_.save(slot, functions_.data); }
  void load(std::uint32_t slot) override { functions_.load(slot, functions_.data); }
  void step(const TickInputs& inputs) override { functions_.step(inputs, functions_.data); }
  std::uint64_t hash() override { return functions_.hash(functions_.data); }
  void flip() override {
    auto& body = space_.body(players_[0]);
    body.setPosition(body.position() + Vector<Fixed>{Fixed::fromRaw(1), Fixed(0)});
  }

 private:
  BodyId place(const Vector<Fixed>& position) {
    Body<Fixed> body;
    body.setPosition(position);
    return space_.add(body);
  }
  void dropCrate(const Vector<Fixed>& position) {
    Shape<Fixed> crate = boxShape<Fixed>(place(position), ratio<Fixed>(4, 5), ratio<Fixed>(4, 5));
    crate.setMass(ratio<Fixed>(1, 2));
    crate.setFriction(ratio<Fixed>(1, 2));
    space_.add(crate);
  }
  static void apply(Space<Fixed>& space, const TickInputs& inputs, void* data) {
    auto& self = *static_cast<ArenaGame*>(data);
    for (Seat seat = 0; seat < inputs.players.size(); ++seat) {
      const PlayerInput& player = inputs.players[seat];
      if (!player.present || player.held.empty()) continue;
      const std::uint64_t way = Random::mix(player.held[0] + 256u * seat);
      auto& body = space.body(self.players_[seat]);
      body.applyForce({Fixed(static_cast<int>(way % 31) - 15), Fixed(static_cast<int>(way / 31 % 31) - 15)},
                      body.position());
      // The world stays small.
      if (player.commands.empty() || player.commands[0] % 8 != 0 || player.commands[0] == 0) continue;
      self.dropCrate({Fixed(static_cast<int>(way % 19) - 9), Fixed(static_cast<int>(way / 19 % 19) - 9)});
    }
  }

  Space<Fixed> space_;
  std::array<BodyId, kMaxPlayers> players_{};
  SpaceGame<Fixed> game_;
  Game functions_;
};

}  // namespace

std::unique_ptr<SimGame> makeArenaGame() { return std::make_unique<ArenaGame>(); }

}  // namespace samestep::netsim
