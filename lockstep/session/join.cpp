// SPDX-License-Identifier: MIT
// How somebody joins a match under way: one of the players sends a state and all inputs since, most of the
// others vouch for its hash, and when the newcomer has caught up all agree from which tick on it plays.
#include <algorithm>

#include "session/session_impl.h"

namespace samestep {

using namespace lockstep;

namespace {

constexpr std::uint32_t kBlock = 1024;
constexpr std::uint32_t kBlocksAtOnce = 4;
/// The longest state, and the longest log of inputs since, bytes.
constexpr std::uint32_t kMaxState = 1u << 26;
constexpr std::uint32_t kMaxLog = 1u << 26;
/// A newcomer that is so many ticks behind is let in.
constexpr Tick kNear = 60;
/// A newcomer catches up by so many steps a frame.
constexpr Tick kMostCatchUp = 8;
// Microseconds.
constexpr std::uint64_t kHelloEvery = 100'000;
constexpr std::uint64_t kFetchEvery = 20'000;
constexpr std::uint64_t kVouchEvery = 100'000;
constexpr std::uint64_t kForgetAfter = 3'000'000;
constexpr std::uint64_t kHeardWithin = 2'000'000;
constexpr std::uint64_t kNewsWithin = 1'500'000;
/// A player that only asks to be let in for so long has lost the match.
constexpr std::uint64_t kLostAfter = 500'000;

// These are flags of a seat in a tick of the log.
constexpr std::uint8_t kPresent = 1;
constexpr std::uint8_t kLast = 2;

std::uint64_t since(std::uint64_t now, std::uint64_t then) { return now - std::min(now, then); }

}  // namespace

// ---- Who is let in.

/// True if nobody plays in a seat, and all have agreed on that.
bool Session::Impl::isFree(Seat seat) const {
  return state == SessionState::running && remote(seat) && ends[seat] != kNever &&
         (change.voters() & bit(seat)) == 0;
}

/// True if an address may ask for a free seat: it has no other one, and nobody else has asked.
bool Session::Impl::mayTake(Seat seat, Address from) const {
  if (settings.addresses[seat] != kAnybody && settings.addresses[seat] != from) return false;
  for (Seat other = 0; other < seats; ++other) {
    if ((live() & bit(other)) != 0 && settings.addresses[other] == from) return false;
  }
  const Newcomer& asked = newcomers[seat];
  return !asked.heard || asked.address == from || since(now, asked.lastHeard) > kForgetAfter;
}

void Session::Impl::refuse(Address to, Mismatch why) {
  std::uint8_t bytes[16];
  PacketWriter writer(bytes);
  header(writer, Packet::refuse);
  writer.u8(static_cast<std::uint8_t>(why));
  sendTo(to, writer);
}

void Session::Impl::receiveNewcomer(Seat seat, Address from, Packet type, PacketReader& reader) {
  Newcomer& newcomer = newcomers[seat];
  if (type == Packet::fetch) {
    if (!newcomer.heard || newcomer.address != from) return bad();
    newcomer.lastHeard = now;
    return receiveFetch(seat, reader);
  }
  const bool joins = (reader.u8() & kWantsToJoin) != 0;
  const Mismatch found = mismatch(reader);
  if (!reader.good() || !joins) return bad();
  if (found != Mismatch::none) return refuse(from, found);
  if (!canServe() || !mayTake(seat, from)) return refuse(from, Mismatch::seat);
  newcomer = {from, true, now};
  std::uint8_t bytes[64];
  PacketWriter writer(bytes);
  writeHello(writer, true);
  sendTo(from, writer);
}

/// A player asks to be let in that plays as far as is known here.
void Session::Impl::receiveRestart(Seat seat) {
  if (state != SessionState::running) return;
  if (isSilentYet(seat)) return sendCommit(seat, admittedIn[seat]);
  if (since(now, links[seat].lastHeard) > kLostAfter) links[seat].restartedAt = now;
}

/// True if a seat was let in whose player has not heard of it yet.
bool Session::Impl::isSilentYet(Seat seat) const {
  return admittedIn[seat] != 0 && ends[seat] == kNever && streams[seat].end() == starts[seat];
}

/// True if a player asks to be let in anew; one that is heard otherwise has not been away.
bool Session::Impl::hasRestarted(Seat seat) const {
  const Link& link = links[seat];
  return link.restartedAt > link.lastHeard && since(now, link.restartedAt) <= kLostAfter;
}

/// True if all that a newcomer must know is settled here: nobody comes or goes.
bool Session::Impl::mayAdmit(Seat seat) const {
  const Newcomer& newcomer = newcomers[seat];
  if (!isFree(seat) || !newcomer.heard || since(now, newcomer.lastHeard) > kForgetAfter || leaving)
    return false;
  if (change.voters() != live() || incomplete != 0) return false;
  for (Seat other = 0; other < seats; ++other) {
    const bool played = ends[other] > starts[other];
    const Tick rests = other == seat && played ? kFreeFor : 0;
    const Tick settled = ends[other] == kNever ? starts[other] : ends[other] + rests;
    if (settled > certain) return false;
  }
  return true;
}

/// The newcomer that this peer serves, once it has caught up and may be let in.
Seat Session::Impl::readyNewcomer() const {
  const bool near = serving.seat != kNoSeat && serving.known != kNever && certain <= serving.known + kNear;
  const auto others = static_cast<SeatMask>(live() & ~bit(settings.localSeat) & ~serving.heard);
  return near && others == 0 && mayAdmit(serving.seat) ? serving.seat : kNoSeat;
}

/// From `start` on the seat is present.
void Session::Impl::admit(Seat seat, Tick start) {
  if (certain > start) return finish(EndReason::diverged);
  openSeat(seat, start);
  admittedIn[seat] = viewNumber;
  controlsUpTo[seat] = start;
  backfillTo[seat] = 0;
  incomplete &= static_cast<SeatMask>(~bit(seat));
  hashes[seat] = HashLog();
  desynced &= static_cast<SeatMask>(~bit(seat));
  // Steps have been made without it.
  if (start < current) wrong = std::min(wrong, start);
  if (remote(seat)) {
    // It says which of these it has already.
    const Tick back = std::min(own().end(), InputStream::kCapacity - 2 * kMaxLead);
    links[seat] = Link();
    links[seat].heard = links[seat].hearsUs = true;
    links[seat].lastHeard = links[seat].lastInput = now;
    links[seat].acked = std::max(own().end() - back, starts[settings.localSeat]);
    links[seat].tick = certain;
    if (newcomers[seat].heard) settings.addresses[seat] = newcomers[seat].address;
    newcomers[seat] = {};
  }
  tell({SessionEvent::Kind::joined, seat, 0, start});
}

/// Begins another time of a seat.
void Session::Impl::openSeat(Seat seat, Tick start) {
  if (ends[seat] > starts[seat]) {
    stays[seat][1] = stays[seat][0];
    stays[seat][0] = {starts[seat], ends[seat]};
  }
  starts[seat] = start;
  ends[seat] = kNever;
  streams[seat].skipTo(start);
}

// ---- What a newcomer is sent.

void Session::Impl::receiveFetch(Seat seat, PacketReader& reader) {
  const bool vouches = reader.u8() != 0;
  const Tick tick = reader.u32();
  const std::uint32_t has = reader.u32();
  const Tick made = reader.u32();
  const SeatMask heard = reader.u16();
  if (!reader.done()) return bad();
  if (vouches) return sendVouch(seat, tick);
  const bool other = serving.seat != kNoSeat && serving.seat != seat;
  if (!canServe() || other) return;
  if (serving.lastAnswered != 0 && since(now, serving.lastAnswered) < kFetchEvery / 2) return;
  const bool same = serving.seat == seat && serving.tick == tick;
  const bool lacks = isFree(seat) || isSilentYet(seat);
  if (!same && (!lacks || !beginServing(seat))) return;
  serving.lastHeard = serving.lastAnswered = now;
  serving.known = same ? made : kNever;
  serving.heard = heard;
  const bool whole = same && made != kNever;
  return whole ? sendLog(has) : sendBlocks(same ? has : 0);
}

/// Copies a state that is certain, and from which on all inputs are here.
bool Session::Impl::beginServing(Seat seat) {
  Tick tick = 0;
  std::uint32_t slot = 0;
  if (!newestKept(tick, slot)) return false;
  for (Seat other = 0; other < seats; ++other) {
    if (plays(other, tick) && !streams[other].has(tick)) return false;
  }
  const std::uint64_t size = game.write(slot, {}, game.data);
  if (size == 0 || size > kMaxState) return false;
  serving = Serving();
  serving.state.resize(size);
  if (game.write(slot, serving.state, game.data) != size) return false;
  serving.seat = seat;
  serving.tick = serving.logged = tick;
  keepLog();
  return true;
}

/// Notes the inputs of the ticks that are certain by now for whom this peer serves.
void Session::Impl::keepLog() {
  if (serving.seat == kNoSeat) return;
  const bool silent = serving.lastHeard != 0 && since(now, serving.lastHeard) > kForgetAfter;
  if (silent || serving.log.size() > kMaxLog) {
    serving = Serving();
    return;
  }
  const auto put = [this](std::span<const std::uint8_t> bytes) {
    serving.log.push_back(static_cast<std::uint8_t>(bytes.size()));
    serving.log.insert(serving.log.end(), bytes.begin(), bytes.end());
  };
  for (; serving.logged < certain; ++serving.logged) {
    for (Seat seat = 0; seat < seats; ++seat) {
      const bool present = plays(seat, serving.logged);
      if (!present) {
        serving.log.push_back(0);
        continue;
      }
      const InputEntry entry = streams[seat].at(serving.logged);
      serving.log.push_back(entry.control == Control::leave ? kPresent | kLast : kPresent);
      put(entry.held);
      put(entry.commands);
    }
  }
}

void Session::Impl::sendBlocks(std::uint32_t from) {
  for (std::uint64_t block = from; block < std::uint64_t{from} + kBlocksAtOnce; ++block) {
    const std::uint64_t begin = block * kBlock;
    if (begin >= serving.state.size()) return;
    const std::uint64_t size = std::min<std::uint64_t>(kBlock, serving.state.size() - begin);
    std::uint8_t bytes[kMaxPacket];
    PacketWriter writer(bytes);
    header(writer, Packet::block);
    writer.u32(serving.tick);
    writer.u32(static_cast<std::uint32_t>(serving.state.size()));
    writer.u32(static_cast<std::uint32_t>(block));
    writer.bytes(std::span(serving.state).subspan(begin, size));
    sendTo(addressOf(serving.seat), writer);
  }
}

void Session::Impl::sendLog(std::uint32_t from) {
  for (std::size_t begin = from, i = 0; begin < serving.log.size() && i < kBlocksAtOnce;
       begin += kBlock, ++i) {
    std::uint8_t bytes[kMaxPacket];
    PacketWriter writer(bytes);
    header(writer, Packet::log);
    writer.u32(serving.tick);
    writer.u32(static_cast<std::uint32_t>(begin));
    writer.bytes(
        std::span(serving.log).subspan(begin, std::min<std::size_t>(kBlock, serving.log.size() - begin)));
    sendTo(addressOf(serving.seat), writer);
  }
}

/// Tells the hash of a state that is certain.
void Session::Impl::sendVouch(Seat seat, Tick tick) {
  if (settings.hashInterval == 0 || tick % keepInterval() != 0) return;
  const KeptHash& kept = keptHashes.of(tick, keepInterval());
  if (kept.tick != tick) return;
  std::uint8_t bytes[32];
  PacketWriter writer(bytes);
  header(writer, Packet::hashes);
  writer.u32(tick);
  writer.u64(kept.hash);
  sendTo(addressOf(seat), writer);
}

Address Session::Impl::addressOf(Seat seat) const {
  return isFree(seat) && newcomers[seat].heard ? newcomers[seat].address : settings.addresses[seat];
}

// ---- As a newcomer.

/// Seats that have said something of late.
Session::Impl::SeatMask Session::Impl::heardOfLate() const {
  SeatMask found = 0;
  for (Seat seat = 0; seat < seats; ++seat) {
    if (links[seat].heard && since(now, links[seat].lastHeard) <= kHeardWithin) found |= bit(seat);
  }
  return found;
}

void Session::Impl::pollJoining() {
  if (joining.helloAt == 0 || since(now, joining.helloAt) >= kHelloEvery) {
    joining.helloAt = now;
    for (Seat seat = 0; seat < seats; ++seat) {
      if (remote(seat) && settings.addresses[seat] != kAnybody) sendHello(seat);
    }
  }
  chooseServer();
  if (joining.from == kNoSeat) return;
  judgeState();
  // Who has lied is asked no more.
  if (joining.from != kNoSeat) fetchMore();
}

/// Asks another one where nothing new has come.
void Session::Impl::chooseServer() {
  const SeatMask able = static_cast<SeatMask>(heardOfLate() & ~joining.liars);
  // Where all stand still, there is no news, and what has come is still good.
  const bool holds = joining.loaded && since(now, links[joining.from].lastHeard) <= kNewsWithin;
  const bool waits = joining.from != kNoSeat && (holds || since(now, joining.since) <= kNewsWithin);
  if (waits || able == 0) return;
  Seat next = joining.from == kNoSeat ? Seat{0} : static_cast<Seat>((joining.from + 1) % seats);
  while ((able & bit(next)) == 0) next = static_cast<Seat>((next + 1) % seats);
  joining.from = next;
  joining.since = now;
}

/// Asks for what is still missing: of the state, of who vouches for it, of the inputs since.
void Session::Impl::fetchMore() {
  if (since(now, joining.fetchedAt) >= kFetchEvery) {
    joining.fetchedAt = now;
    sendFetch(joining.from, false);
  }
  if (joining.loaded || joining.tick == kNever || since(now, joining.vouchedAt) < kVouchEvery) return;
  joining.vouchedAt = now;
  for (Seat seat = 0; seat < seats; ++seat) {
    const bool vouches = (heardOfLate() & bit(seat)) != 0 && joining.vouched[seat].tick != joining.tick;
    if (vouches) sendFetch(seat, true);
  }
}

void Session::Impl::sendFetch(Seat seat, bool vouches) {
  std::uint8_t bytes[32];
  PacketWriter writer(bytes);
  header(writer, Packet::fetch);
  writer.u8(vouches ? 1 : 0);
  writer.u32(joining.tick);
  writer.u32(joining.loaded ? joining.logged : joining.blocks);
  writer.u32(joining.loaded ? current : kNever);
  writer.u16(heardOfLate());
  send(seat, writer);
}

void Session::Impl::receiveAsNewcomer(Seat seat, Packet type, PacketReader& reader) {
  links[seat].lastHeard = now;
  if (type == Packet::hashes) return receiveVouch(seat, reader);
  if (type == Packet::commit) return receiveAdmission(seat, reader);
  if (seat != joining.from) return;
  if (type == Packet::block) return receiveBlock(reader);
  if (type == Packet::log) return receiveLog(reader);
}

void Session::Impl::receiveVouch(Seat seat, PacketReader& reader) {
  const Tick tick = reader.u32();
  const std::uint64_t hash = reader.u64();
  if (!reader.good()) return bad();
  if (tick == joining.tick) joining.vouched[seat] = {tick, hash};
}

void Session::Impl::receiveBlock(PacketReader& reader) {
  const Tick tick = reader.u32();
  const std::uint32_t size = reader.u32();
  const std::uint32_t block = reader.u32();
  const std::uint32_t length = reader.left();
  const std::span<const std::uint8_t> piece = reader.bytes(length);
  const bool fits = reader.good() && size > 0 && size <= kMaxState && std::uint64_t{block} * kBlock < size &&
                    length == std::min(kBlock, size - block * kBlock);
  if (!fits || tick == kNever) return bad();
  if (tick != joining.tick || joining.size != size) {
    // The seat that serves has begun anew.
    if (block != 0) return;
    forgetState();
    joining.tick = tick;
    joining.size = size;
  }
  // Memory is taken for what has come, not for what is announced.
  if (joining.loaded || block != joining.blocks) return;
  joining.state.insert(joining.state.end(), piece.begin(), piece.end());
  ++joining.blocks;
  joining.since = now;
}

void Session::Impl::forgetState() {
  joining.tick = kNever;
  joining.size = joining.blocks = joining.logged = 0;
  joining.state.clear();
  joining.log.clear();
  joining.read = joining.loaded = false;
  joining.vouched.fill({});
}

/// Marks a seat as not to be believed.
void Session::Impl::distrust(Seat seat) {
  tell({SessionEvent::Kind::lied, seat, 0, joining.tick});
  joining.liars |= bit(seat);
  joining.from = kNoSeat;
  forgetState();
  if ((heardOfLate() & ~joining.liars) == 0) finish(EndReason::notAdmitted);
}

/// Once all of the state has come: takes it if its hash is the one that most players have.
void Session::Impl::judgeState() {
  if (joining.loaded || joining.tick == kNever || joining.state.size() != joining.size) return;
  if (!joining.read) {
    if (!game.read(joining.state, game.data)) return distrust(joining.from);
    joining.read = true;
    joining.hash = game.hash(game.data);
    joining.since = now;
  }
  const SeatMask heard = heardOfLate();
  SeatMask same = 0;
  SeatMask other = 0;
  for (Seat seat = 0; seat < seats; ++seat) {
    if ((heard & bit(seat)) == 0 || joining.vouched[seat].tick != joining.tick) continue;
    (joining.vouched[seat].hash == joining.hash ? same : other) |= bit(seat);
  }
  if (2 * count(other) >= count(heard)) return distrust(joining.from);
  if (2 * count(same) <= count(heard)) return;
  joining.loaded = true;
  joining.since = now;
  std::vector<std::uint8_t>().swap(joining.state);
  current = certain = firstTick = joining.parsed = joining.tick;
  hashesUpTo = current - current % settings.hashInterval;
  for (InputStream& stream : streams) stream.reset(current);
}

void Session::Impl::receiveLog(PacketReader& reader) {
  const Tick tick = reader.u32();
  const std::uint32_t from = reader.u32();
  const std::uint32_t length = reader.left();
  const std::span<const std::uint8_t> piece = reader.bytes(length);
  if (!reader.good() || length > kMaxPacket) return bad();
  if (!joining.loaded || tick != joining.tick || from != joining.logged) return;
  // The log that is asked for is never far ahead of the steps.
  if (joining.parsed > current + InputStream::kCapacity / 2) return;
  joining.log.insert(joining.log.end(), piece.begin(), piece.end());
  joining.logged += length;
  if (length > 0) joining.since = now;
  std::uint32_t used = 0;
  for (;;) {
    PacketReader ticks(std::span<const std::uint8_t>(joining.log).subspan(used));
    if (!readTick(ticks, joining.parsed)) break;
    used += ticks.offset();
    ++joining.parsed;
  }
  joining.log.erase(joining.log.begin(), joining.log.begin() + used);
  if (state == SessionState::joining) certain = std::max(certain, joining.parsed);
}

/// Takes the inputs of one tick. @return false where not all of them are there yet
bool Session::Impl::readTick(PacketReader& reader, Tick tick) {
  if (reader.left() == 0) return false;
  struct Read {
    std::uint8_t flags = 0;
    InputEntry entry;
  };
  std::array<Read, kMaxPlayers> read{};
  for (Seat seat = 0; seat < seats; ++seat) {
    read[seat].flags = reader.u8();
    if ((read[seat].flags & kPresent) == 0) continue;
    read[seat].entry.held = reader.bytes(reader.u8());
    read[seat].entry.commands = reader.bytes(reader.u8());
    if ((read[seat].flags & kLast) != 0) read[seat].entry.control = Control::leave;
    if (!reader.good()) return false;
    const bool fits = read[seat].entry.held.size() <= settings.maxHeldBytes &&
                      read[seat].entry.commands.size() <= settings.maxCommandBytes;
    if (!fits) {
      // No player has such inputs.
      if (state == SessionState::joining) distrust(joining.from);
      return false;
    }
  }
  if (!reader.good()) return false;
  for (Seat seat = 0; seat < seats; ++seat)
    takeLogged(seat, tick, (read[seat].flags & kPresent) != 0, read[seat].entry);
  return true;
}

void Session::Impl::takeLogged(Seat seat, Tick tick, bool present, const InputEntry& entry) {
  InputStream& stream = streams[seat];
  if (state != SessionState::joining) {
    // Decisions say who plays; inputs may have come from their players as well.
    if (!present || tick != stream.end() || tick >= inputLimit(seat)) return;
    if (!stream.append(entry)) wrong = std::min(wrong, tick);
    return takeControls(seat);
  }
  if (!present) {
    if (ends[seat] == kNever) ends[seat] = tick;
    return;
  }
  if (ends[seat] != kNever) openSeat(seat, tick);
  stream.append(entry);
  controlsUpTo[seat] = tick + 1;
  if (entry.control == Control::leave) ends[seat] = tick + 1;
}

/// Makes the steps whose inputs have come.
Frame Session::Impl::frameJoining() {
  if (!joining.loaded) return Frame::idle;
  const Tick to = std::min(certain, current + kMostCatchUp);
  if (current == to) return Frame::waiting;
  while (current < to) {
    step(current);
    ++current;
    hashState();
  }
  return Frame::advanced;
}

/// Somebody says that all have agreed to let us in: believed when most who are heard say the same.
void Session::Impl::receiveAdmission(Seat seat, PacketReader& reader) {
  const std::uint32_t number = reader.u32();
  const View view = getView(reader);
  if (!reader.done()) return bad();
  const bool ours = view.joined == bit(settings.localSeat) && view.voters >> seats == 0;
  if (!ours || !joining.loaded || view.start < certain) return;
  vouchedFor[seat] = view;
  joining.numbers[seat] = number;
  SeatMask same = 0;
  for (Seat other = 0; other < seats; ++other) {
    if (remote(other) && vouchedFor[other] == view && joining.numbers[other] == number) same |= bit(other);
  }
  if (2 * count(same) <= count(heardOfLate())) return;
  for (Seat other = 0; other < seats; ++other) {
    Link& link = links[other];
    link.heard = link.hearsUs = true;
    link.lastHeard = link.lastInput = now;
    link.acked = view.start;
    link.tick = certain;
  }
  state = SessionState::running;
  viewNumber = number - 1;
  decide(view);
  tell({SessionEvent::Kind::started});
}

/// Asks the seat that has served us for what is still lacking, until we have come so far.
void Session::Impl::fetchRest() {
  if (joining.from == kNoSeat || certain > starts[settings.localSeat] + kJoinLead) return;
  if (since(now, joining.fetchedAt) < kFetchEvery) return;
  joining.fetchedAt = now;
  if ((live() & bit(joining.from)) != 0) sendFetch(joining.from, false);
}

}  // namespace samestep
