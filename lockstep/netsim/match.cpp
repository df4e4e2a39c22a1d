// SPDX-License-Identifier: MIT
#include "netsim/match.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "netsim/oracle.h"
#include "netsim/peer.h"

namespace samestep::netsim {
namespace {

constexpr Time kSecond = 1'000'000;
/// Strangers' datagrams come from here.
constexpr Address kNobody = kMaxPlayers;
/// Node of seat 0's peer once it has moved; the other seats follow.
constexpr Address kElsewhere = kMaxPlayers + 1;
constexpr std::uint32_t kNodes = kRelayNode + 1;
constexpr Time kRelayEvery = 4000;

/// Relay at a node of its own.
class RelayNode {
 public:
  RelayNode(std::uint64_t match, Network& network) : network_(network), seal_(match, kRelayName) {}

  void update(Time now) {
    now_ = now;
    relay_.update(now);
  }
  Time next() const { return now_ + kRelayEvery; }
  const Relay& relay() const { return relay_; }

 private:
  Transport transport() {
    return {this,
            [](Address to, std::span<const std::uint8_t> bytes, void* data) {
              auto& self = *static_cast<RelayNode*>(data);
              std::array<std::uint8_t, kMaxDatagram> sealed;
              self.seal_.close(bytes, sealed);
              self.network_.send(kRelayNode, self.seal_.nodeOf(to),
                                 std::span(sealed).first(bytes.size() + Seal::kBytes), self.now_);
            },
            [](Address& from, std::span<std::uint8_t> into, void* data) {
              auto& self = *static_cast<RelayNode*>(data);
              auto& box = self.network_.inbox(kRelayNode);
              std::uint32_t size = 0;
              while (size == 0 && !box.empty()) {
                size = self.seal_.open(box.front(), from, into);
                box.pop_front();
              }
              return size;
            }};
  }

  Network& network_;
  Seal seal_;
  Time now_ = 0;
  Relay relay_{transport()};
};

/// Something that happens once.
struct Happening {
  enum class Kind : std::uint8_t { partition, heal, stall, crash, leave, change, pause, join, rejoin, move };
  Time time = 0;
  Kind kind = Kind::heal;
  Seat seat = 0;
  Time lasts = 0;
  std::uint32_t seats = 0;
};

class Match {
 public:
  explicit Match(const MatchOptions& options)
      : options_(options),
        random_(lockstep::mix(options.seed) + options.peers),
        network_(kNodes, random_.next()),
        seats_(options.peers) {
    if (has(kJoin)) seats_ += random_.within(0, std::min(2u, kMaxPlayers - options.peers));
    shapeLinks();
    addPeers();
    plan();
    plant();
  }

  MatchReport run();

 private:
  bool has(Fault fault) const { return (options_.faults & fault) != 0; }
  void shapeLinks();
  void addPeers();
  SessionSettings settingsOf(Seat seat, bool joins);
  void addPeer(const SessionSettings& settings, Time from);
  /// Peer that has a seat now, or had it last.
  Peer* peerAt(Seat seat) const;
  void plan();
  void plant();
  void happen(const Happening& happening);
  void change(Session& session);
  void partition(std::uint32_t seats, bool blocked);
  void disturb(Time now);
  bool finished() const;

