// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace samestep {

/// Address of a peer: a number that the transport gives to each.
using Address = std::uint64_t;

/// The longest datagram, so that none is cut into pieces on its way.
inline constexpr std::uint32_t kMaxDatagram = 1200;
/// The longest that a Session sends: a transport may add its own bytes, up to kMaxDatagram.
inline constexpr std::uint32_t kMaxPacket = 1160;

/// Datagrams, as UDP has them: each arrives once, never, twice, late or out of order. `data` is handed to
/// both functions.
struct Transport {
  void* data = nullptr;
  /// Takes a datagram of at most kMaxDatagram bytes; does not wait.
  void (*send)(Address to, std::span<const std::uint8_t> bytes, void* data) = nullptr;
  /// Writes the next datagram that has arrived into `into` and its sender into `from`; does not wait.
  /// @return its length, or 0 if there is none; a longer one than `into` is dropped
  std::uint32_t (*receive)(Address& from, std::span<std::uint8_t> into, void* data) = nullptr;
};

}  // namespace samestep
