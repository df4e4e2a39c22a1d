// SPDX-License-Identifier: MIT
// The game of the example: players push each other and crates about between four walls.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <samestep/game.h>
#include <samestep/space.h>

namespace arena {

using samestep::BodyId;
using samestep::Seat;
using samestep::Tick;

/// Buttons that a player holds, one byte.
enum Button : std::uint8_t { kLeft = 1, kRight = 2, kDown = 4, kUp = 8, kDash = 16 };
/// The command, one byte, that drops a crate where the player is going; there is room for kMostCrates.
inline constexpr std::uint8_t kDropCrate = 'c';
inline constexpr std::uint32_t kMostCrates = 128;

/// The world, and how it starts. Nothing but steps and inputs changes it; what is in here beside the Space
/// never changes.
template <samestep::Scalar S>
class Arena {
 public:
  Arena(std::uint32_t players, std::uint32_t crates);
  Arena(const Arena&) = delete;

  /// Does what the players do: the function of a SpaceGame, whose data is an Arena.
  static void applyInputs(samestep::Space<S>& space, const samestep::TickInputs& inputs, void* data);

  samestep::Space<S>& space() { return space_; }
  const samestep::Space<S>& space() const { return space_; }
  BodyId player(Seat seat) const { return players_[seat]; }
  /// Half of the arena's side, m.
  int size() const { return size_; }

 private:
  BodyId place(samestep::Space<S>& space, const samestep::Vector<S>& position) const;
  void dropCrate(samestep::Space<S>& space, const samestep::Vector<S>& position) const;
  void apply(samestep::Space<S>& space, Seat seat, const samestep::PlayerInput& input) const;

  samestep::Space<S> space_;
  std::array<BodyId, samestep::kMaxPlayers> players_{};
  int size_;
};

/// Applies the inputs of a recording that a SpaceGame made of an arena: for the wiring of a replay.
/// @throws MalformedBytes
template <samestep::Scalar S>
void applyRecorded(samestep::Space<S>& space, std::span<const std::uint8_t> bytes, void* data);

/// Buttons that a bot of this seat holds in a tick: it changes its mind every third of a second.
std::uint8_t botButtons(std::uint64_t seed, Seat seat, Tick tick);

}  // namespace arena