  const MatchOptions& options_;
  Random random_;
  Network network_;
  std::uint32_t seats_;
  SessionSettings common_;
  Seat liar_ = kNoSeat;
  std::unique_ptr<RelayNode> relay_;
  std::vector<std::unique_ptr<Peer>> peers_;
  std::vector<Happening> plan_;
  Oracle oracle_;
  std::uint32_t moved_ = 0;
  Tick plantedTick_ = 0;
  Seat plantedSeat_ = 0;
};

void Match::shapeLinks() {
  const Time delay = random_.within(1, 80) * 1000;
  for (Address from = 0; from < seats_; ++from) {
    for (Address to = 0; to < seats_; ++to) {
      LinkProfile& profile = network_.profile(from, to);
      profile.delay = delay + random_.below(10'000);
      if (options_.delay != MatchOptions::kBySeed) profile.delay = options_.delay * 1000;
      if (options_.loss != MatchOptions::kBySeed) profile.loss = options_.loss * 10;
      if (has(kAsymmetric) && from < to) profile.delay += random_.below(60'000);
      if (has(kCorrupt)) profile.corrupt = random_.below(30);
      if (!has(kLoss)) continue;
      profile.jitter = random_.below(30'000);
      profile.loss = random_.below(60);
      profile.lossBad = random_.within(200, 700);
      profile.toBad = random_.below(20);
      profile.duplicate = random_.below(50);
      profile.burst = random_.below(8);
      profile.burstLasts = random_.below(150) * 1000;
      if (random_.perMille(200)) {
        profile.bandwidth = 40'000;
        profile.queue = 8'000;
      }
    }
  }
  for (Address node = 0; node < seats_; ++node) {
    LinkProfile half = network_.profile(node, (node + 1) % seats_);
    half.delay /= 2;
    half.jitter /= 2;
    for (const Address at : {node, node + kElsewhere}) {
      network_.profile(at, kRelayNode) = network_.profile(kRelayNode, at) = half;
    }
  }
  // A peer that has moved has the same path as before.
  for (Address from = 0; from < seats_; ++from) {
    for (Address to = 0; to < seats_; ++to) {
      const LinkProfile profile = network_.profile(from, to);
      network_.profile(from + kElsewhere, to) = profile;
      network_.profile(from, to + kElsewhere) = profile;
      network_.profile(from + kElsewhere, to + kElsewhere) = profile;
    }
  }
}

void Match::addPeers() {
  common_.match = static_cast<std::uint32_t>(options_.seed);
  common_.players = static_cast<std::uint8_t>(options_.peers);
  common_.maxPlayers = static_cast<std::uint8_t>(seats_);
  common_.maxHeldBytes = 4;
  common_.maxCommandBytes = 16;
  // Most games keep the usual one.
  if (random_.perMille(500)) common_.hashInterval = static_cast<std::uint16_t>(random_.within(1, 60));
  for (Seat seat = 0; seat < seats_; ++seat) {
    common_.addresses[seat] = options_.relay ? RelayTransport::address(seat) : seat;
  }
  if (options_.relay) relay_ = std::make_unique<RelayNode>(common_.match, network_);
  // Two peers could not say who of them lies.
  if (has(kLie) && options_.peers > 2) liar_ = static_cast<Seat>(random_.below(options_.peers));
  for (Seat seat = 0; seat < options_.peers; ++seat) addPeer(settingsOf(seat, false), random_.below(200'000));
}

SessionSettings Match::settingsOf(Seat seat, bool joins) {
  SessionSettings settings = common_;
  settings.localSeat = seat;
  settings.joins = joins;
  settings.window = static_cast<std::uint8_t>(random_.perMille(200) ? 0 : random_.within(1, kMaxWindow));
  settings.inputDelay = static_cast<std::uint8_t>(random_.within(settings.window == 0 ? 3 : 0, 8));
  settings.saving = random_.perMille(400) ? Saving::sparse : Saving::everyStep;
  settings.prediction = random_.perMille(200) ? Prediction::nothing : Prediction::repeatLast;
  settings.runAhead = static_cast<std::uint8_t>(random_.perMille(200) ? random_.within(1, kMaxRunAhead) : 0);
  return settings;
}

void Match::addPeer(const SessionSettings& settings, Time from) {
  peers_.push_back(std::make_unique<Peer>(settings, options_, network_, random_.next()));
  peers_.back()->stallUntil(from);
  for (Seat other = 0; other < seats_; ++other) {
    const Peer* there = other == settings.localSeat ? nullptr : peerAt(other);
    if (there != nullptr) peers_.back()->seal().place(other, there->node());
  }
  if (settings.localSeat == liar_) peers_.back()->lie();
  if (!has(kDrift)) return;
  peers_.back()->setDrift(static_cast<std::int32_t>(random_.within(0, 300)) - 150, random_.next() >> 24);
}

Peer* Match::peerAt(Seat seat) const {
  Peer* found = nullptr;
  for (const auto& peer : peers_) {
    if (peer->seat() == seat) found = peer.get();
  }
  return found;
}

/// Plans what happens, so that at no time half of the peers are gone.
void Match::plan() {
  using Kind = Happening::Kind;
  const Time length = Time{options_.ticks} * kSecond / 60;
  const auto when = [&] { return length / 10 + random_.next() % (length * 6 / 10 + 1); };
  const auto seat = [&] { return static_cast<Seat>(random_.below(options_.peers)); };
  // Seat 0 breaks ties, and stays.
  const auto mayGo = [&] { return static_cast<Seat>(random_.within(1, options_.peers - 1)); };
  const bool leaves = has(kLeave) && random_.perMille(500);
  if (leaves) plan_.push_back({when(), Kind::leave, seat(), 0, 0});
  // So many of those who vote then may vanish.
  std::uint32_t spare = (options_.peers - (leaves ? 2 : 1)) / 2;
  if (has(kCrash) && spare > 0 && random_.perMille(600)) {
    --spare;
    plan_.push_back({when(), Kind::crash, mayGo(), 0, 0});
    if (has(kRejoin)) {
      const Time after = random_.below(8000) * 1000;
      plan_.push_back({plan_.back().time + after, Kind::rejoin, plan_.back().seat, 0, 0});
    }
  }
  for (Seat late = static_cast<Seat>(options_.peers); late < seats_; ++late)
    plan_.push_back({when(), Kind::join, late, 0, 0});
  for (std::uint32_t i = 0; has(kStall) && i < 2; ++i) {
    // Now and then long enough to be dropped.
    const bool dropped = spare > 0 && random_.perMille(200);
    if (dropped) --spare;
    plan_.push_back({when(), Kind::stall, dropped ? mayGo() : seat(),
                     random_.below(2000) * 1000 + (dropped ? 6 * kSecond : 0), 0});
    const Happening stall = plan_.back();
    if (dropped && has(kRejoin)) {
      plan_.push_back(
          {stall.time + stall.lasts + random_.below(3000) * 1000, Kind::rejoin, stall.seat, 0, 0});
    }
  }
  for (std::uint32_t i = 0; has(kChange) && i < 8 * options_.peers; ++i)
    plan_.push_back({when(), Kind::change, seat(), 0, 0});
  if (has(kChange)) plan_.push_back({when(), Kind::pause, seat(), random_.below(3000) * 1000, 0});
  if (has(kMove)) plan_.push_back({when(), Kind::move, seat(), 0, 0});
  if (has(kPartition)) {
    const bool dropped = spare > 0 && random_.perMille(300);
    const Time start = when();
    const Time lasts = random_.below(2000) * 1000 + (dropped ? 5 * kSecond : 0);
    const std::uint32_t seats = 1u << mayGo();
    plan_.push_back({start, Kind::partition, 0, lasts, seats});
    plan_.push_back({start + lasts, Kind::heal, 0, 0, seats});
  }
  for (const Happening& happening : plan_) {
    if (happening.kind == Kind::stall || happening.kind == Kind::crash) oracle_.excuse(happening.seat);
    for (Seat i = 0; i < options_.peers; ++i) {
      if ((happening.seats >> i & 1) != 0) oracle_.excuse(i);
    }
  }
  std::stable_sort(plan_.begin(), plan_.end(),
                   [](const Happening& a, const Happening& b) { return a.time < b.time; });
}

void Match::plant() {
  if (options_.planted == Planted::none) return;
  plantedSeat_ = static_cast<Seat>(random_.below(options_.peers));
  plantedTick_ = random_.within(options_.ticks / 4, options_.ticks / 2);
  peers_[plantedSeat_]->plant(options_.planted, plantedTick_);
}

void Match::partition(std::uint32_t seats, bool blocked) {
  for (Address node = 0; node < seats_; ++node) {
    if ((seats >> node & 1) == 0) continue;
    for (const Address at : {node, node + kElsewhere}) {
      network_.block(at, kRelayNode, blocked);
      network_.block(kRelayNode, at, blocked);
    }
  }
  for (Address from = 0; from < seats_; ++from) {
    for (Address to = 0; to < seats_; ++to) {
      if ((seats >> from & 1) == (seats >> to & 1)) continue;
      for (const Address a : {from, from + kElsewhere}) {
        for (const Address b : {to, to + kElsewhere}) network_.block(a, b, blocked);
      }
    }
  }
}

void Match::change(Session& session) {
  const auto value = [&](std::uint32_t most) { return static_cast<std::uint8_t>(random_.within(0, most)); };
  switch (random_.below(4)) {
    case 0:
      session.setInputDelay(value(10));
      break;
    case 1:
      session.setRunAhead(value(random_.perMille(700) ? 0 : kMaxRunAhead));
      break;
    case 2:
      session.setSaving(random_.perMille(500) ? Saving::sparse : Saving::everyStep);
      break;
    default:
      session.setWindow(value(kMaxWindow));
      if (session.window() == 0 && session.inputDelay() < 3) session.setInputDelay(3);
  }
}

void Match::happen(const Happening& happening) {
  if (happening.kind == Happening::Kind::join) {
    return addPeer(settingsOf(happening.seat, true), happening.time);
  }
  Peer& peer = *peerAt(happening.seat);
  switch (happening.kind) {
    case Happening::Kind::partition:
      return partition(happening.seats, true);
    case Happening::Kind::heal:
      return partition(happening.seats, false);
    case Happening::Kind::stall:
      return peer.stallUntil(happening.time + happening.lasts);
    case Happening::Kind::crash:
      return peer.crash();
    case Happening::Kind::leave:
      return peer.session().leave();
    case Happening::Kind::change:
      return change(peer.session());
    case Happening::Kind::pause:
      return peer.pauseUntil(happening.time + happening.lasts);
    case Happening::Kind::move:
      moved_ += peer.running() && peer.node() == peer.seat() ? 1 : 0;
      peer.moveTo(peer.seat() + kElsewhere);
      // Nobody but the lobby can tell a newcomer that nobody has heard yet.
      for (const auto& other : peers_) {
        if (other->session().state() == SessionState::joining) other->seal().place(peer.seat(), peer.node());
      }
      return;
    case Happening::Kind::rejoin:
      if (!peer.running() && peer.ended() != EndReason::left) {
        addPeer(settingsOf(happening.seat, true), happening.time);
      }
      return;
    case Happening::Kind::join:
      return;
  }
}

/// Strangers' bytes, and datagrams heard on the way that come again.
void Match::disturb(Time now) {
  if (!has(kHostile) || !random_.perMille(300)) return;
  const Address to = random_.below(seats_);
  auto& box = network_.inbox(to);
  if (!box.empty() && random_.perMille(500)) {
    network_.send(box.front().from, to, std::vector(box.front().bytes), now);
    return;
  }
  // Half of the strangers have a key of the match, as those who only watch might.
  std::vector<std::uint8_t> bytes(random_.within(Seal::kBytes + 1, kMaxPacket));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random_.next());
  if (random_.perMille(500)) bytes[Seal::kBytes] &= 15;
  if (random_.perMille(500)) {
    Seal stranger(common_.match, kNobody);
    const std::vector<std::uint8_t> inner(bytes.begin() + Seal::kBytes, bytes.end());
    stranger.close(inner, bytes);
  }
  network_.send(kNobody, to, bytes, now);
}

/// True if all who still play are sure of the last tick.
bool Match::finished() const {
  return std::all_of(peers_.begin(), peers_.end(),
                     [&](const auto& peer) { return !peer->running() || peer->certain() >= options_.ticks; });
}

MatchReport Match::run() {
  // Pure lockstep with a short delay over a long path goes on slowly.
  const Time limit = Time{options_.ticks} * kSecond / 8 + 60 * kSecond;
  const Tick quietFrom = options_.ticks > 120 ? options_.ticks - 120 : 0;
  std::size_t planned = 0;
  Time now = 0;
  while (now < limit && !finished()) {
    Peer* next = nullptr;
    for (const auto& peer : peers_) {
      if (peer->running() && (next == nullptr || peer->next() < next->next())) next = peer.get();
    }
    if (next == nullptr) break;
    if (relay_ != nullptr && relay_->next() < next->next()) {
      now = std::max(now, relay_->next());
      network_.deliver(now);
      relay_->update(now);
      continue;
    }
    now = std::max(now, next->next());
    if (planned < plan_.size() && plan_[planned].time <= now) {
      happen(plan_[planned++]);
      continue;
    }
    disturb(now);
    network_.deliver(now);
    next->frame(now, next->session().tick() >= quietFrom);
  }
  MatchReport report = oracle_.judge(options_, peers_, plantedSeat_, plantedTick_);
  report.milliseconds = now / 1000;
  report.peers = options_.peers;
  report.datagrams = network_.sent();
  report.lost = network_.lost();
  report.spoilt = network_.spoilt();
  report.moved = moved_;
  for (const auto& peer : peers_) {
    report.forged += peer->seal().forged();
    if (peer->relayed() == nullptr) continue;
    report.upDatagrams += peer->relayed()->sentPackets();
    report.up += peer->relayed()->sentBytes();
  }
  if (relay_ != nullptr) {
    report.downDatagrams = relay_->relay().sentPackets();
    report.down = relay_->relay().sentBytes();
  }
  return report;
}

}  // namespace

MatchReport runMatch(const MatchOptions& options) { return Match(options).run(); }

MatchOptions shrink(const MatchOptions& failing) {
  MatchOptions best = failing;
  const auto fails = [](const MatchOptions& options) { return !runMatch(options).violations.empty(); };
  const auto tryIt = [&](MatchOptions smaller) {
    if (fails(smaller)) best = smaller;
  };
  for (std::uint32_t fault = 1; fault <= kAllFaults; fault <<= 1) {
    MatchOptions smaller = best;
    smaller.faults &= ~fault;
    if (smaller.faults != best.faults) tryIt(smaller);
  }
  while (best.peers > 2) {
    MatchOptions smaller = best;
    --smaller.peers;
    if (!fails(smaller)) break;
    best = smaller;
  }
  while (best.ticks >= 120) {
    MatchOptions smaller = best;
    smaller.ticks /= 2;
    if (!fails(smaller)) break;
    best = smaller;
  }
  return best;
}

namespace {

constexpr std::array<std::pair<const char*, std::uint32_t>, 15> kFaultNames{{{"loss", kLoss},
                                                                             {"partition", kPartition},
                                                                             {"stall", kStall},
                                                                             {"crash", kCrash},
                                                                             {"leave", kLeave},
                                                                             {"change", kChange},
                                                                             {"drift", kDrift},
                                                                             {"hostile", kHostile},
                                                                             {"asymmetric", kAsymmetric},
                                                                             {"join", kJoin},
                                                                             {"rejoin", kRejoin},
                                                                             {"lie", kLie},
                                                                             {"corrupt", kCorrupt},
                                                                             {"move", kMove},
                                                                             {"all", kAllFaults}}};

}  // namespace

std::uint32_t faultNamed(const std::string& name) {
  for (const auto& [known, fault] : kFaultNames) {
    if (name == known) return fault;
  }
  return 0;
}

std::string faultNames(std::uint32_t faults) {
  if (faults == kAllFaults) return "all";
  std::string text;
  for (const auto& [name, fault] : kFaultNames) {
    if (fault != kAllFaults && (faults & fault) != 0) text += (text.empty() ? "" : ",") + std::string(name);
  }
  return text.empty() ? "none" : text;
}

}  // namespace samestep::netsim
