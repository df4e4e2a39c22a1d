// SPDX-License-Identifier: MIT
#include <samestep/error.h>
#include <samestep/relay.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "relay/bundle.h"

namespace samestep {

using lockstep::BundleQueue;
using lockstep::BundleReader;

namespace {

constexpr int kMostReceived = 1024;
constexpr std::uint64_t kGone = 5'000'000;

void require(const Transport& transport) {
  samestep::require<Fault::ValueOutOfRange>(transport.send != nullptr && transport.receive != nullptr,
                                            "A transport lacks a function.");
}

/// Packets that wait to be sent to one address, and when they are.
struct Line {
  bool due(std::uint64_t now) const { return !queue.empty() && now - std::min(now, sentAt) >= kGatherFor; }
  void flush(std::uint64_t now, const Transport& transport, Address to) {
    std::array<std::uint8_t, kMaxDatagram> bundle;
    while (const std::uint32_t size = queue.take(bundle)) {
      transport.send(to, std::span(bundle).first(size), transport.data);
      ++packets;
      bytes += size;
    }
    sentAt = now;
  }

  BundleQueue queue;
  std::uint64_t sentAt = 0;
  std::uint64_t packets = 0;
  std::uint64_t bytes = 0;
};

}  // namespace

struct Relay::Impl {
  struct Player {
    bool known = false;
    Address address = 0;
    std::uint64_t lastHeard = 0;
    Line line;
  };

  void receive(Address from, std::span<const std::uint8_t> bundle);
  bool takeSeat(Seat seat, Address from);

  Transport transport;
  std::uint64_t now = 0;
  std::uint64_t refused = 0;
  std::array<Player, kMaxPlayers> players;
};

/// True if an address speaks for a seat: the first that does, until it has been silent for long.
bool Relay::Impl::takeSeat(Seat seat, Address from) {
  Player& player = players[seat];
  const bool free = !player.known || now - player.lastHeard > kGone;
  if (!free && player.address != from) return false;
  player.known = true;
  player.address = from;
  player.lastHeard = now;
  return true;
}

void Relay::Impl::receive(Address from, std::span<const std::uint8_t> bundle) {
  BundleReader reader(bundle);
  std::array<std::uint8_t, kMaxPacket> packet;
  Seat to = 0;
  while (const std::uint32_t size = reader.next(to, packet)) {
    // The sender's seat is in the packet's first byte.
    const Seat seat = packet[0] >> 4;
    packet[0] &= 15;
    const bool passes = takeSeat(seat, from) && to != seat && players[to].known &&
                        players[to].line.queue.add(seat, std::span(packet).first(size));
    refused += passes ? 0 : 1;
  }
  refused += reader.good() ? 0 : 1;
}

Relay::Relay(const Transport& transport) : impl_(nullptr) {
  require(transport);
  impl_ = new Impl;
  impl_->transport = transport;
}
Relay::~Relay() { delete impl_; }

void Relay::update(std::uint64_t now) {
  impl_->now = std::max(impl_->now, now);
  std::array<std::uint8_t, kMaxDatagram> bytes;
  Address from = 0;
  for (int i = 0; i < kMostReceived; ++i) {
    const std::uint32_t size = impl_->transport.receive(from, bytes, impl_->transport.data);
    if (size == 0) break;
    impl_->receive(from, std::span(bytes).first(size));
  }
  for (Impl::Player& player : impl_->players) {
    if (player.line.due(impl_->now)) player.line.flush(impl_->now, impl_->transport, player.address);
  }
}

std::uint32_t Relay::seats() const {
  return static_cast<std::uint32_t>(std::count_if(
      impl_->players.begin(), impl_->players.end(),
      [this](const Impl::Player& player) { return player.known && impl_->now - player.lastHeard <= kGone; }));
}
std::uint64_t Relay::sentPackets() const {
  std::uint64_t sum = 0;
  for (const Impl::Player& player : impl_->players) sum += player.line.packets;
  return sum;
}
std::uint64_t Relay::sentBytes() const {
  std::uint64_t sum = 0;
  for (const Impl::Player& player : impl_->players) sum += player.line.bytes;
  return sum;
}
std::uint64_t Relay::refused() const { return impl_->refused; }

struct RelayTransport::Impl {
  Transport below;
  Address relay = 0;
  Line line;
  /// The bundle that is being read.
  std::array<std::uint8_t, kMaxDatagram> arrived{};
  BundleReader reader;
};

RelayTransport::RelayTransport(const Transport& below, Address relay, Seat seat) : impl_(nullptr) {
  require(below);
  samestep::require<Fault::ValueOutOfRange>(seat < kMaxPlayers, "There is no such seat.");
  impl_ = new Impl;
  impl_->below = below;
  impl_->relay = relay;
}
RelayTransport::~RelayTransport() { delete impl_; }

void RelayTransport::update(std::uint64_t now) {
  if (impl_->line.due(now)) impl_->line.flush(now, impl_->below, impl_->relay);
}

void RelayTransport::send(Address to, std::span<const std::uint8_t> bytes) {
  if (to >= 1 && to <= kMaxPlayers) impl_->line.queue.add(static_cast<Seat>(to - 1), bytes);
}

std::uint32_t RelayTransport::receive(Address& from, std::span<std::uint8_t> into) {
  for (int i = 0; i < kMostReceived; ++i) {
    Seat seat = 0;
    if (const std::uint32_t size = impl_->reader.next(seat, into)) {
      // The relay says by whom it is, and has left that out.
      into[0] = static_cast<std::uint8_t>((into[0] & 15) | seat << 4);
      from = address(seat);
      return size;
    }
    Address sender = 0;
    const std::uint32_t size = impl_->below.receive(sender, impl_->arrived, impl_->below.data);
    if (size == 0) return 0;
    if (sender != impl_->relay) continue;
    impl_->reader = BundleReader(std::span(impl_->arrived).first(std::min(size, kMaxDatagram)));
  }
  return 0;
}

Transport RelayTransport::transport() {
  return {this,
          [](Address to, std::span<const std::uint8_t> bytes, void* data) {
            static_cast<RelayTransport*>(data)->send(to, bytes);
          },
          [](Address& from, std::span<std::uint8_t> into, void* data) {
            return static_cast<RelayTransport*>(data)->receive(from, into);
          }};
}

std::uint64_t RelayTransport::sentPackets() const { return impl_->line.packets; }
std::uint64_t RelayTransport::sentBytes() const { return impl_->line.bytes; }

}  // namespace samestep
