// SPDX-License-Identifier: MIT
// What a SealedTransport is to a session, without its arithmetic: datagrams carry the name of their sender
// and a tag, and one that was changed or made up is dropped. A peer may move to another node.
#pragma once

#include <samestep/game.h>

#include <array>
#include <cstdint>
#include <span>

#include "netsim/network.h"

namespace samestep::netsim {

/// Node of the relay, and its name.
inline constexpr Address kRelayNode = 2 * kMaxPlayers + 1;
inline constexpr Address kRelayName = kMaxPlayers + 1;

class Seal {
 public:
  static constexpr std::uint32_t kBytes = 9;
  /// @param name  of this peer: its seat
  Seal(std::uint64_t match, Address name) : match_(match), name_(name) {
    for (Address other = 0; other < nodes_.size(); ++other) nodes_[other] = other;
    nodes_[kRelayName] = kRelayNode;
  }

  /// Node at which a peer was heard last.
  Address nodeOf(Address name) const { return nodes_[name]; }
  /// Tells where a peer is, as a lobby does.
  void place(Address name, Address node) { nodes_[name] = node; }
  void close(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> into);
  /// @return the length of what was sealed, or 0 for a datagram to be dropped
  std::uint32_t open(const Datagram& datagram, Address& from, std::span<std::uint8_t> into);
  /// Datagrams that were dropped.
  std::uint64_t forged() const { return forged_; }
  /// Takes whatever comes for good: a planted fault.
  void breakOpen() { broken_ = true; }

  /// The tag of a datagram of a peer.
  static std::uint32_t tagOf(std::uint64_t match, Address name, std::uint32_t number,
                             std::span<const std::uint8_t> bytes);

 private:
  std::uint64_t match_;
  Address name_;
  std::array<Address, kRelayName + 1> nodes_{};
  /// The highest number that each peer has used, by which an old datagram does not tell a new place.
  std::array<std::uint32_t, kRelayName + 1> numbers_{};
  std::uint32_t sent_ = 0;
  std::uint64_t forged_ = 0;
  bool broken_ = false;
};

}  // namespace samestep::netsim
