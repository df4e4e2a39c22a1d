// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <samestep/transport.h>

namespace samestep {

/// Datagrams over UDP (IPv4), without waiting. An Address is the IPv4 address and port of a socket, in one
/// number. Whatever comes from outside may be forged: put a SealedTransport over it.
class UdpTransport {
 public:
  /// Opens a socket.
  /// @param host  the IPv4 address to listen at: "127.0.0.1" for this machine alone, "0.0.0.0" for all
  /// @param port  0 for any that is free
  /// @throws std::system_error naming the address
  explicit UdpTransport(const std::string& host = "0.0.0.0", std::uint16_t port = 0);
  ~UdpTransport();
  UdpTransport(const UdpTransport&) = delete;
  UdpTransport& operator=(const UdpTransport&) = delete;

  /// The port listened at.
  std::uint16_t port() const { return port_; }
  /// The number of an address. @return 0 for a text that is no IPv4 address
  static Address address(const std::string& host, std::uint16_t port);
  /// "127.0.0.1:4000"
  static std::string text(Address address);

  /// Sends; a datagram that the system does not take at once is lost and counted, as any other may be.
  void send(Address to, std::span<const std::uint8_t> bytes);
  /// The next datagram. @return its length, or 0 if there is none
  std::uint32_t receive(Address& from, std::span<std::uint8_t> into);
  /// Transport that this is; it must not outlive this.
  Transport transport();
  /// Waits until a datagram arrives or a time has passed.
  void wait(std::uint32_t milliseconds) const;

  /// Datagrams that the system did not take.
  std::uint64_t unsent() const { return unsent_; }
  /// Datagrams longer than the room for them, which were dropped.
  std::uint64_t tooLong() const { return tooLong_; }

 private:
  int socket_ = -1;
  std::uint16_t port_ = 0;
  std::uint64_t unsent_ = 0;
  std::uint64_t tooLong_ = 0;
};

}  // namespace samestep
