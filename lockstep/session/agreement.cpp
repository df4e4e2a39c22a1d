// SPDX-License-Identifier: MIT
// Who is dropped, and with which last input.
#include <algorithm>

#include "session/session_impl.h"

namespace samestep {

using namespace lockstep;

namespace {

// Microseconds. Peers begin one after another, so that one ballot at a time is under way.
constexpr std::uint64_t kTurn = 400'000;
constexpr std::uint64_t kBallotLasts = 1'000'000;
constexpr std::uint64_t kAskEvery = 60'000;

void put(PacketWriter& writer, const View& view) {
  writer.u16(view.voters);
  writer.u16(view.dropped);
  for (Seat seat = 0; seat < kMaxPlayers; ++seat) {
    if ((view.dropped & bit(seat)) != 0) writer.u32(view.end[seat]);
  }
  writer.u16(view.joined);
  if (view.joined != 0) writer.u32(view.start);
}

}  // namespace

View lockstep::getView(PacketReader& reader) {
  View view;
  view.voters = reader.u16();
  view.dropped = reader.u16();
  if ((view.voters & view.dropped) != 0 || view.voters == 0) reader.fail();
  for (Seat seat = 0; seat < kMaxPlayers; ++seat) {
    if ((view.dropped & bit(seat)) != 0) view.end[seat] = reader.u32();
  }
  view.joined = reader.u16();
  if (view.joined != 0) view.start = reader.u32();
  if (count(view.joined) > 1 || (view.joined & ~view.voters) != 0) reader.fail();
  return view;
}

/// True if a seat was heard of late, and its inputs are not what is waited for.
bool Session::Impl::delivers(Seat seat, std::uint64_t within) const {
  return !remote(seat) || (!hasRestarted(seat) && now - links[seat].lastHeard <= within &&
                           now - links[seat].lastInput <= within);
}

/// True if a view of others names only seats that vote now, and whom it lets in a seat that is there and
/// free.
bool Session::Impl::withinVoters(const View& view) const {
  const bool known = (((view.voters & ~view.joined) | view.dropped) & ~change.voters()) == 0;
  return known && (view.joined & change.voters()) == 0 && view.joined >> seats == 0;
}

Session::Impl::SeatMask Session::Impl::suspected() const {
  SeatMask found = 0;
  for (Seat seat = 0; seat < seats; ++seat) {
    if (!delivers(seat, settings.dropAfter)) found |= bit(seat);
  }
  return static_cast<SeatMask>(found & live());
}

/// Brings about a decision where one is needed.
void Session::Impl::agree() {
  const SeatMask gone = suspected();
  const bool leaves = (change.voters() & ~live()) != 0 || change.underWay();
  const bool admits = readyNewcomer() != kNoSeat;
  const bool needed = gone != 0 || leaves || admits;
  if (!needed) changeSince = 0;
  if (!needed || (live() & bit(settings.localSeat)) == 0) return;
  if (changeSince == 0) changeSince = now;
  const std::uint64_t passed = now - changeSince;
  if ((gone | change.frozen()) == 0) goneSince = now;
  if (now - std::max(goneSince, changeSince) > settings.endAfter) return finish(EndReason::minority);
  const SeatMask before = static_cast<SeatMask>(live() & ~gone & (bit(settings.localSeat) - 1));
  // Only who has sent it the state lets a newcomer in.
  const std::uint64_t turn = gone == 0 && !leaves ? 0 : kTurn * static_cast<std::uint64_t>(count(before));
  if (passed < turn) return;
  if (proposedAt == 0 || now - proposedAt > kBallotLasts + turn) propose();
  if (change.proposing() && now - askedAt >= kAskEvery) askVoters();
}

void Session::Impl::propose() {
  const SeatMask gone = suspected();
  const Seat self = settings.localSeat;
  proposedAt = now;
  const Seat newcomer = gone == 0 ? readyNewcomer() : kNoSeat;
  const SeatMask joined = newcomer == kNoSeat ? SeatMask{0} : bit(newcomer);
  change.propose(self, static_cast<SeatMask>(live() & ~gone), gone, joined, certain + kJoinLead);
  change.promise(change.ballot(), gone, joined, change.start());
  ViewChange::Promise promise{change.ballot(), change.acceptedBallot(), change.accepted(), {}};
  for (Seat seat = 0; seat < seats; ++seat) promise.end[seat] = streams[seat].end();
  change.promisedBy(self, promise);
  askVoters();
}

/// Says again what the ballot asks of those who have not answered.
void Session::Impl::askVoters() {
  askedAt = now;
  // Our own vote is cast when all have promised.
  const bool votes = change.asking() && (change.missing() & bit(settings.localSeat)) != 0;
  if (votes && haveAll(change.value())) {
    if (!change.accept(change.ballot(), change.value())) return change.yield();
    if (change.acceptedBy(settings.localSeat, change.ballot())) return decide(View(change.value()));
  }
  for (Seat seat = 0; seat < seats; ++seat) {
    if (remote(seat) && (change.missing() & bit(seat)) != 0) askVoter(seat);
  }
}

void Session::Impl::askVoter(Seat seat) {
  std::uint8_t bytes[128];
  PacketWriter writer(bytes);
  header(writer, change.asking() ? Packet::accept : Packet::prepare);
  writer.u32(change.ballot());
  if (change.asking()) {
    put(writer, change.value());
  } else {
    writer.u16(change.dropped());
    writer.u16(change.joined());
    writer.u32(change.start());
  }
  send(seat, writer);
}

void Session::Impl::receivePrepare(Seat seat, PacketReader& reader) {
  const std::uint32_t ballot = reader.u32();
  const SeatMask dropped = reader.u16();
  const SeatMask joined = reader.u16();
  const Tick start = reader.u32();
  if (!reader.done() || (ballot & 15) != seat || count(joined) > 1 || joined >> seats != 0) return bad();
  if (joined != 0 && (dropped != 0 || start < certain || start > certain + 4 * kMaxLead)) return;
  // Nobody helps to drop itself, or whom it hears.
  for (Seat gone = 0; gone < seats; ++gone) {
    if ((dropped & bit(gone)) != 0 && delivers(gone, settings.interruptedAfter)) return;
    if ((joined & bit(gone)) != 0 && !mayAdmit(gone)) return;
  }
  if (change.promise(ballot, dropped, joined, start) && change.ballot() < ballot) {
    change.yield();
    proposedAt = now;
  }
  sendPromise(seat, ballot);
}

/// Answers with the highest ballot promised, which tells a lower one that it is late.
void Session::Impl::sendPromise(Seat to, std::uint32_t ballot) {
  std::uint8_t bytes[256];
  PacketWriter writer(bytes);
  header(writer, Packet::promise);
  writer.u32(std::max(ballot, change.promised()));
  writer.u32(change.acceptedBallot());
  if (change.acceptedBallot() != 0) put(writer, change.accepted());
  for (const InputStream& stream : streams) writer.u32(stream.end());
  send(to, writer);
}

void Session::Impl::receivePromise(Seat seat, PacketReader& reader) {
  ViewChange::Promise promise;
  promise.ballot = reader.u32();
  promise.acceptedBallot = reader.u32();
  if (promise.acceptedBallot != 0) promise.accepted = getView(reader);
  for (Seat other = 0; other < seats; ++other) {
    promise.end[other] = reader.u32();
    // Nobody can have so many.
    if (promise.end[other] > certain + 8 * kMaxLead) reader.fail();
  }
  if (!reader.done()) return bad();
  if (promise.ballot > change.promised()) {
    change.promise(promise.ballot, 0);
    return change.yield();
  }
  const bool before = change.asking();
  change.promisedBy(seat, promise);
  if (!before && change.asking()) askVoters();
}

void Session::Impl::receiveAccept(Seat seat, PacketReader& reader) {
  const std::uint32_t ballot = reader.u32();
  const View view = getView(reader);
  if (!reader.done() || (ballot & 15) != seat || !withinVoters(view)) return bad();
  if ((view.dropped & bit(settings.localSeat)) != 0 || ballot < change.promised()) return;
  // All who stay have promised it: a value that nobody proposed is forged.
  if ((view.dropped & ~change.frozen()) != 0) return bad();
  if ((view.joined & ~change.joining()) != 0 || (view.joined != 0 && view.start < change.barrier()))
    return bad();
  // The proposer asks again.
  if (!haveAll(view) || !change.accept(ballot, view)) return;
  if (change.ballot() < ballot) change.yield();
  sendAccepted(seat, ballot);
}

void Session::Impl::sendAccepted(Seat to, std::uint32_t ballot) {
  std::uint8_t bytes[16];
  PacketWriter writer(bytes);
  header(writer, Packet::accepted);
  writer.u32(ballot);
  send(to, writer);
}

void Session::Impl::receiveAccepted(Seat seat, PacketReader& reader) {
  const std::uint32_t ballot = reader.u32();
  if (!reader.done()) return bad();
  if (change.acceptedBy(seat, ballot)) decide(View(change.value()));
}

void Session::Impl::sendCommit(Seat to, std::uint32_t number) {
  if (number == 0 || number > viewNumber || number + kKeptViews <= viewNumber) return;
  std::uint8_t bytes[128];
  PacketWriter writer(bytes);
  header(writer, Packet::commit);
  writer.u32(number);
  put(writer, views[number % kKeptViews]);
  send(to, writer);
}

void Session::Impl::receiveCommit(Seat seat, PacketReader& reader) {
  const std::uint32_t number = reader.u32();
  const View view = getView(reader);
  if (!reader.done()) return bad();
  if (number != viewNumber + 1) return;
  if (!withinVoters(view)) return bad();
  // A peer that stays has accepted what is decided; others believe as many as may decide.
  const bool accepted = change.acceptedBallot() != 0 && change.accepted() == view;
  if (accepted || vouched(seat, view)) return decide(view);
  bad();
}

/// Notes what a seat says was decided. @return whether so many say the same that it must be so
bool Session::Impl::vouched(Seat seat, const View& view) {
  vouchedFor[seat] = view;
  SeatMask same = 0;
  for (Seat other = 0; other < seats; ++other) {
    if (remote(other) && vouchedFor[other] == view) same |= bit(other);
  }
  return quorum(same, change.voters());
}

/// Tells whether all inputs of those to be dropped are here; asks the others for what is not.
bool Session::Impl::haveAll(const View& view) {
  bool all = true;
  for (Seat seat = 0; seat < seats; ++seat) {
    if ((view.dropped & bit(seat)) == 0 || streams[seat].end() >= view.end[seat]) continue;
    all = false;
    incomplete |= bit(seat);
    backfillTo[seat] = view.end[seat];
  }
  return all;
}

void Session::Impl::decide(const View& view) {
  ++viewNumber;
  views[viewNumber % kKeptViews] = view;
  const SeatMask known = static_cast<SeatMask>(change.voters() | view.voters);
  change.begin(view.voters);
  vouchedFor.fill({});
  // Inputs that were frozen may come now.
  for (Link& link : links) link.lastInput = now;
  for (Seat seat = 0; seat < seats; ++seat) {
    if ((view.joined & bit(seat)) != 0) admit(seat, view.start);
  }
  changeSince = 0;
  proposedAt = 0;
  for (Seat seat = 0; seat < seats; ++seat) {
    if (remote(seat) && (known & bit(seat)) != 0) sendCommit(seat, viewNumber);
  }
  if ((view.dropped & bit(settings.localSeat)) != 0) return finish(EndReason::dropped);
  for (Seat seat = 0; seat < seats && state == SessionState::running; ++seat) {
    if ((view.dropped & bit(seat)) != 0) drop(seat, view.end[seat]);
  }
}

void Session::Impl::drop(Seat seat, Tick end) {
  if (ends[seat] <= end) return;
  InputStream& stream = streams[seat];
  if (stream.end() > end && certain > end) return finish(EndReason::diverged);
  stream.truncate(end);
  if (stream.end() < end) incomplete |= bit(seat);
  backfillTo[seat] = end;
  seatEnds(seat, end, SessionEvent::Kind::dropped);
}

/// Makes the seat absent from `end` on.
void Session::Impl::seatEnds(Seat seat, Tick end, SessionEvent::Kind kind) {
  ends[seat] = end;
  // Steps have been made with what it was predicted to hold.
  if (end < current) wrong = std::min(wrong, end);
  tell({kind, seat, 0, end});
}

}  // namespace samestep
