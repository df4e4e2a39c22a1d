// SPDX-License-Identifier: MIT
#include "loopback/player.h"

#include "loopback/relay_process.h"

// Frames of a game follow a clock; not in results: a session is told the time and keeps its steps the same.
#include <chrono>

#include <algorithm>

namespace samestep::loopback {

namespace {

constexpr Time kSecond = 1'000'000;
constexpr Time kFrame = kSecond / 60;
constexpr std::uint32_t kPatience = 20'000'000;
/// A crate is dropped now and then.
constexpr Tick kCrateEvery = 150;

/// Microseconds since the first call, at a speed.
Time clock(std::uint32_t speed) {
  using std::chrono::steady_clock;                  // not in results: when a frame is made
  static const auto start = steady_clock::now();    // not in results: when a frame is made
  const auto passed = steady_clock::now() - start;  // not in results: when a frame is made
  // not in results: when a frame is made
  return static_cast<Time>(std::chrono::duration_cast<std::chrono::microseconds>(passed).count()) * speed;
}

}  // namespace

void FlippedArena::apply(Space<Fixed>& space, const TickInputs& inputs, void* data) {
  auto& self = *static_cast<FlippedArena*>(data);
  arena::Arena<Fixed>::applyInputs(space, inputs, &self.arena);
  if (self.flipSeat == kNoSeat || inputs.tick != self.flipTick) return;
  auto& body = space.body(self.arena.player(self.flipSeat));
  const Vector<Fixed> at = body.position();
  body.setPosition({Fixed::fromRaw(at.x.raw() ^ 1), at.y});
}

std::vector<Address> Player::othersOf(const Table& table, Seat seat) {
  std::vector<Address> others;
  for (std::size_t other = 0; other < table.sockets.size(); ++other) {
    if (other != seat) others.push_back(UdpTransport::address("127.0.0.1", table.sockets[other]->port()));
  }
  if (table.relay != nullptr) others.push_back(UdpTransport::address("127.0.0.1", table.relay->port()));
  return others;
}

Player::Player(const MatchOptions& options, Table& table, Seat seat)
    : options_(options),
      seat_(seat),
      udp_(*table.sockets[seat]),
      shaped_(udp_, othersOf(table, seat), options.link, options.seed * kMaxPlayers + seat),
      sealed_(shaped_.transport(), table.keys[seat],
              table.relay == nullptr ? table.match : relayMatchKey(table.relayWord)),
      arena_(options),
      game_(arena_.arena.space(), ratio<Fixed>(1, 60), FlippedArena::apply, &arena_),
      session_((findOthers(table), settingsOf()), game_.functions(), transport()) {
  if (options.flipSeat == seat) {
    arena_.flipSeat = seat;
    arena_.flipTick = options.flipTick;
  }
  game_.record(result_.recording);
}

/// Lets in the others, or the relay in their place.
void Player::findOthers(const Table& table) {
  if (table.relay != nullptr) {
    const Address below = UdpTransport::address("127.0.0.1", table.relay->port());
    const Address relay = sealed_.addPeer(relayKeys(table.relayWord).publicKey, below);
    relayed_ = std::make_unique<RelayTransport>(sealed_.transport(), relay, seat_);
  }
  for (Seat other = 0; other < options_.players; ++other) {
    const Address below = UdpTransport::address("127.0.0.1", table.sockets[other]->port());
    if (table.relay != nullptr) {
      addresses_.push_back(RelayTransport::address(other));
    } else {
      addresses_.push_back(other == seat_ ? 0 : sealed_.addPeer(table.keys[other].publicKey, below));
    }
  }
}

SessionSettings Player::settingsOf() {
  SessionSettings settings;
  settings.match = static_cast<std::uint32_t>(options_.seed);
  settings.players = static_cast<std::uint8_t>(options_.players);
  settings.localSeat = seat_;
  std::copy(addresses_.begin(), addresses_.end(), settings.addresses);
  settings.window = options_.window;
  settings.inputDelay = options_.inputDelay;
  settings.hashInterval = options_.hashInterval;
  settings.maxHeldBytes = 1;
  settings.maxCommandBytes = 1;
  // On a busy machine a process may have to wait for its turn.
  settings.dropAfter = kPatience * options_.speed;
  settings.endAfter = 2 * kPatience * options_.speed;
  game_.describe(settings);
  return settings;
}

/// Makes a frame, with what the bot does.
void Player::turn(Time now) {
  const std::uint8_t held = arena::botButtons(options_.seed, seat_, session_.tick());
  if (session_.tick() % kCrateEvery == 20u + seat_) session_.command({&arena::kDropCrate, 1});
  session_.frame(now, {&held, 1});
  next_ = std::max(next_ + kFrame * session_.frameLength() / 1000, now > 10 * kFrame ? now - 10 * kFrame : 0);
}

/// True if all that the recording is to hold is certain, and a little more.
bool Player::over() const { return std::min(session_.confirmed(), session_.tick()) >= options_.ticks; }

void Player::notice() {
  for (SessionEvent event; session_.next(event);) {
    if (event.kind == SessionEvent::Kind::desync) result_.report.desynced = true;
    if (event.kind == SessionEvent::Kind::dropped) {
      result_.words += "peer " + std::to_string(event.seat) + " was dropped\n";
    }
  }
  if (!recording_ || !over()) return;
  if (session_.desync() != nullptr) result_.words += "desync: " + desyncText(*session_.desync()) + "\n";
  recording_ = false;
  game_.finishRecording(options_.ticks);
  session_.leave();
}

PeerResult Player::play() {
  const Time limit = Time{options_.ticks} * kFrame * 3 + Time{3} * kPatience * options_.speed;
  Time now = 0;
  while (session_.state() != SessionState::ended && now < limit) {
    now = clock(options_.speed);
    shaped_.update(now);
    sealed_.update(now);
    if (now >= next_) {
      turn(now);
    } else {
      session_.poll(now);
    }
    if (relayed_ != nullptr) relayed_->update(now);
    notice();
    udp_.wait(1);
  }
  const SessionStats& stats = session_.stats();
  PeerReport& report = result_.report;
  report.reason = session_.endReason();
  report.certain = std::min(session_.confirmed(), session_.tick());
  report.deepest = stats.deepest;
  report.steps = stats.steps;
  report.rollbacks = stats.rollbacks;
  report.waited = stats.waited;
  report.datagrams = shaped_.sent();
  report.lost = shaped_.lost();
  report.bytes = shaped_.bytes();
  report.microseconds = now;
  report.refused = stats.badPackets;
  result_.ended = true;
  if (recording_) result_.recording.clear();
  return result_;
}

}  // namespace samestep::loopback
