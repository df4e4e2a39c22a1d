// SPDX-License-Identifier: MIT
// A relay over UDP.
#pragma once

#include <cstdint>
#include <string>

#include <samestep/sealed_transport.h>
#include <samestep/udp_transport.h>

namespace samestep::loopback {

struct RelayOptions {
  std::uint16_t port = 0;
  /// Secret of the players and the relay, by which they know each other; not one by which players seal what
  /// they say to each other.
  std::string word;
  /// Seconds after which it ends; 0: never.
  std::uint32_t seconds = 0;
  /// Says on the standard output at each so many seconds what it does; 0: never.
  std::uint32_t tellEvery = 10;
};

/// Keys that a word stands for: that of the match, and the relay's own.
MatchKey relayMatchKey(const std::string& word);
KeyPair relayKeys(const std::string& word);

/// Relays until the time is over.
/// @throws std::system_error where the port cannot be listened at
void runRelay(const RelayOptions& options);
/// Relays at a socket that is there.
void runRelay(const RelayOptions& options, UdpTransport& udp);

}  // namespace samestep::loopback
