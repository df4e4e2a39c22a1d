// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/sealed_transport.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "transport/handshake.h"
#include "transport/replay_window.h"

namespace samestep {

inline constexpr std::uint32_t kConnectionsOfPeer = 4;
inline constexpr std::uint32_t kNoConnection = 0xffffffffu;

/// Keys that two peers agreed on, or, while there are none, the place for those of a call.
struct SealedConnection {
  enum class State : std::uint8_t { none, calling, unconfirmed, confirmed };
  State state = State::none;
  std::uint8_t use = 0;  ///< Counts who had this place, so that late datagrams do not reach the next one.
  std::uint16_t peerNumber = 0;
  bool heard = false;  ///< The peer has sent something sealed.
  std::uint64_t sent = 0;
  std::uint64_t order = 0;  ///< Number of connections that came into being before it.
  ConnectionKeys keys{};
  ReplayWindow window{};
  PublicKey callerFresh{};
  std::array<std::uint8_t, kAnswerBytes> answer{};
};

struct SealedPeer {
  SealedPeer() = default;
  SealedPeer(const SealedPeer&) = delete;
  SealedPeer& operator=(const SealedPeer&) = delete;

  void reset() {
    used = callable = false;
    key = {};
    below = 0;
    current = calling = kNoConnection;
    nextCall = lastHeard = 0;
    call.reset();
  }

  bool used = false;
  bool callable = false;
  PublicKey key{};
  Address below = 0;
  std::uint32_t current = kNoConnection;  ///< The connection that is sent on.
  std::uint32_t calling = kNoConnection;
  std::uint64_t nextCall = 0;
  std::uint64_t lastHeard = 0;
  std::optional<Call> call;
};

/// Peers that are let in, and a few places for connections of each.
struct PeerTable {
  std::uint64_t made = 0;  ///< Number of connections that came into being.
  std::array<SealedPeer, SealedTransport::kMaxPeers> peers{};
  std::array<SealedConnection, SealedTransport::kMaxPeers * kConnectionsOfPeer> connections{};

  std::uint16_t numberOf(std::uint32_t connection) const {
    return static_cast<std::uint16_t>(connection | static_cast<std::uint32_t>(connections[connection].use)
                                                       << 8);
  }

  SealedPeer* find(Address name) {
    return name >= 1 && name <= SealedTransport::kMaxPeers && peers[name - 1].used ? &peers[name - 1]
                                                                                   : nullptr;
  }

  SealedPeer* find(const PublicKey& key) {
    const auto found = std::find_if(peers.begin(), peers.end(),
                                    [&](const SealedPeer& peer) { return peer.used && peer.key == key; });
    return found == peers.end() ? nullptr : &*found;
  }

  std::uint32_t indexOf(const SealedPeer& peer) const {
    return static_cast<std::uint32_t>(&peer - peers.data());
  }

  SealedPeer* letIn(const PublicKey& key) {
    if (SealedPeer* known = find(key)) return known;
    const auto free =
        std::find_if(peers.begin(), peers.end(), [](const SealedPeer& peer) { return !peer.used; });
    if (free == peers.end()) return nullptr;
    free->used = true;
    free->key = key;
    return &*free;
  }

  void remove(SealedPeer& peer) {
    const std::uint32_t first = indexOf(peer) * kConnectionsOfPeer;
    for (std::uint32_t i = first; i < first + kConnectionsOfPeer; ++i)
      occupy(i, SealedConnection::State::none);
    peer.reset();
  }

  /// Empties a place and gives it a new number.
  SealedConnection& occupy(std::uint32_t index, SealedConnection::State state) {
    const std::uint8_t use = static_cast<std::uint8_t>(connections[index].use + 1);
    sodium_memzero(&connections[index].keys, sizeof(ConnectionKeys));
    connections[index] = SealedConnection();
    connections[index].use = use;
    connections[index].state = state;
    connections[index].order = ++made;
    return connections[index];
  }

  /// A place among the peer's: an empty one, or that of the oldest connection that is not the current one.
  std::uint32_t placeFor(const SealedPeer& peer) const {
    const std::uint32_t first = indexOf(peer) * kConnectionsOfPeer;
    std::uint32_t best = kNoConnection;
    for (std::uint32_t i = first; i < first + kConnectionsOfPeer; ++i) {
      if (i == peer.current || i == peer.calling) continue;
      if (connections[i].state == SealedConnection::State::none) return i;
      if (best == kNoConnection || connections[i].order < connections[best].order) best = i;
    }
    return best;
  }
};

}  // namespace samestep
