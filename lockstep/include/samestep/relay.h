// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/game.h>
#include <samestep/transport.h>

#include <cstdint>
#include <span>

namespace samestep {

/// Microseconds for which a relay, or who sends through one, gathers packets: the match goes on so much
/// later, and takes less of the network.
inline constexpr std::uint64_t kGatherFor = 25'000;

/// Passes the packets of a match on between players who do not reach each other, or many of whom would be too
/// much for their lines: each sends and receives one datagram at a time, in which there are the packets for
/// and of all others. A relay has no part in the match: it votes for nothing, and when it is gone the players
/// end as if they had lost each other.
///
/// It sees who sends how much to whom, and, as inputs of all players are put together here, what they do; it
/// needs no key of the players' own. It passes on nothing in another's name.
class Relay {
 public:
  /// @param transport  another one than that of a session; it should let in the players alone
  explicit Relay(const Transport& transport);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  /// Takes in what has come and sends what has waited for long enough. Call it some 100 times a second.
  void update(std::uint64_t now);
  /// Number of seats that were heard in the last five seconds.
  std::uint32_t seats() const;
  /// Datagrams and bytes sent, without what is added below.
  std::uint64_t sentPackets() const;
  std::uint64_t sentBytes() const;
  /// Packets dropped: malformed, in another's name, for nobody known, for whom too much waits.
  std::uint64_t refused() const;

 private:
  struct Impl;
  Impl* impl_;
};

/// Transport of a player through a relay: addresses are seats.
///
///     RelayTransport relayed(sealed.transport(), relayAddress, seat);
///     for (Seat other = 0; other < players; ++other) settings.addresses[other] =
///     RelayTransport::address(other); Session session(settings, game.functions(), relayed.transport()); each
///     frame: session.frame(now, held);  relayed.update(now);
class RelayTransport {
 public:
  RelayTransport(const Transport& below, Address relay, Seat seat);
  ~RelayTransport();
  RelayTransport(const RelayTransport&) = delete;
  RelayTransport& operator=(const RelayTransport&) = delete;

  static Address address(Seat seat) { return Address{seat} + 1; }
  /// Sends what has waited for long enough. Call it after each frame.
  void update(std::uint64_t now);
  void send(Address to, std::span<const std::uint8_t> bytes);
  std::uint32_t receive(Address& from, std::span<std::uint8_t> into);
  /// Transport that this is; it must not outlive this.
  Transport transport();
  /// Datagrams and bytes sent, without what is added below.
  std::uint64_t sentPackets() const;
  std::uint64_t sentBytes() const;

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace samestep
