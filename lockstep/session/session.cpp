// SPDX-License-Identifier: MIT
#include <samestep/error.h>
#include <samestep/session.h>

#include <algorithm>

#include "session/session_impl.h"

namespace samestep {

using namespace lockstep;

namespace {

void require(bool condition, const char* text) { samestep::require<Fault::ValueOutOfRange>(condition, text); }

void check(const SessionSettings& settings, const Game& game, const Transport& transport) {
  require(settings.players >= 2 && settings.players <= kMaxPlayers, "A session has 2 to 16 players.");
  require(settings.maxPlayers == 0 || settings.maxPlayers >= settings.players,
          "maxPlayers is less than the players at the start.");
  require(settings.maxPlayers <= kMaxPlayers, "A session has 16 players at most.");
  require(settings.localSeat <
              (settings.joins ? std::max(settings.players, settings.maxPlayers) : settings.players),
          "The local seat is not one of the session's.");
  require(!settings.joins || (game.read != nullptr && settings.hashInterval != 0),
          "To join a match a game reads states, and hashes are compared.");
  require(settings.window <= kMaxWindow, "The window is longer than 16 ticks.");
  require(settings.inputDelay <= kMaxInputDelay, "The input delay is longer than 16 ticks.");
  require(settings.runAhead <= kMaxRunAhead, "Run-ahead is more than 4 ticks.");
  require(settings.maxHeldBytes >= 1 && settings.maxHeldBytes <= 64, "maxHeldBytes is not within 1 to 64.");
  require(settings.maxCommandBytes <= 128, "maxCommandBytes is more than 128.");
  require(game.save != nullptr && game.load != nullptr && game.step != nullptr && game.hash != nullptr,
          "A game lacks one of its four functions.");
  require(transport.send != nullptr && transport.receive != nullptr, "A transport lacks a function.");
}

}  // namespace

const char* endReasonName(EndReason reason) {
  switch (reason) {
    case EndReason::none:
      return "none";
    case EndReason::left:
      return "left";
    case EndReason::refused:
      return "refused";
    case EndReason::dropped:
      return "dropped";
    case EndReason::minority:
      return "minority";
    case EndReason::diverged:
      return "diverged";
    case EndReason::notAdmitted:
      return "not admitted";
  }
  return "unknown";
}

Session::Impl::Impl(const SessionSettings& initial, const Game& functions, const Transport& datagrams)
    : settings(initial),
      game(functions),
      transport(datagrams),
      seats(std::max(initial.players, initial.maxPlayers)) {
  streams.reserve(seats);
  for (Seat seat = 0; seat < seats; ++seat) {
    streams.emplace_back(settings.maxHeldBytes, settings.maxCommandBytes);
    const bool fromStart = seat < settings.players && !settings.joins;
    ends[seat] = fromStart ? kNever : 0;
    if (seat >= settings.players && settings.addresses[seat] == 0) settings.addresses[seat] = kAnybody;
  }
  saves.fill(kNever);
  for (auto& command : commands) command.reserve(settings.maxCommandBytes);
  if (settings.joins) state = SessionState::joining;
  change.begin(live());
}

Session::Impl::SeatMask Session::Impl::live() const {
  SeatMask found = 0;
  for (Seat seat = 0; seat < seats; ++seat) {
    if (ends[seat] == kNever) found |= bit(seat);
  }
  return found;
}

bool Session::Impl::plays(Seat seat, Tick tick) const {
  if (tick >= starts[seat]) return tick < ends[seat];
  return std::any_of(stays[seat].begin(), stays[seat].end(),
                     [tick](const Stay& stay) { return tick >= stay.start && tick < stay.end; });
}

void Session::Impl::finish(EndReason why) {
  if (state == SessionState::ended) return;
  state = SessionState::ended;
  reason = why;
  tell({SessionEvent::Kind::ended, settings.localSeat, static_cast<std::uint8_t>(why), current});
}

void Session::Impl::tell(const SessionEvent& event) {
  if (eventsTold - eventsTaken == kKeptEvents) {
    ++eventsTaken;
    ++stats.lostEvents;
  }
  events[eventsTold++ % kKeptEvents] = event;
}

Session::Session(const SessionSettings& settings, const Game& game, const Transport& transport)
    : impl_((check(settings, game, transport), new Impl(settings, game, transport))) {}
Session::~Session() { delete impl_; }

namespace {

/// A function of the game or the transport that calls its session would change it midway.
void requireOutside(bool inCall) {
  samestep::require<Fault::SpaceLocked>(
      !inCall, "A session is changed from within a function of its own game or transport.");
}

/// Marks that frame or poll is under way.
class InCall {
 public:
  explicit InCall(bool& inCall) : inCall_(inCall) {
    requireOutside(inCall_);
    inCall_ = true;
  }
  ~InCall() { inCall_ = false; }
  InCall(const InCall&) = delete;
  InCall& operator=(const InCall&) = delete;

