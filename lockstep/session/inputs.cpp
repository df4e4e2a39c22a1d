// SPDX-License-Identifier: MIT
#include <samestep/error.h>
#include <samestep/game.h>

#include "session/byte_io.h"

namespace samestep {

std::size_t encodeInputs(const TickInputs& inputs, std::span<std::uint8_t> into) {
  lockstep::PacketWriter writer(into);
  writer.u32(inputs.tick);
  writer.u8(static_cast<std::uint8_t>(inputs.players.size()));
  bool short_ = inputs.players.size() <= kMaxPlayers;
  for (const PlayerInput& player : inputs.players) {
    writer.u8(player.present ? 1 : 0);
    for (const std::span<const std::uint8_t> bytes : {player.held, player.commands}) {
      short_ = short_ && bytes.size() <= 255;
      writer.u8(static_cast<std::uint8_t>(bytes.size()));
      writer.bytes(bytes);
    }
  }
  return writer.good() && short_ ? writer.size() : 0;
}

TickInputs decodeInputs(std::span<const std::uint8_t> bytes, std::span<PlayerInput, kMaxPlayers> players) {
  lockstep::PacketReader reader(bytes);
  TickInputs inputs;
  inputs.tick = reader.u32();
  const std::uint8_t count = reader.u8();
  if (count > kMaxPlayers) reader.fail();
  for (std::uint8_t seat = 0; reader.good() && seat < count; ++seat) {
    PlayerInput& player = players[seat];
    const std::uint8_t present = reader.u8();
    if (present > 1) reader.fail();
    player.present = present != 0;
    player.held = reader.bytes(reader.u8());
    player.commands = reader.bytes(reader.u8());
  }
  require<Fault::MalformedBytes>(reader.done(), "These bytes are not the inputs of a tick.");
  inputs.players = players.first(count);
  return inputs;
}

}  // namespace samestep
