// SPDX-License-Identifier: MIT
// Steps, saves and rollbacks.
#include <algorithm>

#include "session/session_impl.h"

namespace samestep {

using namespace lockstep;

Frame Session::Impl::frame(std::span<const std::uint8_t> held) {
  if (state == SessionState::joining) return frameJoining();
  if (state != SessionState::running) return Frame::idle;
  takeBackShown();
  rollBack();
  publishHashes();
  if (paused) return Frame::paused;
  produce(held);
  confirm();
  for (Seat seat = 0; seat < seats; ++seat) {
    if (remote(seat)) sendInputs(seat);
  }
  const bool steps = mayStep();
  if (steps) {
    prepareStep();
    step(current);
    ++current;
    hashState();
    publishHashes();
    balance();
  } else {
    ++stats.waited;
  }
  showAhead();
  return steps ? Frame::advanced : Frame::waiting;
}

/// Makes our inputs up to the one that is due, unless we have gone too far ahead of the others.
void Session::Impl::produce(std::span<const std::uint8_t> held) {
  // A newcomer sends its first inputs at once.
  const Tick start = starts[settings.localSeat];
  const Tick due = std::max(current, start) + settings.inputDelay;
  const Tick most = std::max(certain, start) + kMaxLead;
  while (own().end() <= due && own().end() < most && ends[settings.localSeat] == kNever) {
    const bool last = own().end() == due;
    // A longer delay leaves ticks to fill with what was held before.
    appendOwn(last ? held : own().heldBefore(own().end()));
  }
}

void Session::Impl::appendOwn(std::span<const std::uint8_t> held) {
  InputEntry entry{held, {}, Control::none};
  if (commandsTaken != commandsQueued) entry.commands = commands[commandsTaken++ % kKeptCommands];
  const bool last = leaving && commandsTaken == commandsQueued;
  if (last) entry.control = Control::leave;
  // No step was made without it: what was shown ahead with another one has been taken back.
  own().append(entry);
  if (last) seatEnds(settings.localSeat, own().end(), SessionEvent::Kind::left);
}

bool Session::Impl::complete(Tick tick) const {
  for (Seat seat = 0; seat < seats; ++seat) {
    if (plays(seat, tick) && tick >= streams[seat].end()) return false;
  }
  return true;
}

/// Counts the steps whose inputs are all known.
void Session::Impl::confirm() {
  // Inputs that are to be stepped must not be pushed out of the streams.
  const Tick most = std::min(current + 2 * kMaxLead, change.barrier());
  while (certain < most && complete(certain)) ++certain;
  keepLog();
}

/// Goes back to before the first step that was made with a wrong input, and makes the steps again.
void Session::Impl::rollBack() {
  const bool old = settings.saving == Saving::sparse && settings.window > 0 && current > certain &&
                   slotOf(certain) != kSaveSlots && saves[slotOf(certain)] + settings.window < certain;
  const Tick target = std::min(wrong, old ? certain : kNever);
  wrong = kNever;
  if (target >= current) return;
  const std::uint32_t slot = slotOf(target);
  const Tick from = saves[slot];
  for (Tick& tick : saves) {
    if (tick != kNever && tick > from) tick = kNever;
  }
  game.load(slot, game.data);
  ++stats.rollbacks;
  stats.deepest = std::max(stats.deepest, current - from);
  const Tick to = current;
  for (current = from; current < to;) {
    if (current != from) prepareStep();
    step(current);
    ++current;
    hashState();
  }
}

bool Session::Impl::mayStep() const { return current < certain || current - certain < settings.window; }

/// Saves the state before the step of `current` where one may be gone back to.
void Session::Impl::prepareStep() {
  if (current < certain) return;
  if (settings.saving == Saving::everyStep || current == certain) save(current);
}

void Session::Impl::step(Tick tick) {
  PlayerInput inputs[kMaxPlayers];
  for (Seat seat = 0; seat < seats; ++seat) {
    InputStream& stream = streams[seat];
    if (!plays(seat, tick)) continue;
    inputs[seat].present = true;
    if (stream.has(tick)) {
      const InputEntry entry = stream.at(tick);
      inputs[seat].held = entry.held;
      inputs[seat].commands = entry.commands;
    } else {
      if (settings.prediction == Prediction::repeatLast) {
        stream.predict(tick, stream.heldBefore(tick));
      } else {
        stream.predict(tick, {});
      }
      inputs[seat].held = stream.predicted(tick);
    }
  }
  game.step({tick, {inputs, seats}}, game.data);
  ++stats.steps;
}

/// The newest save that is of a tick of at most this; kSaveSlots: none.
std::uint32_t Session::Impl::slotOf(Tick atMost) const {
  std::uint32_t found = kSaveSlots;
  for (std::uint32_t slot = 0; slot < kSaveSlots; ++slot) {
    if (saves[slot] == kNever || saves[slot] > atMost) continue;
    if (found == kSaveSlots || saves[slot] > saves[found]) found = slot;
  }
  return found;
}

/// A slot with nothing that is needed: empty, or older than the newest certain one.
std::uint32_t Session::Impl::freeSlot() const {
  const std::uint32_t base = slotOf(certain);
  std::uint32_t oldest = base == 0 ? 1 : 0;
  for (std::uint32_t slot = 0; slot < kSaveSlots; ++slot) {
    if (saves[slot] == kNever) return slot;
    if (slot != base && saves[slot] < saves[oldest]) oldest = slot;
  }
  return oldest;
}

void Session::Impl::save(Tick tick) {
  const std::uint32_t same = slotOf(tick);
  const std::uint32_t slot = same != kSaveSlots && saves[same] == tick ? same : freeSlot();
  saves[slot] = tick;
  game.save(slot, game.data);
  ++stats.saves;
}

/// Makes steps with what is known and predicted, only to be shown.
void Session::Impl::showAhead() {
  if (settings.runAhead == 0) return;
  save(current);
  shown = true;
  for (Tick ahead = 0; ahead < settings.runAhead; ++ahead) step(current + ahead);
}

void Session::Impl::takeBackShown() {
  if (!shown) return;
  shown = false;
  game.load(slotOf(current), game.data);
}

void Session::Impl::hashState() {
  if (settings.hashInterval == 0 || current % settings.hashInterval != 0) return;
  ownHashes.of(current, settings.hashInterval) = {current, game.hash(game.data)};
  keepState();
}

/// Notes the hashes of states that are certain by now. Called only when no step is wrong.
void Session::Impl::publishHashes() {
  if (settings.hashInterval == 0 || wrong < current) return;
  bool any = false;
  const Tick sure = std::min(certain, current);
  for (Tick tick = hashesUpTo + settings.hashInterval; tick <= sure; tick += settings.hashInterval) {
    const KeptHash& kept = ownHashes.of(tick, settings.hashInterval);
    hashesUpTo = tick;
    if (kept.tick != tick) continue;
    hashes[settings.localSeat].of(tick, settings.hashInterval) = kept;
    if (tick % keepInterval() == 0) keptHashes.of(tick, keepInterval()) = kept;
    any = true;
    for (Seat seat = 0; seat < seats; ++seat) compareHash(seat, tick);
  }
  if (any) sendHashes();
}

void Session::Impl::compareHash(Seat seat, Tick tick) {
  // A peer that was dropped may have gone on alone.
  if (ends[seat] < tick) return;
  const KeptHash& ours = hashes[settings.localSeat].of(tick, settings.hashInterval);
  const KeptHash& theirs = hashes[seat].of(tick, settings.hashInterval);
  if (ours.tick != tick || theirs.tick != tick) return;
  DesyncReport& report = locating.report;
  if (ours.hash != theirs.hash) {
    if (report.first == 0) report.first = tick;
    if ((desynced & bit(seat)) == 0)
      tell({SessionEvent::Kind::desync, seat, 0, tick, ours.hash, theirs.hash});
    desynced |= bit(seat);
    beginLocating(seat, tick);
  }
  // The minority shows when all have told.
  if (report.first == tick) report.minority = minorityAt(tick);
}

/// Smooths by how much each peer is behind.
void Session::Impl::balance() {
  for (Seat seat = 0; seat < seats; ++seat) {
    Link& link = links[seat];
    const std::int32_t lag =
        (static_cast<std::int32_t>(current) - static_cast<std::int32_t>(link.tick)) * 256;
    link.lagHere += (std::clamp(lag, -(64 * 256), 64 * 256) - link.lagHere) / 16;
  }
}

}  // namespace samestep
