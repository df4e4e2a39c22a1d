// SPDX-License-Identifier: MIT
#include "netsim/oracle.h"

#include <algorithm>

namespace samestep::netsim {
namespace {

bool survives(const Peer& peer) { return peer.running(); }

/// The first event of a kind that a peer told of a seat, or null.
const SessionEvent* eventOf(const Peer& peer, SessionEvent::Kind kind, Seat seat) {
  const auto found = std::find_if(peer.events().begin(), peer.events().end(), [&](const SessionEvent& event) {
    return event.kind == kind && (seat == kNoSeat || event.seat == seat);
  });
  return found == peer.events().end() ? nullptr : &*found;
}

/// The first tick from which somebody was agreed to be gone. Whoever was dropped may be sure of more than
/// that.
Tick firstDrop(const Peer& reference) {
  Tick first = 0xffffffffu;
  for (const SessionEvent& event : reference.events()) {
    if (event.kind == SessionEvent::Kind::dropped) first = std::min(first, event.tick);
  }
  return first;
}

/// Each detector has compared hashes, and told, after so many ticks.
constexpr Tick kSeen = 120;

/// True if two peers had other states after each of so many steps: some faults heal.
bool differFor(const Peer& a, const Peer& b, Tick from, Tick ticks) {
  if (std::min(a.certain(), b.certain()) < from + ticks) return false;
  if (std::max(a.first(), b.first()) > from) return false;
  Tick tick = from + 1;
  while (tick < from + ticks && a.record(tick).state != b.record(tick).state) ++tick;
  return tick == from + ticks;
}

std::string nameOf(Tick seat) { return "peer " + std::to_string(seat); }

}  // namespace

void Oracle::violate(const std::string& text) { report_.violations.push_back(text); }

/// Requires that what is certain is the same everywhere.
void Oracle::states(const Oracle::Peers& peers, const Peer& reference) {
  const Tick agreed = firstDrop(reference);
  for (const auto& of : peers) {
    const Peer& peer = *of;
    if (peer.misused()) violate(nameOf(peer.seat()) + " was asked to step from a state that it did not have");
    // A peer that has left need not know who comes afterwards.
    const SessionEvent* left = eventOf(peer, SessionEvent::Kind::left, peer.seat());
    const Tick knows = survives(peer) ? kNever : std::min(agreed, left == nullptr ? kNever : left->tick);
    const Tick to = std::min({peer.certain(), reference.certain(), knows});
    for (Tick tick = std::max(peer.first(), reference.first()); tick < to; ++tick) {
      const TickRecord &a = peer.record(tick), &b = reference.record(tick);
      if (a.inputs == b.inputs && a.state == b.state) continue;
      violate(nameOf(peer.seat()) + (a.inputs != b.inputs ? ": inputs" : ": states") + " of tick " +
              std::to_string(tick) + " differ");
      break;
    }
  }
}

/// The tick after the last one of a peer's time in its seat.
Tick Oracle::endOf(const Oracle::Peers& peers, std::size_t index, const Peer& reference) {
  for (std::size_t later = index + 1; later < peers.size(); ++later) {
    if (peers[later]->seat() == peers[index]->seat())
      return std::min(peers[later]->start(), reference.certain());
  }
  return reference.certain();
}

/// Requires that what players did arrived, once, in its order, and nothing else.
void Oracle::inputs(const Oracle::Peers& peers, const Peer& reference) {
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const Peer& peer = *peers[i];
    const Seat seat = peer.seat();
    std::uint32_t held = 0;
    std::uint32_t commands = 0;
    if (peer.start() < reference.first()) continue;
    for (Tick tick = peer.start(); tick < endOf(peers, i, reference); ++tick) {
      const TickRecord& record = reference.record(tick);
      if (record.held[seat] != 0 && record.held[seat] < held) {
        return violate("what " + nameOf(seat) + " holds goes back at tick " + std::to_string(tick));
      }
      held = std::max(held, record.held[seat]);
      if (record.command[seat] == 0) continue;
      if (record.command[seat] != commands + 1) {
        return violate("of " + nameOf(seat) + " command " + std::to_string(record.command[seat]) +
                       " came after " + std::to_string(commands) + " at tick " + std::to_string(tick));
      }
      ++commands;
    }
    const bool all = survives(peer) || eventOf(reference, SessionEvent::Kind::left, seat) != nullptr;
    if (held > peer.heldGiven() || commands > peer.commandsGiven() ||
        (all && commands < peer.commandsGiven())) {
      violate(nameOf(seat) + " gave " + std::to_string(peer.commandsGiven()) + " commands, of which " +
              std::to_string(commands) + " were applied");
    }
  }
}

