// SPDX-License-Identifier: MIT
// A match of the arena between processes of this machine, over UDP that is made as bad as asked for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <samestep/session.h>

#include "netsim/network.h"

namespace samestep::loopback {

struct MatchOptions {
  std::uint32_t players = 2;
  std::uint32_t crates = 12;
  Tick ticks = 600;
  std::uint8_t window = 8;
  std::uint8_t inputDelay = 2;
  std::uint16_t hashInterval = 30;
  /// Profile of the links from each peer to each other one.
  netsim::LinkProfile link;
  std::uint64_t seed = 1;
  /// Speed of the peers' clocks.
  std::uint32_t speed = 1;
  /// True if all packets go through a relay, a process of its own.
  bool relay = false;
  /// Seat whose world gets one bit changed, and after which tick; kNoSeat: nobody's.
  Seat flipSeat = kNoSeat;
  Tick flipTick = 0;
};

/// Report of a peer's match.
struct PeerReport {
  EndReason reason = EndReason::none;
  Tick certain = 0;
  std::uint32_t deepest = 0;
  std::uint64_t steps = 0;
  std::uint64_t rollbacks = 0;
  std::uint64_t waited = 0;
  std::uint64_t datagrams = 0;
  std::uint64_t lost = 0;
  std::uint64_t bytes = 0;         ///< Sent, with the seal, IP and UDP.
  std::uint64_t microseconds = 0;  ///< Time by the peer's clock.
  std::uint64_t refused = 0;       ///< Datagrams that were no packet of the match.
  bool desynced = false;
};

/// Result that a peer leaves behind.
struct PeerResult {
  /// False for a process that ended otherwise, or not in time.
  bool ended = false;
  PeerReport report;
  /// Words that it wants to say, in lines.
  std::string words;
  std::vector<std::uint8_t> recording;
};

/// Plays the match, one process for each player, and waits for all of them.
/// @throws std::system_error where there are no sockets or processes
std::vector<PeerResult> playMatch(const MatchOptions& options);

/// Says what is wrong with the recordings of a match, in lines: each must verify, and all must be the same.
std::string compareRecordings(const MatchOptions& options, const std::vector<PeerResult>& peers);

}  // namespace samestep::loopback
