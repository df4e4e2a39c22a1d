// SPDX-License-Identifier: MIT
// The inputs of one player, tick by tick, and what was predicted in their place.
#pragma once

#include <samestep/game.h>

#include <cstdint>
#include <span>
#include <vector>

#include "session/byte_io.h"

namespace samestep::lockstep {

/// Control inputs: what a player tells the session itself, in the order of its inputs. All peers obey it at
/// the same tick.
enum class Control : std::uint8_t {
  none = 0,
  leave = 1,  ///< This is the player's last input.
};
inline constexpr std::uint8_t kControls = 2;

struct InputEntry {
  std::span<const std::uint8_t> held;
  std::span<const std::uint8_t> commands;
  Control control = Control::none;
};

/// Keeps the last kCapacity inputs of a player. Allocates at construction only.
class InputStream {
 public:
  static constexpr std::uint32_t kCapacity = 256;

  InputStream(std::uint32_t maxHeld, std::uint32_t maxCommands);

  /// Forgets everything; the next input is that of `first`.
  void reset(Tick first);
  /// Goes on with the input of `first`, after ticks that have none and count as inputs of nothing.
  void skipTo(Tick first);
  Tick first() const { return first_; }
  /// The tick after the last input.
  Tick end() const { return end_; }
  bool has(Tick tick) const { return tick >= first_ && tick < end_ && tick + kCapacity >= end_; }
  /// The input of a tick that it has.
  InputEntry at(Tick tick) const;
  /// Input that was held last before a tick; empty before the first and where it is too long ago.
  std::span<const std::uint8_t> heldBefore(Tick tick) const;
  /// Takes the input of the tick end().
  /// @return false if a step was made with another one
  bool append(const InputEntry& entry);
  /// Forgets inputs from `end` on.
  void truncate(Tick end);

  /// Notes what a step of `tick` was made with, until its input comes.
  void predict(Tick tick, std::span<const std::uint8_t> held);
  /// Input that predict noted last for the tick.
  std::span<const std::uint8_t> predicted(Tick tick) const;

  std::uint32_t maxHeld() const { return maxHeld_; }
  std::uint32_t maxCommands() const { return maxCommands_; }

 private:
  struct Record {
    Tick predictedTick = 0xffffffffu;
    std::uint8_t held = 0;
    std::uint8_t commands = 0;
    std::uint8_t predicted = 0;
    Control control = Control::none;
  };
  std::uint8_t* bytesOf(Tick tick) { return bytes_.data() + (tick % kCapacity) * stride_; }
  const std::uint8_t* bytesOf(Tick tick) const { return bytes_.data() + (tick % kCapacity) * stride_; }

  std::uint32_t maxHeld_;
  std::uint32_t maxCommands_;
  std::uint32_t stride_;
  Tick first_ = 0;
  Tick end_ = 0;
  std::vector<Record> records_;
  /// Bytes of each record: held, predicted, commands.
  std::vector<std::uint8_t> bytes_;
};

/// Writes the inputs from `from` up to `to`, as far as there is room.
/// @return the tick after the last one written
Tick encodeEntries(PacketWriter& writer, const InputStream& stream, Tick from, Tick to);

/// Reads inputs up to the end of the packet and appends those that the stream lacks, below `limit`.
/// @param base   the tick of the first one
/// @param wrong  becomes the first tick whose step was made with another input, if that is earlier
/// @return false for bytes that are no inputs; those before them have been taken
bool decodeEntries(PacketReader& reader, InputStream& stream, Tick base, Tick limit, Tick& wrong);

}  // namespace samestep::lockstep
