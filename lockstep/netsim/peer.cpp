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
    : seat_(settings.localSeat),
      node_(settings.localSeat),
      network_(network),
      seal_(settings.match, settings.localSeat),
      random_(seed),
      // Every fourth match is one of the largest world.
      game_(options.makeGame(options.seed % 4 == 0 ? kMaxPlayers : settings.maxPlayers)) {
  Game game;
  game.data = this;
  game.save = [](std::uint32_t slot, void* data) { static_cast<Peer*>(data)->save(slot); };
  game.load = [](std::uint32_t slot, void* data) { static_cast<Peer*>(data)->load(slot); };
  game.step = [](const TickInputs& inputs, void* data) { static_cast<Peer*>(data)->step(inputs); };
  game.hash = [](void* data) { return static_cast<Peer*>(data)->toldHash(); };
  game.write = [](std::uint32_t slot, std::span<std::uint8_t> into, void* data) {
    return static_cast<Peer*>(data)->write(slot, into);
  };
  game.read = [](std::span<const std::uint8_t> bytes, void* data) {
    return static_cast<Peer*>(data)->read(bytes);
  };
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
    std::array<std::uint8_t, kMaxDatagram> sealed;
    self->seal_.close(bytes, sealed);
    self->network_.send(self->node_, self->seal_.nodeOf(to),
                        std::span(sealed).first(bytes.size() + Seal::kBytes), self->sending_);
  };
  transport.receive = [](Address& from, std::span<std::uint8_t> into, void* data) {
    auto* self = static_cast<Peer*>(data);
    auto& box = self->network_.inbox(self->node_);
    std::uint32_t size = 0;
    while (size == 0 && !box.empty()) {
      size = self->seal_.open(box.front(), from, into);
      box.pop_front();
    }
    return size;
  };
  if (settings.joins) first_ = start_ = kNever;
  if (options.relay) {
    relayed_ = std::make_unique<RelayTransport>(transport, kRelayName, seat_);
    transport = relayed_->transport();
  }
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

/// The hash of the state, or what a liar says it is.
std::uint64_t Peer::toldHash() {
  const bool lies = planted_ == Planted::lies && at_ >= plantedTick_;
  return game_->hash() ^ (lies ? 1 : 0);
}

/// The state's tick, then what the game writes.
std::uint64_t Peer::write(std::uint32_t slot, std::span<std::uint8_t> into) {
  const std::uint64_t size = 4 + game_->write(slot, into.subspan(std::min<std::size_t>(into.size(), 4)));
  if (into.size() < size) return size;
  bytesOf(slots_[slot], into.data());
  if (lies_) into[size - 1] ^= 1;
  return size;
}

bool Peer::read(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 4 || !game_->read(bytes.subspan(4))) return false;
  at_ = first_ = number(bytes);
  records_.clear();
  return true;
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
  records_.resize(std::max<std::size_t>(records_.size(), at_ - first_));
  records_[inputs.tick - first_] = record;
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
  if (relayed_ != nullptr) relayed_->update(now);
  if (session_->state() == SessionState::running)
    certain_ = std::min(session_->confirmed(), session_->tick());
  for (SessionEvent event; session_->next(event);) {
    if (event.kind == SessionEvent::Kind::joined && event.seat == seat_) start_ = event.tick;
    events_.push_back(event);
  }
  // A frame of a clock that runs fast is shorter.
  const auto length = static_cast<std::int64_t>(kFrame * session_->frameLength() / 1000);
  next_ = now + static_cast<Time>(length - length * ppm_ / 1'000'000);
}

}  // namespace samestep::netsim
