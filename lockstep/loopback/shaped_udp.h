// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/udp_transport.h>

#include <span>
#include <vector>

#include "netsim/network.h"

namespace samestep::loopback {

using netsim::LinkProfile;
using netsim::Time;

/// One peer's end of a bad network: UDP, but what it sends is delayed, held up and lost first, as by a
/// simulated link to each of the others.
class ShapedUdp {
 public:
  /// @param udp  must outlive this
  ShapedUdp(UdpTransport& udp, std::span<const Address> others, const LinkProfile& profile,
            std::uint64_t seed);
  ShapedUdp(const ShapedUdp&) = delete;

  /// Sends what is due.
  void update(Time now);
  /// Transport that this is; it must not outlive this.
  Transport transport();

  /// Datagrams that were given to this and lost by it, and all their bytes with those of IP and UDP.
  std::uint64_t sent() const { return network_.sent(); }
  std::uint64_t lost() const { return network_.lost(); }
  std::uint64_t bytes() const { return bytes_; }

 private:
  void send(Address to, std::span<const std::uint8_t> bytes);

  UdpTransport& udp_;
  std::vector<Address> others_;
  netsim::Network network_;
  Time now_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace samestep::loopback
