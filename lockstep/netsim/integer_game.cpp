// SPDX-License-Identifier: MIT
#include <array>
#include <cstring>

#include "netsim/random.h"
#include "netsim/sim_game.h"

namespace samestep::netsim {
namespace {

class IntegerGame : public SimGame {
 public:
  void save(std::uint32_t slot) override { saved_[slot] = value_; }
  void load(std::uint32_t slot) override { value_ = saved_[slot]; }
  void step(const TickInputs& inputs) override {
    add(inputs.tick);
    for (const PlayerInput& player : inputs.players) {
      add(player.present ? 1 : 0);
      add(player.held.size());
      for (const std::uint8_t byte : player.held) add(byte);
      add(player.commands.size());
      for (const std::uint8_t byte : player.commands) add(byte);
    }
  }
  std::uint64_t hash() override { return value_; }
  std::uint64_t write(std::uint32_t slot, std::span<std::uint8_t> into) override {
    if (into.size() >= sizeof value_) std::memcpy(into.data(), &saved_[slot], sizeof value_);
    return sizeof value_;
  }
  bool read(std::span<const std::uint8_t> bytes) override {
    if (bytes.size() != sizeof value_) return false;
    std::memcpy(&value_, bytes.data(), sizeof value_);
    return true;
  }
  void flip() override { value_ ^= 1; }

 private:
  void add(std::uint64_t number) { value_ = lockstep::mix(value_ + number + 0x9e3779b97f4a7c15u); }

  std::uint64_t value_ = 0;
  std::array<std::uint64_t, 64> saved_{};
};

}  // namespace

std::unique_ptr<SimGame> makeIntegerGame(std::uint32_t) { return std::make_unique<IntegerGame>(); }

}  // namespace samestep::netsim
