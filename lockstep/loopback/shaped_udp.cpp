// SPDX-License-Identifier: MIT
#include "loopback/shaped_udp.h"

#include <algorithm>

namespace samestep::loopback {

namespace {

/// IP and UDP.
constexpr std::uint64_t kOverhead = 28;

}  // namespace

// The node with the number of all others is this end.
ShapedUdp::ShapedUdp(UdpTransport& udp, std::span<const Address> others, const LinkProfile& profile,
                     std::uint64_t seed)
    : udp_(udp),
      others_(others.begin(), others.end()),
      network_(static_cast<std::uint32_t>(others.size() + 1), seed) {
  for (Address other = 0; other < others_.size(); ++other) network_.profile(others_.size(), other) = profile;
}

void ShapedUdp::update(Time now) {
  now_ = now;
  network_.deliver(now);
  for (Address other = 0; other < others_.size(); ++other) {
    auto& due = network_.inbox(other);
    for (; !due.empty(); due.pop_front()) udp_.send(others_[other], due.front().bytes);
  }
}

void ShapedUdp::send(Address to, std::span<const std::uint8_t> bytes) {
  const auto found = std::find(others_.begin(), others_.end(), to);
  if (found == others_.end()) return;
  bytes_ += bytes.size() + kOverhead;
  network_.send(others_.size(), static_cast<Address>(found - others_.begin()), bytes, now_);
}

Transport ShapedUdp::transport() {
  return {this,
          [](Address to, std::span<const std::uint8_t> bytes, void* data) {
            static_cast<ShapedUdp*>(data)->send(to, bytes);
          },
          [](Address& from, std::span<std::uint8_t> into, void* data) {
            return static_cast<ShapedUdp*>(data)->udp_.receive(from, into);
          }};
}

}  // namespace samestep::loopback