 private:
  bool& inCall_;
};

}  // namespace

Frame Session::frame(std::uint64_t now, std::span<const std::uint8_t> held) {
  require(held.size() <= impl_->settings.maxHeldBytes, "An input holds more than maxHeldBytes.");
  const InCall inCall(impl_->inCall);
  impl_->poll(now);
  return impl_->frame(held);
}

void Session::poll(std::uint64_t now) {
  const InCall inCall(impl_->inCall);
  impl_->poll(now);
}

bool Session::command(std::span<const std::uint8_t> bytes) {
  require(bytes.size() <= impl_->settings.maxCommandBytes, "A command is longer than maxCommandBytes.");
  requireOutside(impl_->inCall);
  if (impl_->commandsQueued - impl_->commandsTaken == kKeptCommands || impl_->leaving) return false;
  impl_->commands[impl_->commandsQueued++ % kKeptCommands].assign(bytes.begin(), bytes.end());
  return true;
}

void Session::leave() {
  requireOutside(impl_->inCall);
  if (impl_->leaving) return;
  impl_->leaving = true;
  impl_->paused = false;
  if (impl_->state == SessionState::connecting || impl_->state == SessionState::joining) {
    impl_->finish(EndReason::left);
  }
}

void Session::pause(bool paused) {
  requireOutside(impl_->inCall);
  impl_->paused = paused && !impl_->leaving;
}

void Session::setInputDelay(std::uint8_t ticks) {
  require(ticks <= kMaxInputDelay, "The input delay is longer than 16 ticks.");
  requireOutside(impl_->inCall);
  impl_->settings.inputDelay = ticks;
}
void Session::setWindow(std::uint8_t ticks) {
  require(ticks <= kMaxWindow, "The window is longer than 16 ticks.");
  requireOutside(impl_->inCall);
  impl_->settings.window = ticks;
}
void Session::setRunAhead(std::uint8_t ticks) {
  require(ticks <= kMaxRunAhead, "Run-ahead is more than 4 ticks.");
  requireOutside(impl_->inCall);
  impl_->settings.runAhead = ticks;
}
void Session::setSaving(Saving saving) {
  requireOutside(impl_->inCall);
  impl_->settings.saving = saving;
}
void Session::setAddress(Seat seat, Address address) {
  require(seat < impl_->seats, "There is no such seat.");
  requireOutside(impl_->inCall);
  if (impl_->isFree(seat)) impl_->settings.addresses[seat] = address;
}

std::uint8_t Session::inputDelay() const { return impl_->settings.inputDelay; }
std::uint8_t Session::window() const { return impl_->settings.window; }
SessionState Session::state() const { return impl_->state; }
EndReason Session::endReason() const { return impl_->reason; }
Tick Session::tick() const { return impl_->current; }
Tick Session::confirmed() const { return impl_->certain; }
bool Session::inputs(Tick tick, std::span<PlayerInput, kMaxPlayers> players, TickInputs& into) const {
  if (tick >= impl_->certain || tick < impl_->firstTick) return false;
  for (Seat seat = 0; seat < impl_->seats; ++seat) {
    const InputStream& stream = impl_->streams[seat];
    players[seat] = {};
    if (!impl_->plays(seat, tick)) continue;
    if (!stream.has(tick)) return false;
    const InputEntry entry = stream.at(tick);
    players[seat] = {true, entry.held, entry.commands};
  }
  into = {tick, players.first(impl_->seats)};
  return true;
}

bool Session::certainState(Tick& tick, std::uint32_t& slot) const { return impl_->newestKept(tick, slot); }

bool Session::Impl::newestKept(Tick& tick, std::uint32_t& slot) const {
  bool found = false;
  for (std::uint32_t place = 0; place < kKeepSlots; ++place) {
    const Tick kept = locating.kept[place];
    if (!keepsStates() || !keeps(kept) || (found && kept < tick)) continue;
    found = true;
    tick = kept;
    slot = kSaveSlots + place;
  }
  return found;
}

std::uint16_t Session::present() const { return impl_->live(); }
const SessionStats& Session::stats() const { return impl_->stats; }
const DesyncReport* Session::desync() const {
  return impl_->locating.report.first == 0 ? nullptr : &impl_->locating.report;
}

std::uint32_t Session::frameLength() const {
  // Each of two peers makes up for half of what the other is behind. Compared are the two sides' own views,
  // so that on a path that is slower one way both wait for the same number of inputs.
  std::int32_t sum = 0;
  std::int32_t others = 0;
  for (Seat seat = 0; seat < impl_->seats; ++seat) {
    if (!impl_->remote(seat) || impl_->ends[seat] != kNever || impl_->links[seat].paused) continue;
    sum += (impl_->links[seat].lagHere - impl_->links[seat].lagThere) / 2;
    ++others;
  }
  if (others == 0) return 1000;
  // One hundredth for each tick.
  return static_cast<std::uint32_t>(1000 + std::clamp(sum / others * 10 / 256, -50, 50));
}

bool Session::next(SessionEvent& event) {
  if (impl_->eventsTaken == impl_->eventsTold) return false;
  event = impl_->events[impl_->eventsTaken++ % kKeptEvents];
  return true;
}

}  // namespace samestep
