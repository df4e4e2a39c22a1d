// SPDX-License-Identifier: MIT
// A network in virtual time.
#pragma once

#include <samestep/transport.h>

#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "netsim/random.h"

namespace samestep::netsim {

/// Microseconds of virtual time.
using Time = std::uint64_t;

/// Treatment of datagrams in one direction between two peers. Chances are in thousandths.
struct LinkProfile {
  Time delay = 20'000;
  Time jitter = 0;  ///< Added to the delay, evenly spread: datagrams overtake each other.
  std::uint32_t loss = 0;
  // Gilbert and Elliott: in the bad state, lossBad are lost instead.
  std::uint32_t lossBad = 0;
  std::uint32_t toBad = 0;
  std::uint32_t toGood = 100;
  std::uint32_t duplicate = 0;
  /// Now and then everything is held up for so long, then comes at once.
  std::uint32_t burst = 0;
  Time burstLasts = 0;
  /// Bytes a second, and in how long a queue: 0 for no limit. What does not fit is lost.
  std::uint32_t bandwidth = 0;
  std::uint32_t queue = 0;
  /// Datagrams of more bytes travel in pieces, each of which may be lost.
  std::uint32_t piece = 576;
  /// Chance that a bit or the length of a datagram is changed on the way.
  std::uint32_t corrupt = 0;
};

struct Datagram {
  Address from = 0;
  std::vector<std::uint8_t> bytes;
};

/// Directed links between nodes 0 to count - 1, whose addresses are their numbers.
class Network {
 public:
  Network(std::uint32_t count, std::uint64_t seed);

  LinkProfile& profile(Address from, Address to) { return link(from, to).profile; }
  /// Loses everything that is sent.
  void block(Address from, Address to, bool blocked) { link(from, to).blocked = blocked; }
  void send(Address from, Address to, std::span<const std::uint8_t> bytes, Time now);
  /// Moves what has arrived by then to the inboxes.
  void deliver(Time now);
  /// An inbox takes 4096 datagrams; more are lost.
  std::deque<Datagram>& inbox(Address node) { return inboxes_[node]; }

  std::uint64_t sent() const { return sent_; }
  std::uint64_t lost() const { return lost_; }
  std::uint64_t duplicated() const { return duplicated_; }
  std::uint64_t spoilt() const { return spoilt_; }

 private:
  struct Link {
    LinkProfile profile;
    bool blocked = false;
    bool bad = false;
    Time heldUntil = 0;
    Time busyUntil = 0;
  };
  struct Travelling {
    Address to = 0;
    Datagram datagram;
  };
  Link& link(Address from, Address to) { return links_[from * inboxes_.size() + to]; }
  bool loses(Link& link, std::uint32_t bytes);
  void travel(Address from, Address to, std::span<const std::uint8_t> bytes, Time arrives);
  void spoil(std::vector<std::uint8_t>& bytes);

  Random random_;
  std::vector<Link> links_;
  std::vector<std::deque<Datagram>> inboxes_;
  /// Datagrams by time of arrival, then in the order in which they were sent.
  std::map<std::pair<Time, std::uint64_t>, Travelling> travelling_;
  std::uint64_t sent_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t duplicated_ = 0;
  std::uint64_t spoilt_ = 0;
};

}  // namespace samestep::netsim
