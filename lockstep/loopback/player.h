// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/relay.h>
#include <samestep/sealed_transport.h>
#include <samestep/space_game.h>
#include <samestep/udp_transport.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "arena/arena.h"
#include "loopback/match.h"
#include "loopback/shaped_udp.h"

namespace samestep::loopback {

/// The arena, in which a bit of somebody may be changed.
struct FlippedArena {
  explicit FlippedArena(const MatchOptions& options) : arena(options.players, options.crates) {}
  static void apply(Space<Fixed>& space, const TickInputs& inputs, void* data);

  arena::Arena<Fixed> arena;
  Seat flipSeat = kNoSeat;
  Tick flipTick = 0;
};

/// Table of all peers: where and who they are.
struct Table {
  std::vector<std::unique_ptr<UdpTransport>> sockets;
  std::vector<KeyPair> keys;
  MatchKey match;
  /// Socket of the relay, or null, and the word that it shares with the players.
  std::unique_ptr<UdpTransport> relay;
  std::string relayWord;
};

/// One peer: a bot plays until the match is over.
class Player {
 public:
  Player(const MatchOptions& options, Table& table, Seat seat);
  Player(const Player&) = delete;
  PeerResult play();

 private:
  static std::vector<Address> othersOf(const Table& table, Seat seat);
  SessionSettings settingsOf();
  void findOthers(const Table& table);
  Transport transport() { return relayed_ == nullptr ? sealed_.transport() : relayed_->transport(); }
  void turn(Time now);
  void notice();
  bool over() const;

  const MatchOptions& options_;
  Seat seat_;
  UdpTransport& udp_;
  ShapedUdp shaped_;
  SealedTransport sealed_;
  std::vector<Address> addresses_;
  std::unique_ptr<RelayTransport> relayed_;
  FlippedArena arena_;
  SpaceGame<Fixed> game_;
  Session session_;
  Time next_ = 0;
  bool recording_ = true;
  PeerResult result_;
};

}  // namespace samestep::loopback
