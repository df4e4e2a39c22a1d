// SPDX-License-Identifier: MIT
// A peer of a simulated match: a session, a game, a clock and a player.
#pragma once

#include <samestep/relay.h>
#include <samestep/session.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "netsim/match.h"
#include "netsim/network.h"
#include "netsim/seal.h"

namespace samestep::netsim {

/// Record of what a peer's game saw of a tick when it made that step last.
struct TickRecord {
  std::uint64_t inputs = 0;  ///< A digest of all inputs.
  std::uint64_t state = 0;   ///< The game's hash after the step.
  /// The counters that each player's input carried: see Peer.
  std::array<std::uint32_t, kMaxPlayers> held{};
  std::array<std::uint32_t, kMaxPlayers> command{};
};

/// Its player holds a counter that never falls, and gives commands that carry the numbers 1, 2, 3, ..., so
/// that what is lost, made up or applied twice shows in what the games were given.
class Peer {
 public:
  Peer(const SessionSettings& settings, const MatchOptions& options, Network& network, std::uint64_t seed);
  Peer(const Peer&) = delete;

  Session& session() const { return *session_; }
  Seat seat() const { return seat_; }
  Seal& seal() { return seal_; }
  const Seal& seal() const { return seal_; }
  /// Line to the relay, or null.
  const RelayTransport* relayed() const { return relayed_.get(); }
  /// Sends and receives at another node from now on.
  void moveTo(Address node) { node_ = node; }
  Address node() const { return node_; }
  /// Makes a frame, with what the player does, unless `quiet`.
  void frame(Time now, bool quiet);
  /// Time at which the next one is due.
  Time next() const { return next_; }
  void stallUntil(Time time) { next_ = std::max(next_, time); }
  void pauseUntil(Time time) { pausedUntil_ = time; }
  void crash() { crashed_ = true; }
  bool running() const { return !crashed_ && session_->state() != SessionState::ended; }
  bool crashed() const { return crashed_; }
  void setDrift(std::int32_t ppm, Time zero) {
    ppm_ = ppm;
    zero_ = zero;
  }
  void plant(Planted planted, Tick tick) {
    if (planted == Planted::unsealed) seal_.breakOpen();
    planted_ = planted;
    plantedTick_ = tick;
  }

  /// Record of a tick from first() on.
  const TickRecord& record(Tick tick) const { return records_[tick - first_]; }
  /// The tick of the state with which it began: a newcomer's is a later one.
  Tick first() const { return first_; }
  /// The tick of its own first input; kNever where it has not been let in.
  Tick start() const { return start_; }
  Tick certain() const { return certain_; }
  EndReason ended() const { return session_->endReason(); }
  std::uint32_t commandsGiven() const { return commandsGiven_; }
  std::uint32_t heldGiven() const { return heldGiven_; }
  const std::vector<SessionEvent>& events() const { return events_; }
  /// The object in which a planted flip shows.
  const char* flipped() const { return game_->flipped(); }
  /// The state that the game has is not what a sequence of loads and steps may lead to.
  bool misused() const { return misused_; }
  /// It writes states that are not the ones it has.
  void lie() { lies_ = true; }

 private:
  void save(std::uint32_t slot);
  void load(std::uint32_t slot);
  void step(const TickInputs& inputs);
  std::uint64_t toldHash();
  std::uint64_t write(std::uint32_t slot, std::span<std::uint8_t> into);
  bool read(std::span<const std::uint8_t> bytes);
  void act();
  Time local(Time now) const;

  Seat seat_;
  Address node_;
  Network& network_;
  Seal seal_;
  Random random_;
  std::unique_ptr<SimGame> game_;
  std::unique_ptr<RelayTransport> relayed_;
  std::unique_ptr<Session> session_;
  Time sending_ = 0;
  Time next_ = 0;
  Time pausedUntil_ = 0;
  Time zero_ = 0;
  std::int32_t ppm_ = 0;
  bool crashed_ = false;
  bool misused_ = false;
  bool lies_ = false;
  Tick at_ = 0;
  Tick certain_ = 0;
  Tick first_ = 0;
  Tick start_ = 0;
  std::vector<Tick> slots_;
  std::vector<TickRecord> records_;
  std::uint32_t heldGiven_ = 0;
  std::uint32_t commandsGiven_ = 0;
  std::vector<SessionEvent> events_;
  Planted planted_ = Planted::none;
  Tick plantedTick_ = 0;
};

}  // namespace samestep::netsim
