// SPDX-License-Identifier: MIT
// Where two states differ: hashes of ever smaller parts are exchanged until one value is left.
#include <algorithm>
#include <cstring>

#include "session/mix.h"
#include "session/session_impl.h"

namespace samestep {

using namespace lockstep;

namespace {

constexpr std::uint64_t kAskAgain = 100'000;
constexpr std::uint64_t kAnswerEvery = 5'000;
/// A peer that does not answer for so long is asked no more.
constexpr std::uint64_t kAskFor = 5'000'000;

/// Number of values that a part of a level has.
std::uint64_t valuesOf(std::uint8_t level) { return std::uint64_t{1} << (6 * level); }

void putText(PacketWriter& writer, const char* text) {
  const auto length = static_cast<std::uint8_t>(std::min<std::size_t>(std::strlen(text), 255));
  writer.u8(length);
  writer.bytes({reinterpret_cast<const std::uint8_t*>(text), length});
}

template <std::size_t kSize>
void getText(PacketReader& reader, char (&into)[kSize]) {
  const auto bytes = reader.bytes(reader.u8());
  const std::size_t length = std::min(bytes.size(), kSize - 1);
  for (std::size_t i = 0; i < length; ++i) {
    // Text from outside that is no plain text is not shown.
    const bool plain = bytes[i] >= 32 && bytes[i] < 127;
    into[i] = plain ? static_cast<char>(bytes[i]) : '?';
  }
  into[length] = 0;
}

}  // namespace

bool Session::Impl::canLocate() const { return game.valueHashes != nullptr && game.value != nullptr; }

/// States are kept a little apart, so that the last ones reach back for a while.
Tick Session::Impl::keepInterval() const {
  return settings.hashInterval * ((kKeepEvery + settings.hashInterval - 1) / settings.hashInterval);
}

/// Keeps the state of `current` where it is one of those that a difference is looked for in.
void Session::Impl::keepState() {
  if (!keepsStates() || current % keepInterval() != 0) return;
  const std::uint32_t place = current / keepInterval() % kKeepSlots;
  // A pinned state stays.
  if (locating.pinned != kNever && locating.pinned / keepInterval() % kKeepSlots == place) return;
  locating.kept[place] = current;
  game.save(kSaveSlots + place, game.data);
}

/// True if the state after so many steps is kept and certain.
bool Session::Impl::keeps(Tick tick) const {
  const bool kept = tick != kNever && locating.kept[tick / keepInterval() % kKeepSlots] == tick;
  return kept && tick <= std::min(certain, current) && wrong >= tick;
}

/// Keeps this state for good, and looks at all of its values.
bool Session::Impl::pin(Tick tick) {
  if (locating.pinned == tick) return true;
  const bool busy = locating.asking && locating.pinned != kNever;
  if (busy || !keeps(tick)) return false;
  locating.pinned = tick;
  const std::uint32_t slot = kSaveSlots + tick / keepInterval() % kKeepSlots;
  locating.hashes.resize(game.valueHashes(slot, {}, game.data));
  game.valueHashes(slot, locating.hashes, game.data);
  return true;
}

/// The earliest state at or after `tick` that is pinned or kept; kNever: none.
Tick Session::Impl::keptFrom(Tick tick) const {
  if (locating.pinned != kNever) return locating.pinned;
  Tick found = kNever;
  for (const Tick kept : locating.kept) {
    if (kept >= tick && kept < found && keeps(kept)) found = kept;
  }
  return found;
}

/// Hash of the values of one part of a level.
std::uint64_t Session::Impl::hashOfPart(std::uint8_t level, std::uint64_t part) const {
  const std::uint64_t all = locating.hashes.size();
  const std::uint64_t from = std::min(part * valuesOf(level), all);
  const std::uint64_t to = std::min((part + 1) * valuesOf(level), all);
  std::uint64_t hash = to - from;
  for (std::uint64_t i = from; i < to; ++i) hash = mix(hash, locating.hashes[i]);
  return hash;
}

/// Begins to look for what differs, once another hash has come.
void Session::Impl::beginLocating(Seat seat, Tick tick) {
  if (!canLocate() || locating.asking || locating.done) return;
  locating.asking = true;
  locating.seat = seat;
  locating.from = tick;
  locating.level = kTopLevel;
  locating.part = 0;
  locating.since = now;
  locating.askedAt = 0;
}

void Session::Impl::locate() {
  if (!locating.asking || now - locating.askedAt < kAskAgain) return;
  if (now - locating.since > kAskFor || (live() & bit(locating.seat)) == 0) {
    // Another one may answer.
    locating.asking = false;
    return;
  }
  const Tick tick = keptFrom(locating.from);
  if (tick == kNever || !pin(tick)) return;
  locating.askedAt = now;
  std::uint8_t bytes[32];
  PacketWriter writer(bytes);
  header(writer, Packet::ask);
  writer.u32(tick);
  writer.u8(locating.level);
  writer.u64(locating.part);
  send(locating.seat, writer);
}

void Session::Impl::receiveAsk(Seat seat, PacketReader& reader) {
  const Tick tick = reader.u32();
  const std::uint8_t level = reader.u8();
  const std::uint64_t part = reader.u64();
  if (!reader.done() || level > kTopLevel || part >= valuesOf(kTopLevel)) return bad();
  if (!canLocate() || desynced == 0 || now - links[seat].lastAnswered < kAnswerEvery) return;
  links[seat].lastAnswered = now;
  // The answer tells which state it is about, where it is another one.
  const Tick told = pin(tick) ? tick : keptFrom(tick);
  if (told == kNever || !pin(told)) return;
  std::uint8_t bytes[kMaxPacket];
  PacketWriter writer(bytes);
  header(writer, Packet::answer);
  writer.u32(told);
  writer.u8(level);
  writer.u64(part);
  if (level > 0) {
    for (std::uint64_t i = 0; i < kParts; ++i)
      writer.u64(hashOfPart(static_cast<std::uint8_t>(level - 1), part * kParts + i));
  } else {
    const GameValue value = valueAt(part);
    putText(writer, value.object);
    putText(writer, value.field);
    putText(writer, value.text);
  }
  send(seat, writer);
}

GameValue Session::Impl::valueAt(std::uint64_t index) const {
  GameValue value;
  const std::uint32_t slot = kSaveSlots + locating.pinned / keepInterval() % kKeepSlots;
  if (index < locating.hashes.size()) {
    game.value(slot, static_cast<std::uint32_t>(index), value, game.data);
  } else {
    std::memcpy(value.text, "none", 5);
  }
  return value;
}

void Session::Impl::receiveAnswer(Seat seat, PacketReader& reader) {
  const Tick tick = reader.u32();
  const std::uint8_t level = reader.u8();
  const std::uint64_t part = reader.u64();
  if (!reader.good()) return bad();
  if (!locating.asking || seat != locating.seat || level != locating.level || part != locating.part) return;
  if (tick != locating.pinned) {
    // The other has another state only.
    if (!keeps(tick)) return;
    locating.pinned = kNever;
    locating.level = kTopLevel;
    locating.part = 0;
    if (pin(tick)) locating.askedAt = 0;
    return;
  }
  if (level == 0) {
    GameValue theirs;
    getText(reader, theirs.object);
    getText(reader, theirs.field);
    getText(reader, theirs.text);
    return reader.done() ? located(theirs) : bad();
  }
  std::uint64_t first = kParts;
  for (std::uint64_t i = 0; i < kParts; ++i) {
    const bool other = reader.u64() != hashOfPart(static_cast<std::uint8_t>(level - 1), part * kParts + i);
    if (other && first == kParts) first = i;
  }
  if (!reader.done()) return bad();
  if (first == kParts) {
    // These states are the same: a later one is not.
    locating.asking = false;
    locating.pinned = kNever;
    return;
  }
  locating.level = static_cast<std::uint8_t>(level - 1);
  locating.part = part * kParts + first;
  locating.askedAt = 0;
}

/// Seats that told another hash for a tick than most did; none where none is told by more than half.
Session::Impl::SeatMask Session::Impl::minorityAt(Tick tick) {
  SeatMask told = 0;
  for (Seat seat = 0; seat < seats; ++seat) {
    if (hashes[seat].of(tick, settings.hashInterval).tick == tick) told |= bit(seat);
  }
  for (Seat most = 0; most < seats; ++most) {
    if ((told & bit(most)) == 0) continue;
    const std::uint64_t hash = hashes[most].of(tick, settings.hashInterval).hash;
    SeatMask same = 0;
    for (Seat seat = 0; seat < seats; ++seat) {
      const bool equal = (told & bit(seat)) != 0 && hashes[seat].of(tick, settings.hashInterval).hash == hash;
      if (equal) same |= bit(seat);
    }
    if (2 * count(same) > count(told)) return static_cast<SeatMask>(told & ~same);
  }
  return 0;
}

void Session::Impl::located(const GameValue& theirs) {
  locating.asking = false;
  locating.done = true;
  const GameValue ours = valueAt(locating.part);
  DesyncReport& report = locating.report;
  report.tick = locating.pinned;
  report.seat = locating.seat;
  report.ours = ours;
  report.theirs = theirs;
  tell({SessionEvent::Kind::located, locating.seat, 0, report.tick});
}

std::string desyncText(const DesyncReport& report) {
  const auto number = [](std::uint64_t value) { return std::to_string(value); };
  std::string text;
  if (report.seat == kNoSeat) {
    text = "the states after " + number(report.first) + " ticks differ";
  } else {
    const std::string name = std::string(report.ours.object) + ", " + report.ours.field;
    const std::string other = std::string(report.theirs.object) + ", " + report.theirs.field;
    text = name + " after " + number(report.tick) + " ticks: " + report.ours.text + " here, " +
           (other == name ? "" : other + ": ") + report.theirs.text + " at peer " + number(report.seat);
  }
  for (Seat seat = 0; seat < kMaxPlayers; ++seat) {
    if ((report.minority >> seat & 1) != 0) text += "; peer " + number(seat) + " differs from most";
  }
  return text;
}

}  // namespace samestep
