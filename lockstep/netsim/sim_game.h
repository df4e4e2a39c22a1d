// SPDX-License-Identifier: MIT
// The games that are played over the simulated network.
#pragma once

#include <samestep/game.h>

#include <cstdint>
#include <memory>
#include <span>

namespace samestep::netsim {

inline constexpr Tick kNever = 0xffffffffu;

/// A game whose states the oracle compares.
class SimGame {
 public:
  virtual ~SimGame() = default;
  virtual void save(std::uint32_t slot) = 0;
  virtual void load(std::uint32_t slot) = 0;
  virtual void step(const TickInputs& inputs) = 0;
  virtual std::uint64_t hash() = 0;
  /// The next two are as Game::write and Game::read.
  virtual std::uint64_t write(std::uint32_t slot, std::span<std::uint8_t> into) = 0;
  virtual bool read(std::span<const std::uint8_t> bytes) = 0;
  /// Changes one bit of the state: a planted fault.
  virtual void flip() = 0;
  /// The game whose Game::valueHashes and Game::value tell the values of kept states; null if it has none.
  virtual const Game* values() { return nullptr; }
  /// The object in which a flip shows.
  virtual const char* flipped() const { return ""; }
};

/// One integer, mixed with every input.
std::unique_ptr<SimGame> makeIntegerGame(std::uint32_t players);
/// Physics: a Space in Fixed, with room for so many players.
std::unique_ptr<SimGame> makeArenaGame(std::uint32_t players);

}  // namespace samestep::netsim
