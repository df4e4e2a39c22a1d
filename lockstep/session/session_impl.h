// SPDX-License-Identifier: MIT
// What the parts of a Session share. Its subjects: session.cpp (settings and questions), frames.cpp (steps,
// saves and rollbacks), packets.cpp (what is sent and received), agreement.cpp (who is dropped), locate.cpp
// (what differs after a desync).
#pragma once

#include <samestep/session.h>

#include <array>
#include <vector>

#include "session/input_stream.h"
#include "session/view_change.h"

namespace samestep {

namespace lockstep {

/// The first byte of every packet, in its low four bits; the others are the sender's seat.
enum class Packet : std::uint8_t {
  hello = 0,    ///< Settings that must be the same everywhere, and whom the sender has heard.
  refuse = 1,   ///< Reason why the sender will not play with the receiver.
  inputs = 2,   ///< Inputs the receiver lacks, and how many of its own have come.
  prepare = 3,  ///< Ballot: who shall be dropped?
  promise = 4,
  accept = 5,
  accepted = 6,
  commit = 7,    ///< A decision.
  want = 8,      ///< Asks for inputs of a dropped player.
  backfill = 9,  ///< Answers with them.
  hashes = 10,   ///< Hashes of certain states.
  ask = 11,      ///< A peer asks after a desync for the hashes of the parts of a part of a state.
  answer = 12,
};
inline constexpr std::uint32_t kProtocol = 1;
inline constexpr Tick kNever = 0xffffffffu;
/// No input is made for a tick further ahead of the last certain one.
inline constexpr Tick kMaxLead = kMaxWindow + kMaxInputDelay;
static_assert(8 * kMaxLead <= InputStream::kCapacity, "a stream keeps what any peer may still ask for");
/// Number of decisions and of hashes that are remembered.
inline constexpr std::uint32_t kKeptViews = 2 * kMaxPlayers;
inline constexpr std::uint32_t kKeptHashes = 16;
inline constexpr std::uint32_t kKeptEvents = 64;
inline constexpr std::uint32_t kKeptCommands = 32;

/// Link to another peer.
struct Link {
  bool heard = false;    ///< Its hello came and is as ours.
  bool hearsUs = false;  ///< It has said that ours came.
  bool paused = false;
  bool interrupted = false;
  std::uint64_t lastHeard = 0;
  /// Time at which we last had no need to wait for its next input.
  std::uint64_t lastInput = 0;
  Tick endSeen = 0;  ///< End of its inputs, at the last look.
  std::uint64_t pausedSince = 0;
  std::uint64_t lastSent = 0;
  std::uint64_t lastCommit = 0;
  std::uint64_t lastAnswered = 0;
  /// End of our inputs that it has: the tick after the last one.
  Tick acked = 0;
  /// Its newest known step.
  Tick tick = 0;
  /// Ticks by which it is behind here, and we there, in 256ths, smoothed.
  std::int32_t lagHere = 0;
  std::int32_t lagThere = 0;
};

struct KeptHash {
  Tick tick = kNever;
  std::uint64_t hash = 0;
};

/// Hashes after certain steps, the newest kKeptHashes.
struct HashLog {
  std::array<KeptHash, kKeptHashes> kept;
  KeptHash& of(Tick tick, std::uint32_t interval) { return kept[tick / interval % kKeptHashes]; }
};

/// A state is kept every so many ticks.
inline constexpr Tick kKeepEvery = 30;
/// A part of one level has kParts of the level below; one of level 0 is a value.
inline constexpr std::uint64_t kParts = 64;
inline constexpr std::uint8_t kTopLevel = 4;

/// The search for what differs.
struct Locating {
  Locating() { kept.fill(kNever); }
  std::array<Tick, kKeepSlots> kept;
  Tick pinned = kNever;               ///< Is not replaced any more.
  std::vector<std::uint64_t> hashes;  ///< Hashes of the values of the pinned state.
  bool asking = false;
  bool done = false;
  Seat seat = kNoSeat;
  Tick from = 0;
  std::uint8_t level = 0;
  std::uint64_t part = 0;
  std::uint64_t since = 0;
  std::uint64_t askedAt = 0;
  DesyncReport report;
};

}  // namespace lockstep

struct Session::Impl {
  using Link = lockstep::Link;
  using SeatMask = lockstep::SeatMask;
  using PacketReader = lockstep::PacketReader;
  using PacketWriter = lockstep::PacketWriter;

  Impl(const SessionSettings& initial, const Game& functions, const Transport& datagrams);

  // Frames.
  Frame frame(std::span<const std::uint8_t> held);
  void produce(std::span<const std::uint8_t> held);
  void appendOwn(std::span<const std::uint8_t> held);
  void confirm();
  bool complete(Tick tick) const;
  void rollBack();
  bool mayStep() const;
  void prepareStep();
  void step(Tick tick);
  void save(Tick tick);
  std::uint32_t slotOf(Tick atMost) const;
  std::uint32_t freeSlot() const;
  void showAhead();
  void takeBackShown();
  void hashState();
  void publishHashes();
  void compareHash(Seat seat, Tick tick);
  void balance();

