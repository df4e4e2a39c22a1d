// SPDX-License-Identifier: MIT
// Networked matches.
#include <samestep/space_game.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "base/require_ieee.h"
#include "call.h"

/// A match of a world: the session and the game that it plays.
struct samestep_session {
  samestep_session(samestep_world& of, const samestep_session_def& from) : world(of), def(from) {
    ++world.users;
  }
  samestep_session(const samestep_session&) = delete;
  samestep_session& operator=(const samestep_session&) = delete;
  virtual ~samestep_session() { --world.users; }
  virtual samestep::Session& session() = 0;

  samestep_world& world;
  const samestep_session_def def;
  samestep::c::Calls calls;
};

namespace samestep::c {
namespace {

static_assert(static_cast<int>(SessionEvent::Kind::desync) == SAMESTEP_SESSION_DESYNC);
static_assert(static_cast<int>(SessionEvent::Kind::ended) == SAMESTEP_SESSION_OVER);
static_assert(static_cast<int>(SessionEvent::Kind::lied) == SAMESTEP_SESSION_LIED);
static_assert(static_cast<int>(SessionState::joining) == SAMESTEP_SESSION_JOINING);
static_assert(static_cast<int>(Frame::idle) == SAMESTEP_FRAME_IDLE);
static_assert(kSaveSlots + kKeepSlots == 22, "What samestep_own_state says.");

/// A number of the caller's in a narrower type.
/// @throws ValueOutOfRange where it does not fit
template <class To>
To narrow(std::uint32_t from) {
  require<Fault::ValueOutOfRange>(from <= std::numeric_limits<To>::max());
  return static_cast<To>(from);
}

SessionSettings toSettings(const samestep_session_def& from) {
  SessionSettings settings;
  settings.match = from.match;
  settings.players = narrow<std::uint8_t>(from.players);
  settings.maxPlayers = narrow<std::uint8_t>(from.max_players);
  settings.joins = from.joins != 0;
  settings.localSeat = narrow<Seat>(from.local_seat);
  std::copy(std::begin(from.addresses), std::end(from.addresses), settings.addresses);
  settings.window = narrow<std::uint8_t>(from.window);
  settings.inputDelay = narrow<std::uint8_t>(from.input_delay);
  settings.runAhead = narrow<std::uint8_t>(from.run_ahead);
  settings.saving = from.sparse_saving != 0 ? Saving::sparse : Saving::everyStep;
  settings.prediction = from.predicts_nothing != 0 ? Prediction::nothing : Prediction::repeatLast;
  settings.maxHeldBytes = narrow<std::uint8_t>(from.max_held_bytes);
  settings.maxCommandBytes = narrow<std::uint8_t>(from.max_command_bytes);
  settings.hashInterval = narrow<std::uint16_t>(from.hash_interval);
  settings.content = from.content;
  settings.resendAfter = from.resend_after;
  settings.interruptedAfter = from.interrupted_after;
  settings.dropAfter = from.drop_after;
  settings.endAfter = from.end_after;
  settings.goneAfter = from.gone_after;
  settings.pausedAtMost = from.paused_at_most;
  return settings;
}

OwnState toOwnState(const samestep_own_state& from) { return {from.data, from.save, from.load, from.hash}; }

void sendOf(Address to, std::span<const std::uint8_t> bytes, void* data) {
  const auto& def = static_cast<const samestep_session*>(data)->def;
  def.send(to, bytes.data(), bytes.size(), def.transport_data);
}
std::uint32_t receiveOf(Address& from, std::span<std::uint8_t> into, void* data) {
  const auto& def = static_cast<const samestep_session*>(data)->def;
  return def.receive(&from, into.data(), into.size(), def.transport_data);
}

template <Scalar S>
struct SessionOf final : samestep_session {
  SessionOf(WorldOf<S>& of, const samestep_session_def& from)
      : samestep_session(of, from),
        game(of.space, timeStepOf<S>(from.rate), applyInputs, this, toOwnState(from.own)),
        match(described(), game.functions(), Transport{this, sendOf, receiveOf}) {}
  samestep::Session& session() override { return match; }

  SessionSettings described() const {
    SessionSettings settings = toSettings(def);
    game.describe(settings);
    return settings;
  }
  static void applyInputs(Space<S>&, const TickInputs& inputs, void* data) {
    const auto& self = *static_cast<const SessionOf*>(data);
    samestep_player_input players[kMaxPlayers] = {};
    std::uint32_t count = 0;
    for (const PlayerInput& input : inputs.players) {
      players[count++] = {input.held.data(),
                          input.commands.data(),
                          static_cast<std::uint32_t>(input.held.size()),
                          static_cast<std::uint32_t>(input.commands.size()),
                          input.present ? 1 : 0,
                          0};
    }
    const InCallback inCallback(self.world);
    self.def.apply_inputs(&self.world, inputs.tick, players, count, self.def.data);
  }

