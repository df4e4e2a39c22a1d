// SPDX-License-Identifier: MIT
// What must hold of every match, whatever the network did.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "netsim/match.h"
#include "netsim/peer.h"

namespace samestep::netsim {

class Oracle {
 public:
  using Peers = std::vector<std::unique_ptr<Peer>>;

  /// A peer that the plan cut off or stopped may be dropped.
  void excuse(Seat seat) { excused_ |= 1u << seat; }
  MatchReport judge(const MatchOptions& options, const Peers& peers, Seat plantedSeat, Tick plantedTick);

 private:
  void violate(const std::string& text);
  void states(const Peers& peers, const Peer& reference);
  void inputs(const Peers& peers, const Peer& reference);
  void detector(const MatchOptions& options, const Peers& peers, Seat plantedSeat, Tick plantedTick);
  void liar(const Peers& peers, const Peer& planted, Tick from);
  void progress(const MatchOptions& options, const Peers& peers);
  void endings(const Peers& peers);
  static Tick endOf(const Peers& peers, std::size_t index, const Peer& reference);
  void count(const MatchOptions& options, const Peers& peers, const Peer& reference);

  std::uint32_t excused_ = 0;
  MatchReport report_;
};

}  // namespace samestep::netsim