  // Packets.
  void poll(std::uint64_t time);
  void receive(Address from, std::span<const std::uint8_t> bytes);
  void receiveFrom(Seat seat, lockstep::Packet type, PacketReader& reader);
  void receiveHello(Seat seat, PacketReader& reader);
  void receiveInputs(Seat seat, PacketReader& reader);
  void receiveHashes(Seat seat, PacketReader& reader);
  void takeControls(Seat seat);
  void receiveWant(Seat seat, PacketReader& reader);
  void receiveBackfill(PacketReader& reader);
  Mismatch mismatch(PacketReader& reader) const;
  void sendHello(Seat seat);
  void sendInputs(Seat seat);
  void sendHashes();
  void sendWants();
  void send(Seat seat, const PacketWriter& writer);
  void header(PacketWriter& writer, lockstep::Packet type) const;
  void watchLinks();
  void finishLeaving();
  void bad() { ++stats.badPackets; }

  // The following locate a difference after a desync.
  bool canLocate() const;
  Tick keepInterval() const;
  void keepState();
  bool keeps(Tick tick) const;
  bool pin(Tick tick);
  Tick keptFrom(Tick tick) const;
  std::uint64_t hashOfPart(std::uint8_t level, std::uint64_t part) const;
  void beginLocating(Seat seat, Tick tick);
  void locate();
  void receiveAsk(Seat seat, PacketReader& reader);
  void receiveAnswer(Seat seat, PacketReader& reader);
  GameValue valueAt(std::uint64_t index) const;
  SeatMask minorityAt(Tick tick);
  void located(const GameValue& theirs);

  // Agreement.
  void agree();
  void propose();
  void askVoters();
  void askVoter(Seat seat);
  void receivePrepare(Seat seat, PacketReader& reader);
  void receivePromise(Seat seat, PacketReader& reader);
  void receiveAccept(Seat seat, PacketReader& reader);
  void receiveAccepted(Seat seat, PacketReader& reader);
  void receiveCommit(Seat seat, PacketReader& reader);
  bool vouched(Seat seat, const lockstep::View& view);
  bool withinVoters(const lockstep::View& view) const;
  bool delivers(Seat seat, std::uint64_t within) const;
  void sendPromise(Seat to, std::uint32_t ballot);
  void sendAccepted(Seat to, std::uint32_t ballot);
  void sendCommit(Seat to, std::uint32_t number);
  bool haveAll(const lockstep::View& view);
  void decide(const lockstep::View& view);
  void drop(Seat seat, Tick end);
  SeatMask suspected() const;

  void seatEnds(Seat seat, Tick end, SessionEvent::Kind kind);
  void finish(EndReason why);
  void tell(const SessionEvent& event);
  /// Seats that have not ended as far as known.
  SeatMask live() const;
  bool remote(Seat seat) const { return seat != settings.localSeat; }
  lockstep::InputStream& own() { return streams[settings.localSeat]; }

  SessionSettings settings;
  Game game;
  Transport transport;
  std::uint64_t now = 0;
  SessionState state = SessionState::connecting;
  EndReason reason = EndReason::none;
  bool paused = false;
  bool leaving = false;
  std::uint64_t endsAt = 0;  ///< When a leaver stops answering; 0: is not leaving.

  std::vector<lockstep::InputStream> streams;
  std::array<Link, kMaxPlayers> links{};
  /// The tick after each seat's last input, as far as known.
  std::array<Tick, kMaxPlayers> ends{};
  /// Tick of each seat after the last input that was looked at for a control.
  std::array<Tick, kMaxPlayers> controlsUpTo{};
  /// Dropped seats whose inputs up to these ticks are still to come from others.
  SeatMask incomplete = 0;
  std::array<Tick, kMaxPlayers> backfillTo{};

  Tick current = 0;
  Tick certain = 0;
  /// The first step that was made with a wrong input; kNever: none.
  Tick wrong = lockstep::kNever;
  bool shown = false;  ///< Steps ahead of `current` were made to be shown.
  std::array<Tick, kSaveSlots> saves;

  std::array<std::vector<std::uint8_t>, lockstep::kKeptCommands> commands;
  std::uint32_t commandsTaken = 0;
  std::uint32_t commandsQueued = 0;

  std::uint32_t viewNumber = 0;
  lockstep::ViewChange change;
  std::array<lockstep::View, lockstep::kKeptViews> views;
  /// View that each seat told was decided as the next.
  std::array<lockstep::View, kMaxPlayers> vouchedFor{};
  std::uint64_t changeSince = 0;  ///< When a change became needed; 0: is not.
  std::uint64_t proposedAt = 0;
  std::uint64_t askedAt = 0;
  std::uint64_t wantedAt = 0;

  lockstep::HashLog ownHashes;                        ///< Hashes of our steps, also uncertain ones.
  std::array<lockstep::HashLog, kMaxPlayers> hashes;  ///< Hashes told by each seat; ours when certain.
  Tick hashesUpTo = 0;
  SeatMask desynced = 0;
  lockstep::Locating locating;

  std::array<SessionEvent, lockstep::kKeptEvents> events;
  std::uint64_t eventsTold = 0;
  std::uint64_t eventsTaken = 0;
  SessionStats stats;
};

}  // namespace samestep