/// The detector is silent where all is well, and speaks on both sides where not.
void Oracle::detector(const MatchOptions& options, const Oracle::Peers& peers, Seat plantedSeat,
                      Tick plantedTick) {
  for (const auto& peer : peers) {
    const SessionEvent* event = eventOf(*peer, SessionEvent::Kind::desync, kNoSeat);
    if (event == nullptr) continue;
    report_.desynced |= 1u << peer->seat();
    report_.desyncTick = report_.desyncTick == 0 ? event->tick : std::min(report_.desyncTick, event->tick);
  }
  for (const auto& peer : peers) {
    const DesyncReport* found = peer->session().desync();
    if (found == nullptr) continue;
    report_.findings.push_back(nameOf(peer->seat()) + ": " + desyncText(*found));
    // Neither is most, where there are two.
    const std::uint32_t guilty = options.peers > 2 ? 1u << plantedSeat : 0;
    const bool named = std::string(found->ours.object) == peer->flipped() && found->minority == guilty;
    if (named) report_.named |= 1u << peer->seat();
  }
  if (options.planted == Planted::none) {
    if (report_.desynced != 0) violate("a false desync at tick " + std::to_string(report_.desyncTick));
    return;
  }
  // The first peers are those of the start, by seat.
  const Peer& planted = *peers[plantedSeat];
  if (options.planted == Planted::lies) return liar(peers, planted, plantedTick);
  if (!survives(planted) || report_.violations.empty()) return;
  for (const auto& peer : peers) {
    const auto lasts = [&](const auto& other) {
      return survives(*other) && differFor(*other, planted, plantedTick, kSeen);
    };
    const bool guilty = peer.get() == &planted;
    const bool shows = guilty ? std::any_of(peers.begin(), peers.end(), lasts) : lasts(peer);
    if (!survives(*peer) || !shows) continue;
    const bool sees = eventOf(*peer, SessionEvent::Kind::desync, guilty ? kNoSeat : plantedSeat) != nullptr;
    if (!sees) violate(nameOf(peer->seat()) + " did not notice the desync");
  }
}

/// States are the same, and yet everybody is told otherwise by one.
void Oracle::liar(const Oracle::Peers& peers, const Peer& planted, Tick from) {
  if (report_.desynced != 0) {
    violate(nameOf(planted.seat()) + " tells hashes of states that it does not have");
  }
  for (const auto& peer : peers) {
    const bool heard = survives(*peer) && survives(planted) && peer.get() != &planted &&
                       std::min(peer->certain(), planted.certain()) > from + kSeen;
    if (heard && eventOf(*peer, SessionEvent::Kind::desync, planted.seat()) == nullptr) {
      violate(nameOf(peer->seat()) + " did not notice the liar");
    }
  }
}

/// Once the faults are over, the match goes on to its end.
void Oracle::progress(const MatchOptions& options, const Oracle::Peers& peers) {
  for (const auto& peer : peers) {
    if (!survives(*peer) || peer->certain() >= options.ticks) continue;
    violate(nameOf(peer->seat()) + " is sure of " + std::to_string(peer->certain()) + " ticks only, of " +
            std::to_string(options.ticks));
  }
}

void Oracle::endings(const Oracle::Peers& peers) {
  for (const auto& of : peers) {
    const Peer& peer = *of;
    const Seat seat = peer.seat();
    if (peer.running() || peer.crashed()) continue;
    const EndReason reason = peer.ended();
    if (reason == EndReason::left) {
      ++report_.left;
    } else if ((excused_ >> seat & 1) != 0) {
      ++report_.dropped;
    } else {
      violate(nameOf(seat) + " ended without a cause: " + endReasonName(reason));
    }
  }
}

void Oracle::count(const MatchOptions& options, const Oracle::Peers& peers, const Peer& reference) {
  for (const auto& peer : peers) {
    const SessionStats& stats = peer->session().stats();
    report_.survivors += survives(*peer) ? 1 : 0;
    report_.dropped += peer->crashed() ? 1 : 0;
    report_.steps += stats.steps;
    report_.rollbacks += stats.rollbacks;
    report_.deepest = std::max(report_.deepest, stats.deepest);
    report_.waited += stats.waited;
    report_.payload += stats.sentBytes;
    for (const SessionEvent& event : peer->events()) {
      report_.refused += event.kind == SessionEvent::Kind::lied ? 1 : 0;
    }
    const bool newcomer = peer->start() != 0 && peer->start() != kNever;
    const bool again = newcomer && peer->seat() < options.peers;
    report_.joined += newcomer ? 1 : 0;
    report_.rejoined += again ? 1 : 0;
  }
  for (Tick tick = reference.first(); tick < reference.certain(); ++tick) {
    const TickRecord& record = reference.record(tick);
    report_.trace = lockstep::mix(report_.trace * 31 + record.inputs + record.state);
  }
}

MatchReport Oracle::judge(const MatchOptions& options, const Oracle::Peers& peers, Seat plantedSeat,
                          Tick plantedTick) {
  const Peer* reference = nullptr;
  for (const auto& peer : peers) {
    if (!survives(*peer)) continue;
    // A peer that was there from the start knows all.
    const bool better = reference == nullptr || peer->first() < reference->first() ||
                        (peer->first() == reference->first() && peer->certain() > reference->certain());
    if (better) reference = peer.get();
  }
  endings(peers);
  if (reference == nullptr) {
    // One of two may leave and the other be gone.
    if (report_.left == 0 && excused_ == 0) violate("nobody is left");
    return report_;
  }
  states(peers, *reference);
  detector(options, peers, plantedSeat, plantedTick);
  inputs(peers, *reference);
  progress(options, peers);
  count(options, peers, *reference);
  return report_;
}

}  // namespace samestep::netsim
