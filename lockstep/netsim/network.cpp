// SPDX-License-Identifier: MIT
#include "netsim/network.h"

#include <algorithm>

namespace samestep::netsim {

namespace {

constexpr std::uint32_t kInbox = 4096;
/// IP and UDP.
constexpr std::uint32_t kOverhead = 28;

}  // namespace

Network::Network(std::uint32_t count, std::uint64_t seed)
    : random_(seed), links_(count * count), inboxes_(count) {}

bool Network::loses(Link& link, std::uint32_t bytes) {
  link.bad = link.bad ? !random_.perMille(link.profile.toGood) : random_.perMille(link.profile.toBad);
  const std::uint32_t chance = link.bad ? link.profile.lossBad : link.profile.loss;
  bool lost = false;
  for (std::uint32_t piece = 0; piece <= bytes; piece += link.profile.piece) lost |= random_.perMille(chance);
  return lost;
}

void Network::send(Address from, Address to, std::span<const std::uint8_t> bytes, Time now) {
  Link& path = link(from, to);
  const LinkProfile& profile = path.profile;
  const auto size = static_cast<std::uint32_t>(bytes.size()) + kOverhead;
  ++sent_;
  bool lost = loses(path, size) || path.blocked;
  Time leaves = now;
  if (profile.bandwidth != 0) {
    const Time waits = path.busyUntil > now ? path.busyUntil - now : 0;
    lost |= waits * profile.bandwidth / 1'000'000 > profile.queue;
    if (!lost) path.busyUntil = leaves = now + waits + Time{size} * 1'000'000 / profile.bandwidth;
  }
  if (random_.perMille(profile.burst)) path.heldUntil = now + profile.burstLasts;
  if (lost) {
    ++lost_;
    return;
  }
  leaves = std::max(leaves, path.heldUntil);
  const auto jitter = [&] {
    return profile.jitter == 0 ? 0 : random_.below(static_cast<std::uint32_t>(profile.jitter));
  };
  travel(from, to, bytes, leaves + profile.delay + jitter());
  if (!random_.perMille(profile.duplicate)) return;
  ++duplicated_;
  travel(from, to, bytes, leaves + profile.delay + jitter());
}

void Network::travel(Address from, Address to, std::span<const std::uint8_t> bytes, Time arrives) {
  Travelling travelling{to, {from, {bytes.begin(), bytes.end()}}};
  const std::uint32_t corrupt = link(from, to).profile.corrupt;
  if (corrupt != 0 && random_.perMille(corrupt)) spoil(travelling.datagram.bytes);
  // The second number is never used twice: a duplicate is counted too.
  travelling_.emplace(std::pair{arrives, sent_ * 2 + travelling_.count({arrives, sent_ * 2})},
                      std::move(travelling));
}

void Network::spoil(std::vector<std::uint8_t>& bytes) {
  ++spoilt_;
  const std::uint32_t what = random_.below(4);
  const auto size = static_cast<std::uint32_t>(bytes.size());
  if (what == 0) bytes.resize(random_.below(size + 1));
  if (what == 1) bytes.push_back(static_cast<std::uint8_t>(random_.next()));
  if (bytes.empty() || what < 2) return;
  std::uint8_t& byte = bytes[random_.below(size)];
  byte = static_cast<std::uint8_t>(byte ^ 1u << random_.below(8));
}

void Network::deliver(Time now) {
  while (!travelling_.empty() && travelling_.begin()->first.first <= now) {
    auto node = travelling_.extract(travelling_.begin());
    std::deque<Datagram>& box = inboxes_[node.mapped().to];
    if (box.size() < kInbox) box.push_back(std::move(node.mapped().datagram));
  }
}

}  // namespace samestep::netsim
