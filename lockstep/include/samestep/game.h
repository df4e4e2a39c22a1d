// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace samestep {

/// A step of the match, counted from 0. At 60 Hz it lasts for two years.
using Tick = std::uint32_t;

/// Seats of a match, 0 to 15.
using Seat = std::uint8_t;
inline constexpr Seat kMaxPlayers = 16;
inline constexpr Seat kNoSeat = 0xff;
/// The longest prediction window, ticks.
inline constexpr std::uint8_t kMaxWindow = 16;
/// Number of states a game keeps.
inline constexpr std::uint32_t kSaveSlots = kMaxWindow + 2;
/// And so many more, with the numbers from kSaveSlots on, if it can tell its values or write its state.
inline constexpr std::uint32_t kKeepSlots = 4;

/// Input of one player in one tick.
///
/// A game must not ask whether an input was predicted: the session alone knows, and repeats the step with the
/// true one where it was wrong.
struct PlayerInput {
  /// False before the player has joined and after it has left or was dropped.
  bool present = false;
  /// Buttons and sticks that are held: predicted while the true ones are on their way. Predicted while the
  /// true one is on its way. At most SessionSettings::maxHeldBytes.
  std::span<const std::uint8_t> held;
  /// Commands happen once, as a menu choice or a chat line: never predicted, never lost, never applied twice.
  /// At most SessionSettings::maxCommandBytes.
  std::span<const std::uint8_t> commands;
};

/// Inputs of all players in one tick, by seat.
struct TickInputs {
  Tick tick = 0;
  std::span<const PlayerInput> players;
};

/// The most bytes that encodeInputs writes.
inline constexpr std::size_t kMaxInputsBytes = 5 + kMaxPlayers * (3 + 255 + 255);
/// Writes the inputs of a tick as bytes, the same on every machine.
/// @return how many; 0 where they do not fit, or an input is longer than 255 bytes
std::size_t encodeInputs(const TickInputs& inputs, std::span<std::uint8_t> into);
/// Reads them; the inputs refer to the bytes.
/// @throws MalformedBytes for what encodeInputs does not write
TickInputs decodeInputs(std::span<const std::uint8_t> bytes, std::span<PlayerInput, kMaxPlayers> players);

/// One value of a state in words, each cut to fit.
struct GameValue {
  char object[64] = {};
  char field[64] = {};
  char text[96] = {};
};

/// A game as four functions: the session asks, the game obeys. `data` is handed to each of them.
///
/// The state must depend on nothing but the state before and the inputs.
struct Game {
  void* data = nullptr;
  /// Keeps the present state under a number below kSaveSlots, in place of what was there.
  void (*save)(std::uint32_t slot, void* data) = nullptr;
  /// Brings back what was kept last under this number.
  void (*load)(std::uint32_t slot, void* data) = nullptr;
  /// Makes one step.
  void (*step)(const TickInputs& inputs, void* data) = nullptr;
  /// A number that differs where two states differ; the same on every machine.
  std::uint64_t (*hash)(void* data) = nullptr;

  /// Names for SyncTest, and may be null, the first thing in which two kept states differ, cut to fit `text`.
  /// @return whether they differ
  bool (*difference)(std::uint32_t slotA, std::uint32_t slotB, std::span<char> text, void* data) = nullptr;
  /// Lists for a Session what differs after a desync; both may be null. All values of a kept state in an
  /// order of their own, each as a number that goes by its name and value.
  /// @return how many there are; with room for all of them, they are written
  std::uint32_t (*valueHashes)(std::uint32_t slot, std::span<std::uint64_t> into, void* data) = nullptr;
  /// The value with a number below that count.
  void (*value)(std::uint32_t slot, std::uint32_t index, GameValue& into, void* data) = nullptr;

  /// For players that join a match under way; both may be null. A kept state as bytes, the same on every
  /// machine.
  /// @return how many there are; with room for all of them, they are written
  std::uint64_t (*write)(std::uint32_t slot, std::span<std::uint8_t> into, void* data) = nullptr;
  /// Brings in what another peer sent as such bytes, whatever they are.
  /// @return false for bytes that are no state; the state is then any
  bool (*read)(std::span<const std::uint8_t> bytes, void* data) = nullptr;
};

}  // namespace samestep
