// SPDX-License-Identifier: MIT
// What is sent and received.
#include <algorithm>

#include "session/session_impl.h"

namespace samestep {

using namespace lockstep;

namespace {

/// No poll reads more than so many datagrams: whoever floods a peer shall not stop its frames.
constexpr int kMostReceived = 512;
constexpr std::uint64_t kHelloEvery = 100'000;
constexpr std::uint64_t kCommitEvery = 50'000;
constexpr std::uint64_t kWantEvery = 50'000;
/// Beside how far the other is behind.
constexpr std::uint8_t kPaused = 128;
constexpr std::uint32_t kHashesTold = 2;

/// The tick nearest to `near` with these low bits.
Tick unwrap(std::uint16_t low, Tick near) {
  const std::uint16_t step = static_cast<std::uint16_t>(low - near);
  return near + static_cast<Tick>(static_cast<std::int32_t>(static_cast<std::int16_t>(step)));
}

}  // namespace

void Session::Impl::poll(std::uint64_t time) {
  const std::uint64_t gap = std::max(now, time) - now;
  now += gap;
  // A peer that was not looking cannot say that the others were silent.
  if (gap > settings.interruptedAfter) {
    for (Link& link : links) {
      link.lastHeard += gap;
      link.lastInput += gap;
    }
  }
  if (state == SessionState::ended) return;
  std::uint8_t bytes[kMaxDatagram];
  Address from = 0;
  for (int i = 0; i < kMostReceived && state != SessionState::ended; ++i) {
    const std::uint32_t size = transport.receive(from, std::span<std::uint8_t>(bytes), transport.data);
    if (size == 0) break;
    receive(from, {bytes, size});
  }
  if (state == SessionState::ended) return;
  if (state == SessionState::joining) return pollJoining();
  confirm();
  watchLinks();
  if (state == SessionState::running) {
    sendWants();
    fetchRest();
    locate();
    agree();
    finishLeaving();
  }
}

/// Ends the session of a player that has left once all have its last input and need its vote no more.
void Session::Impl::finishLeaving() {
  const Seat self = settings.localSeat;
  if ((live() & bit(self)) != 0) return;
  if (endsAt == 0) endsAt = now + settings.endAfter;
  bool known = (change.voters() & bit(self)) == 0 || live() == 0;
  for (Seat seat = 0; seat < seats; ++seat) {
    // A peer that has left as well may have all and be gone, or still lack our last input.
    const bool dropped = (change.voters() & bit(seat)) == 0;
    const bool gone = ends[seat] != kNever && now - links[seat].lastHeard > settings.goneAfter;
    if (remote(seat)) known &= dropped || gone || links[seat].acked >= own().end();
  }
  if (!known && now < endsAt) return;
  // The others may wait to hear that we have theirs.
  for (Seat seat = 0; seat < seats; ++seat) {
    if (remote(seat)) sendInputs(seat);
  }
  finish(EndReason::left);
}

void Session::Impl::receive(Address from, std::span<const std::uint8_t> bytes) {
  PacketReader reader(bytes);
  const std::uint8_t first = reader.u8();
  const std::uint8_t match = reader.u8();
  const std::uint8_t view = reader.u8();
  const auto type = static_cast<Packet>(first & 15);
  const Seat seat = first >> 4;
  if (!reader.good() || seat >= seats || !remote(seat) || match != static_cast<std::uint8_t>(settings.match))
    return bad();
  const bool asks = type == Packet::hello || type == Packet::fetch;
  if (asks && isFree(seat)) return receiveNewcomer(seat, from, type, reader);
  if (addressOf(seat) != from) {
    const bool joins =
        type == Packet::hello && state == SessionState::running && (reader.u8() & kWantsToJoin) != 0;
    if (joins && (live() & bit(seat)) != 0) refuse(from, Mismatch::seat);
    return bad();
  }
  Link& link = links[seat];
  if (type == Packet::hello) return receiveHello(seat, reader);
  if (type == Packet::refuse) {
    const std::uint8_t why = reader.u8();
    const bool begins = state == SessionState::connecting || state == SessionState::joining;
    if (!begins || !reader.done()) return bad();
    tell({SessionEvent::Kind::refused, seat, why});
    return finish(EndReason::refused);
  }
  // A newcomer that was let in may be the only one left who can say so.
  const bool decided = type == Packet::commit && newcomers[seat].heard && state == SessionState::running;
  if (!link.heard && !decided) return;
  if (state == SessionState::joining) return receiveAsNewcomer(seat, type, reader);
  if (state != SessionState::running) return;
  const auto behind = static_cast<std::int8_t>(static_cast<std::uint8_t>(viewNumber) - view);
  if (behind > 0 && now - link.lastCommit >= kCommitEvery) {
    link.lastCommit = now;
    sendCommit(seat, viewNumber - static_cast<std::uint32_t>(behind) + 1);
  }
  if (type == Packet::commit) return receiveCommit(seat, reader);
  // Inputs that the seat gave before it was dropped have their place in the decision.
  if (ends[seat] != kNever && (change.voters() & bit(seat)) == 0) return;
  // A newcomer that has just been let in may ask for what it lacks.
  if (type == Packet::fetch) return receiveFetch(seat, reader);
  if (type == Packet::log && seat == joining.from) return receiveLog(reader);
  link.lastHeard = now;
  // Ballots of another decision mean nothing here.
  const bool decision = type >= Packet::prepare && type <= Packet::accepted;
  if (decision && behind != 0) return;
  receiveFrom(seat, type, reader);
}

void Session::Impl::receiveFrom(Seat seat, Packet type, PacketReader& reader) {
  switch (type) {
    case Packet::inputs:
      return receiveInputs(seat, reader);
    case Packet::prepare:
      return receivePrepare(seat, reader);
    case Packet::promise:
      return receivePromise(seat, reader);
    case Packet::accept:
      return receiveAccept(seat, reader);
    case Packet::accepted:
      return receiveAccepted(seat, reader);
    case Packet::want:
      return receiveWant(seat, reader);
    case Packet::backfill:
      return receiveBackfill(reader);
    case Packet::hashes:
      return receiveHashes(seat, reader);
    case Packet::ask:
      return receiveAsk(seat, reader);
    case Packet::answer:
      return receiveAnswer(seat, reader);
    case Packet::block:
      // The state that it belongs to is no more needed.
      return;
    default:
      return bad();
  }
}

/// Few bytes, for there are many packets: hellos have compared the rest.
void Session::Impl::header(PacketWriter& writer, Packet type) const {
  writer.u8(static_cast<std::uint8_t>(static_cast<std::uint8_t>(type) | settings.localSeat << 4));
  writer.u8(static_cast<std::uint8_t>(settings.match));
  writer.u8(static_cast<std::uint8_t>(viewNumber));
}

void Session::Impl::send(Seat seat, const PacketWriter& writer) {
  links[seat].lastSent = now;
  sendTo(settings.addresses[seat], writer);
}

void Session::Impl::sendTo(Address to, const PacketWriter& writer) {
  ++stats.sentPackets;
  stats.sentBytes += writer.size();
  transport.send(to, writer.written(), transport.data);
}

void Session::Impl::sendHello(Seat seat) {
  std::uint8_t bytes[64];
  PacketWriter writer(bytes);
  writeHello(writer, links[seat].heard);
  send(seat, writer);
}

void Session::Impl::writeHello(PacketWriter& writer, bool heard) const {
  header(writer, Packet::hello);
  writer.u8(static_cast<std::uint8_t>((heard ? kHearsYou : 0) |
                                      (state == SessionState::joining ? kWantsToJoin : 0)));
  writer.u16(kProtocol);
  writer.u32(settings.match);
  writer.u8(settings.players);
  writer.u8(seats);
  writer.u8(settings.maxHeldBytes);
  writer.u8(settings.maxCommandBytes);
  writer.u16(settings.hashInterval);
  writer.u32(settings.revision);
  writer.u64(settings.fingerprint);
  writer.u64(settings.content);
}

/// The first thing in which a hello differs from ours.
Mismatch Session::Impl::mismatch(PacketReader& reader) const {
  if (reader.u16() != kProtocol || reader.u32() != settings.match) return Mismatch::protocol;
  if (reader.u8() != settings.players || reader.u8() != seats) return Mismatch::players;
  const bool sameBounds = reader.u8() == settings.maxHeldBytes && reader.u8() == settings.maxCommandBytes;
  if (!sameBounds || reader.u16() != settings.hashInterval) return Mismatch::settings;
  if (reader.u32() != settings.revision) return Mismatch::revision;
  if (reader.u64() != settings.fingerprint) return Mismatch::fingerprint;
  if (reader.u64() != settings.content) return Mismatch::content;
  return reader.done() ? Mismatch::none : Mismatch::protocol;
}

void Session::Impl::receiveHello(Seat seat, PacketReader& reader) {
  const std::uint8_t flags = reader.u8();
  const bool hearsUs = (flags & kHearsYou) != 0;
  const Mismatch found = mismatch(reader);
  if (!reader.good()) return bad();
  if (found != Mismatch::none) {
    if (state != SessionState::connecting) return bad();
    refuse(settings.addresses[seat], found);
    tell({SessionEvent::Kind::refused, seat, static_cast<std::uint8_t>(found)});
    return finish(EndReason::refused);
  }
  if ((flags & kWantsToJoin) != 0) return receiveRestart(seat);
  links[seat].heard = true;
  links[seat].lastHeard = now;
  links[seat].hearsUs |= hearsUs;
  if (!hearsUs) sendHello(seat);
  if (state != SessionState::connecting) return;
  for (Seat other = 0; other < settings.players; ++other) {
    if (remote(other) && !links[other].heard) return;
  }
  state = SessionState::running;
  for (Link& link : links) link.lastHeard = link.lastInput = now;
  tell({SessionEvent::Kind::started});
}

void Session::Impl::sendInputs(Seat seat) {
  const Link& link = links[seat];
  if (ends[seat] != kNever && (change.voters() & bit(seat)) == 0) return;
  std::uint8_t bytes[kMaxPacket];
  PacketWriter writer(bytes);
  header(writer, Packet::inputs);
  writer.u16(static_cast<std::uint16_t>(link.acked));
  writer.u16(static_cast<std::uint16_t>(streams[seat].end()));
  const auto ahead = static_cast<std::int32_t>(current - link.acked);
  writer.u8(static_cast<std::uint8_t>(std::clamp(ahead, -128, 127)));
  const std::int32_t lag = std::clamp(link.lagHere / 128, -64, 63) + 64;
  writer.u8(static_cast<std::uint8_t>(lag | (paused ? kPaused : 0)));
  // A peer that goes on without saying that ours came cannot be told them for ever.
  if (own().has(link.acked)) encodeEntries(writer, own(), link.acked, own().end());
  send(seat, writer);
}

void Session::Impl::receiveInputs(Seat seat, PacketReader& reader) {
  Link& link = links[seat];
  const Tick base = unwrap(reader.u16(), streams[seat].end());
  const Tick acked = unwrap(reader.u16(), link.acked);
  const std::uint8_t ahead = reader.u8();
  const std::uint8_t last = reader.u8();
  const std::int32_t lag = (last & (kPaused - 1)) - 64;
  if (!reader.good() || base > streams[seat].end() + InputStream::kCapacity || acked > own().end())
    return bad();
  link.acked = std::max(link.acked, acked);
  const Tick tick = base + static_cast<Tick>(static_cast<std::int32_t>(static_cast<std::int8_t>(ahead)));
  // Late packets have old news.
  if (tick + kMaxLead >= link.tick && tick <= certain + 4 * kMaxLead && tick >= link.tick) {
    link.tick = tick;
    link.lagThere += (lag * 128 - link.lagThere) / 4;
    if (link.paused != ((last & kPaused) != 0)) {
      link.paused = !link.paused;
      link.pausedSince = now;
      tell({link.paused ? SessionEvent::Kind::paused : SessionEvent::Kind::unpaused, seat});
    }
  }
  if ((change.frozen() & bit(seat)) != 0) return;
  if (!decodeEntries(reader, streams[seat], base, inputLimit(seat), wrong)) bad();
  takeControls(seat);
}

/// Looks whether the last input of a seat is its very last.
void Session::Impl::takeControls(Seat seat) {
  InputStream& stream = streams[seat];
  if (ends[seat] != kNever || !stream.has(stream.end() - 1)) return;
  // Inputs after a last one are no inputs.
  for (Tick tick = controlsUpTo[seat]; tick < stream.end(); ++tick) {
    if (!stream.has(tick) || stream.at(tick).control != Control::leave) continue;
    stream.truncate(tick + 1);
    seatEnds(seat, tick + 1, SessionEvent::Kind::left);
    return;
  }
  controlsUpTo[seat] = stream.end();
}

void Session::Impl::sendHashes() {
  std::uint8_t bytes[128];
  PacketWriter writer(bytes);
  header(writer, Packet::hashes);
  writer.u32(hashesUpTo);
  // The one before goes with it, in case it was lost.
  for (std::uint32_t back = 0; back < kHashesTold; ++back) {
    const Tick tick = hashesUpTo - back * settings.hashInterval;
    const KeptHash& kept = hashes[settings.localSeat].of(tick, settings.hashInterval);
    if (kept.tick != tick) break;
    writer.u64(kept.hash);
  }
  for (Seat seat = 0; seat < seats; ++seat) {
    if (remote(seat) && ends[seat] == kNever) send(seat, writer);
  }
}

void Session::Impl::receiveHashes(Seat seat, PacketReader& reader) {
  const Tick newest = reader.u32();
  if (settings.hashInterval == 0 || newest % settings.hashInterval != 0) return bad();
  for (std::uint32_t back = 0; reader.good() && reader.left() > 0 && back < kHashesTold; ++back) {
    const std::uint64_t hash = reader.u64();
    const Tick tick = newest - back * settings.hashInterval;
    if (!reader.good() || tick > newest || tick > certain + 4 * kMaxLead) return bad();
    KeptHash& kept = hashes[seat].of(tick, settings.hashInterval);
    if (kept.tick != kNever && kept.tick >= tick) continue;
    kept = {tick, hash};
    compareHash(seat, tick);
  }
  if (!reader.done()) bad();
}

/// Asks for the inputs of dropped seats that the others have.
void Session::Impl::sendWants() {
  for (Seat gone = 0; gone < seats; ++gone) {
    if (streams[gone].end() >= backfillTo[gone]) incomplete &= static_cast<SeatMask>(~bit(gone));
  }
  if (incomplete == 0 || now - wantedAt < kWantEvery) return;
  wantedAt = now;
  for (Seat gone = 0; gone < seats; ++gone) {
    if ((incomplete & bit(gone)) == 0) continue;
    std::uint8_t bytes[16];
    PacketWriter writer(bytes);
    header(writer, Packet::want);
    writer.u8(gone);
    writer.u32(streams[gone].end());
    for (Seat seat = 0; seat < seats; ++seat) {
      if (remote(seat) && seat != gone && (change.voters() & bit(seat)) != 0) send(seat, writer);
    }
  }
}

void Session::Impl::receiveWant(Seat seat, PacketReader& reader) {
  const Seat gone = reader.u8();
  const Tick from = reader.u32();
  if (!reader.done() || gone >= seats) return bad();
  const InputStream& stream = streams[gone];
  const bool stands = ends[gone] != kNever || (change.frozen() & bit(gone)) != 0;
  if (!stands || !stream.has(from)) return;
  std::uint8_t bytes[kMaxPacket];
  PacketWriter writer(bytes);
  header(writer, Packet::backfill);
  writer.u8(gone);
  writer.u32(from);
  encodeEntries(writer, stream, from, stream.end());
  send(seat, writer);
}

void Session::Impl::receiveBackfill(PacketReader& reader) {
  const Seat gone = reader.u8();
  const Tick base = reader.u32();
  if (!reader.good() || gone >= seats) return bad();
  if ((incomplete & bit(gone)) == 0) return;
  if (!decodeEntries(reader, streams[gone], base, std::min(ends[gone], backfillTo[gone]), wrong)) bad();
}

/// Says again what may have been lost, and notices who is silent.
void Session::Impl::watchLinks() {
  for (Seat seat = 0; seat < seats; ++seat) {
    Link& link = links[seat];
    if (!remote(seat)) continue;
    if (state == SessionState::connecting) {
      if (seat >= settings.players) continue;
      if (link.lastSent == 0 || now - link.lastSent >= kHelloEvery) sendHello(seat);
      continue;
    }
    // A peer that waits for others has made the input of the step that all wait for.
    const bool grows = streams[seat].end() != link.endSeen;
    link.endSeen = streams[seat].end();
    const bool rests = link.paused && now - link.pausedSince < settings.pausedAtMost;
    if (grows || link.endSeen > certain || rests || paused) link.lastInput = now;
    if (now - link.lastSent >= settings.resendAfter) sendInputs(seat);
    if (ends[seat] != kNever) continue;
    const bool silent = now - link.lastHeard >= settings.interruptedAfter;
    if (silent == link.interrupted) continue;
    link.interrupted = silent;
    tell({silent ? SessionEvent::Kind::interrupted : SessionEvent::Kind::resumed, seat});
  }
}

}  // namespace samestep
