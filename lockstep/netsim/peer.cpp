// SPDX-License-Identifier: MIT
#include "netsim/peer.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace samestep::netsim {

namespace {

constexpr Time kFrame = 16'667;

std::uint32_t number(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4 && i < bytes.size(); ++i) value |= std::uint32_t{bytes[i]} << (8 * i);
  return value;
}

void bytesOf(std::uint32_t value, std::uint8_t* to) {
  for (unsigned i = 0; i < 4; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint64_t digest(const TickInputs& inputs) {
  std::uint64_t value = inputs.tick;
  const auto add = [&](std::uint64_t next) { value = lockstep::mix(value * 31 + next); };
  for (const PlayerInput& player : inputs.players) {
    add(player.present ? 1 : 0);
    add(player.held.size());
    for (const std::uint8_t byte : player.held) add(byte);
    add(player.commands.size());
    for (const std::uint8_t byte : player.commands) add(byte);
  }
  return value;
}

}  // namespace

Peer::Peer(const SessionSettings& settings, const MatchOptions& options, Network& network, std::uint64_t seed)
    : seat_(settings.localSeat), network_(network), random_(seed), game_(options.makeGame()) {
  Game game;
  game.data = this;
  game.save = [](std::uint32_t slot, void* data) { static_cast<Peer*>(data)->save(slot); };
  game.load = [](std::uint32_t slot, void* data) { static_cast<Peer*>(data)->load(slot); };
  game.step = [](const TickInputs& inputs, void* data) { static_cast<Peer*>(data)->step(inputs); };
  game.hash = [](void* data) { return static_cast<Peer*>(data)->game_->hash(); };
  if (game_->values() != nullptr) {
    game.valueHashes = [](std::uint32_t slot, std::span<std::uint64_t> into, void* data) {
      const Game* inner = static_cast<Peer*>(data)->game_->values();
      return inner->valueHashes(slot, into, inner->data);
    };
    game.value = [](std::uint32_t slot, std::uint32_t index, GameValue& into, void* data) {
      const Game* inner = static_cast<Peer*>(data)->game_->values();
      inner->value(slot, index, into, inner->data);
    };
  }
  Transport transport;
  transport.data = this;
  transport.send = [](Address to, std::span<const std::uint8_t> bytes, void* data) {
    auto* self = static_cast<Peer*>(data);
    self->network_.send(self->seat_, to, bytes, self->sending_);
  };
  transport.receive = [](Address& from, std::span<std::uint8_t> into, void* data) {
    auto* self = static_cast<Peer*>(data);
    auto& box = self->network_.inbox(self->seat_);
    if (box.empty()) return std::uint32_t{0};
    const auto size = static_cast<std::uint32_t>(box.front().bytes.size());
    std::memcpy(into.data(), box.front().bytes.data(), size);
    from = box.front().from;
    box.pop_front();
    return size;
  };
  session_ = std::make_unique<Session>(settings, game, transport);
  slots_.resize(kSaveSlots + kKeepSlots);
}

Time Peer::local(Time now) const {
  return zero_ + now + static_cast<Time>(static_cast<std::int64_t>(now) * ppm_ / 1'000'000);
}

void Peer::save(std::uint32_t slot) {
  slots_[slot] = at_;
  game_->save(slot);
}

void Peer::load(std::uint32_t slot) {
  at_ = slots_[slot];
  game_->load(slot);
  if (planted_ == Planted::forgets && session_->tick() >= plantedTick_) {
    planted_ = Planted::none;
    game_->flip();
  }
}

void Peer::step(const TickInputs& inputs) {
  if (inputs.tick != at_) misused_ = true;
  TickRecord record;
  record.inputs = digest(inputs);
  for (Seat seat = 0; seat < inputs.players.size(); ++seat) {
    record.held[seat] = number(inputs.players[seat].held);
    record.command[seat] = number(inputs.players[seat].commands);
  }
  if (planted_ == Planted::deaf && inputs.tick == plantedTick_) {
    // Each time the step is made, as a game that leaves out an input would.
    std::array<PlayerInput, kMaxPlayers> players{};
    std::copy(inputs.players.begin(), inputs.players.end(), players.begin());
    players[seat_].held = {};
    players[seat_].commands = {};
    game_->step({inputs.tick, {players.data(), inputs.players.size()}});
  } else {
    game_->step(inputs);
  }
  if (planted_ == Planted::flip && inputs.tick == plantedTick_) game_->flip();
  record.state = game_->hash();
  ++at_;
  records_.resize(std::max<std::size_t>(records_.size(), at_));
  records_[inputs.tick] = record;
}

/// The player's hands.
void Peer::act() {
  if (random_.perMille(120)) heldGiven_ += random_.within(1, 3);
  if (random_.perMille(20)) {
    std::uint8_t bytes[16] = {};
    bytesOf(commandsGiven_ + 1, bytes);
    // Commands have any length.
    if (session_->command({bytes, random_.within(4, 16)})) ++commandsGiven_;
  }
}

void Peer::frame(Time now, bool quiet) {
  sending_ = now;
  if (!quiet && session_->state() == SessionState::running) act();
  session_->pause(now < pausedUntil_);
  std::uint8_t held[4];
  bytesOf(heldGiven_, held);
  session_->frame(local(now), held);
  if (session_->state() == SessionState::running)
    certain_ = std::min(session_->confirmed(), session_->tick());
  for (SessionEvent event; session_->next(event);) events_.push_back(event);
  // A frame of a clock that runs fast is shorter.
  const auto length = static_cast<std::int64_t>(kFrame * session_->frameLength() / 1000);
  next_ = now + static_cast<Time>(length - length * ppm_ / 1'000'000);
}

}  // namespace samestep::netsim
