// SPDX-License-Identifier: MIT
// A whole match over a simulated network, all of it from one seed, and the oracle that watches it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "netsim/sim_game.h"

namespace samestep::netsim {

/// Faults that may occur in a match, each from the seed.
enum Fault : std::uint32_t {
  kLoss = 1,          ///< Bad links: loss in runs, duplicates, bursts, jitter, narrow bandwidth.
  kPartition = 2,     ///< Some peers cannot hear others for a while.
  kStall = 4,         ///< A peer stands still for a while, as a tab in the background.
  kCrash = 8,         ///< A peer is gone from one moment to the next.
  kLeave = 16,        ///< A peer leaves.
  kChange = 32,       ///< Input delay, window, saving, run-ahead and pause change in the match.
  kDrift = 64,        ///< Clocks run at different speeds, up to 300 ppm apart, and from different zeros.
  kHostile = 128,     ///< Strangers send bytes; old datagrams come again.
  kAsymmetric = 256,  ///< Links are slower one way.
  kJoin = 512,        ///< Newcomers take seats that were not there at the start.
  kRejoin = 1024,     ///< A peer that crashed or was dropped begins anew, and comes back.
  kLie = 2048,        ///< A peer sends newcomers another state than the one it has.
  kCorrupt = 4096,    ///< Datagrams are changed on the way.
  kMove = 8192,       ///< Peers come to have another address.
};
inline constexpr std::uint32_t kAllFaults = 16383;
/// "loss", "partition", ...; 0 for another word.
std::uint32_t faultNamed(const std::string& name);
std::string faultNames(std::uint32_t faults);

/// Fault planted on purpose, to see that the oracle notices.
enum class Planted : std::uint8_t {
  none,
  flip,      ///< One bit of one peer's state, once.
  deaf,      ///< One peer's game does not see one input that all others see.
  forgets,   ///< One peer's game does not come back wholly from a load, once.
  lies,      ///< One peer tells other hashes than those of its states.
  unsealed,  ///< One peer takes datagrams that were changed on the way.
};

struct MatchOptions {
  std::uint64_t seed = 1;
  std::uint32_t peers = 4;
  Tick ticks = 3600;
  std::uint32_t faults = kAllFaults;
  Planted planted = Planted::none;
  std::unique_ptr<SimGame> (*makeGame)(std::uint32_t players) = makeIntegerGame;
  /// Delay of each link in ms, and how many of a hundred datagrams are lost; kBySeed: as the seed has it.
  static constexpr std::uint32_t kBySeed = 0xffffffffu;
  std::uint32_t delay = kBySeed;
  std::uint32_t loss = kBySeed;
  /// True if all packets go through a relay, half of the way from each.
  bool relay = false;
};

struct MatchReport {
  /// Empty when all is well.
  std::vector<std::string> violations;
  /// Peers that told of a desync, bit by seat, and the tick they told it for first.
  std::uint32_t desynced = 0;
  Tick desyncTick = 0;
  /// Peers that named the object in which a flip was planted, and who differs from most, bit by seat.
  std::uint32_t named = 0;
  /// Findings of each peer about a desync.
  std::vector<std::string> findings;
  /// Events of the match, for the record of what seeds cover.
  std::uint32_t peers = 0;
  std::uint32_t survivors = 0;
  std::uint32_t dropped = 0;
  std::uint32_t left = 0;
  std::uint32_t joined = 0;    ///< Seats taken in the match, those taken again included.
  std::uint32_t rejoined = 0;  ///< Seats among them that were taken before.
  std::uint32_t refused = 0;   ///< States that newcomers did not believe.
  std::uint32_t moved = 0;     ///< Peers that came to have another address.
  std::uint64_t forged = 0;    ///< Datagrams that were dropped for their seal.
  std::uint64_t spoilt = 0;    ///< Datagrams that were changed on the way.
  std::uint64_t steps = 0;
  std::uint64_t rollbacks = 0;
  std::uint32_t deepest = 0;
  std::uint64_t waited = 0;
  std::uint64_t datagrams = 0;
  std::uint64_t lost = 0;
  std::uint64_t payload = 0;
  /// Datagrams and payload that peers sent to the relay, and the relay to them.
  std::uint64_t upDatagrams = 0;
  std::uint64_t up = 0;
  std::uint64_t downDatagrams = 0;
  std::uint64_t down = 0;
  std::uint64_t milliseconds = 0;  ///< Virtual.
  /// Hash of everything that was certain: equal where runs are.
  std::uint64_t trace = 0;
};

MatchReport runMatch(const MatchOptions& options);

/// Looks for a smaller match that fails: fewer faults, fewer peers, fewer ticks, but at least 60.
MatchOptions shrink(const MatchOptions& failing);

}  // namespace samestep::netsim