  SpaceGame<S> game;
  Session match;
};

/// Runs action(session); messages are its world's.
template <class Action>
samestep_status callSession(samestep_session* session, Action&& action) noexcept {
  if (session == nullptr) return callFree([] { refuse(SAMESTEP_NULL_ARGUMENT); });
  const InCall inCall(*session);
  return call(&session->world, [&](auto&) { action(session->session()); });
}

std::span<const std::uint8_t> bytesOf(const std::uint8_t* bytes, std::size_t size) {
  if (size != 0) at(bytes);
  return {bytes, size};
}

samestep_session_state stateOf(const Session& session) {
  const SessionStats& stats = session.stats();
  samestep_session_state state{};
  state.state = static_cast<std::int32_t>(session.state());
  state.end_reason = static_cast<std::int32_t>(session.endReason());
  state.tick = session.tick();
  state.confirmed = session.confirmed();
  state.present = session.present();
  state.frame_length = session.frameLength();
  state.steps = stats.steps;
  state.rollbacks = stats.rollbacks;
  state.saves = stats.saves;
  state.waited = stats.waited;
  state.sent_bytes = stats.sentBytes;
  state.sent_packets = stats.sentPackets;
  state.bad_packets = stats.badPackets;
  state.lost_events = stats.lostEvents;
  state.deepest = stats.deepest;
  return state;
}

}  // namespace
}  // namespace samestep::c

using namespace samestep::c;

extern "C" {

void samestep_session_def_init(samestep_session_def* def) {
  if (def == nullptr) return;
  const samestep::SessionSettings defaults;
  *def = {};
  def->version = SAMESTEP_C_VERSION;
  def->players = defaults.players;
  def->rate = 60;
  def->window = defaults.window;
  def->input_delay = defaults.inputDelay;
  def->run_ahead = defaults.runAhead;
  def->max_held_bytes = defaults.maxHeldBytes;
  def->max_command_bytes = defaults.maxCommandBytes;
  def->hash_interval = defaults.hashInterval;
  def->resend_after = defaults.resendAfter;
  def->interrupted_after = defaults.interruptedAfter;
  def->drop_after = defaults.dropAfter;
  def->end_after = defaults.endAfter;
  def->gone_after = defaults.goneAfter;
  def->paused_at_most = defaults.pausedAtMost;
}

samestep_status samestep_session_create(samestep_world* world, const samestep_session_def* def,
                                        samestep_session** session) {
  return call(world, [&]<class World>(World& of) {
    at(session);
    current(def);
    requireOr(def->apply_inputs != nullptr && def->send != nullptr && def->receive != nullptr,
              SAMESTEP_NULL_ARGUMENT);
    requireOr(of.destroyable, SAMESTEP_IN_USE);
    *session = new SessionOf<typename World::Number>(of, *def);
  });
}

void samestep_session_destroy(samestep_session* session) { endAfterCalls(session); }

samestep_status samestep_session_frame(samestep_session* session, uint64_t now, const uint8_t* held,
                                       size_t size, int32_t* frame) {
  return callSession(session, [&](samestep::Session& of) {
    const samestep::Frame made = of.frame(now, bytesOf(held, size));
    if (frame != nullptr) *frame = static_cast<int32_t>(made);
  });
}

samestep_status samestep_session_poll(samestep_session* session, uint64_t now) {
  return callSession(session, [&](samestep::Session& of) { of.poll(now); });
}

samestep_status samestep_session_command(samestep_session* session, const uint8_t* bytes, size_t size,
                                         int32_t* queued) {
  return callSession(session, [&](samestep::Session& of) {
    at(queued);
    *queued = of.command(bytesOf(bytes, size)) ? 1 : 0;
  });
}

samestep_status samestep_session_leave(samestep_session* session) {
  return callSession(session, [&](samestep::Session& of) { of.leave(); });
}

samestep_status samestep_session_pause(samestep_session* session, int32_t paused) {
  return callSession(session, [&](samestep::Session& of) { of.pause(paused != 0); });
}

samestep_status samestep_session_set_input_delay(samestep_session* session, uint32_t ticks) {
  return callSession(session, [&](samestep::Session& of) { of.setInputDelay(narrow<uint8_t>(ticks)); });
}

samestep_status samestep_session_set_window(samestep_session* session, uint32_t ticks) {
  return callSession(session, [&](samestep::Session& of) { of.setWindow(narrow<uint8_t>(ticks)); });
}

samestep_status samestep_session_get_state(samestep_session* session, samestep_session_state* state) {
  return callSession(session, [&](samestep::Session& of) { at(state) = stateOf(of); });
}

samestep_status samestep_session_next_event(samestep_session* session, samestep_session_event* event,
                                            int32_t* taken) {
  return callSession(session, [&](samestep::Session& of) {
    at(event), at(taken);
    samestep::SessionEvent next;
    *taken = of.next(next) ? 1 : 0;
    if (*taken == 0) return;
    *event = {static_cast<int32_t>(next.kind), next.seat, next.detail, next.tick, next.local, next.remote};
  });
}

samestep_status samestep_session_write_desync(samestep_session* session, char* text, size_t capacity,
                                              size_t* size) {
  return callSession(session, [&](samestep::Session& of) {
    at(size);
    const samestep::DesyncReport* report = of.desync();
    const std::string line = report == nullptr ? std::string() : samestep::desyncText(*report);
    giveSize(line.size() + 1, text, capacity, size);
    if (text != nullptr) std::memcpy(text, line.c_str(), line.size() + 1);
  });
}

}  // extern "C"
