// SPDX-License-Identifier: MIT
// What the parts of a Session share. Its subjects: session.cpp (settings and questions), frames.cpp (steps,
// saves and rollbacks), packets.cpp (what is sent and received), agreement.cpp (who is dropped or let in),
// join.cpp (how a newcomer gets the state), locate.cpp (what differs after a desync).
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
  fetch = 13,  ///< A newcomer asks for a state and the inputs since, or for the hash of a state.
  block = 14,  ///< A piece of a state.
  log = 15,    ///< The inputs of all seats since.
};
inline constexpr std::uint32_t kProtocol = 2;
inline constexpr Tick kNever = 0xffffffffu;
/// Address of a seat that anybody may take.
inline constexpr Address kAnybody = ~Address{0};
/// No input is made for a tick further ahead of the last certain one.
inline constexpr Tick kMaxLead = kMaxWindow + kMaxInputDelay;
static_assert(8 * kMaxLead <= InputStream::kCapacity, "a stream keeps what any peer may still ask for");
/// A newcomer plays from so many ticks after what is certain when it is proposed.
inline constexpr Tick kJoinLead = 80;
/// A seat that has become free stays so for so many ticks at least.
inline constexpr Tick kFreeFor = 128;
/// Number of decisions and of hashes that are remembered.
inline constexpr std::uint32_t kKeptViews = 2 * kMaxPlayers;
inline constexpr std::uint32_t kKeptHashes = 16;
inline constexpr std::uint32_t kKeptEvents = 64;
inline constexpr std::uint32_t kKeptCommands = 32;

// These are flags of a hello.
inline constexpr std::uint8_t kHearsYou = 1;
inline constexpr std::uint8_t kWantsToJoin = 2;

/// @return a view that cannot be, and a bad reader, for bytes that are none
View getView(PacketReader& reader);

/// Link to another peer.
struct Link {
  bool heard = false;    ///< Its hello came and is as ours.
  bool hearsUs = false;  ///< It has said that ours came.
  bool paused = false;
  bool interrupted = false;
  std::uint64_t lastHeard = 0;
  /// Time at which it asked to be let in anew, and so had lost the match; 0: never.
  std::uint64_t restartedAt = 0;
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

/// Ticks from start to before end.
struct Stay {
  Tick start = 0;
  Tick end = 0;
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

/// Somebody who asks for a seat that is free.
struct Newcomer {
  Address address = 0;
  bool heard = false;
  std::uint64_t lastHeard = 0;
};

/// State and inputs that this peer sends a newcomer.
struct Serving {
  Seat seat = kNoSeat;
  Tick tick = kNever;  ///< Tick of the state.
  std::vector<std::uint8_t> state;
  /// The inputs of all seats, tick by tick from that of the state on, up to `logged`.
  std::vector<std::uint8_t> log;
  Tick logged = 0;
  Tick known = kNever;  ///< The steps that the newcomer has made; kNever: it has not the state yet.
  SeatMask heard = 0;   ///< Whom the newcomer has heard of late.
  std::uint64_t lastHeard = 0;
  std::uint64_t lastAnswered = 0;
};

/// State and inputs that this peer, as a newcomer, has got.
struct Joining {
  Seat from = kNoSeat;
  Tick tick = kNever;        ///< Tick of the state.
  std::uint32_t size = 0;    ///< Bytes of the state, as announced.
  std::uint32_t blocks = 0;  ///< That have come, in their order.
  std::vector<std::uint8_t> state;
  bool read = false;    ///< It is in the game, and is
  bool loaded = false;  ///< what most others have.
  std::uint64_t hash = 0;
  std::array<KeptHash, kMaxPlayers> vouched;
  std::vector<std::uint8_t> log;  ///< Bytes of the log of which no whole tick has come yet.
  std::uint32_t logged = 0;       ///< Bytes of the log that have come.
  Tick parsed = 0;                ///< The tick after the last one of the log.
  SeatMask liars = 0;
  std::array<std::uint32_t, kMaxPlayers> numbers{};  ///< Number of the view that each tells.
  std::uint64_t since = 0;                           ///< Time when something new came last.
  std::uint64_t helloAt = 0;
  std::uint64_t fetchedAt = 0;
  std::uint64_t vouchedAt = 0;
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
  /// True if a seat is present in a tick.
  bool plays(Seat seat, Tick tick) const;
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
  void writeHello(PacketWriter& writer, bool heard) const;
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

  // Joining: who is let in.
  void receiveNewcomer(Seat seat, Address from, lockstep::Packet type, PacketReader& reader);
  void receiveFetch(Seat seat, PacketReader& reader);
  void sendTo(Address to, const PacketWriter& writer);
  void refuse(Address to, Mismatch why);
  bool isFree(Seat seat) const;
  bool isSilentYet(Seat seat) const;
  bool mayTake(Seat seat, Address from) const;
  bool canServe() const {
    return game.write != nullptr && game.hash != nullptr && settings.hashInterval != 0;
  }
  bool mayAdmit(Seat seat) const;
  Seat readyNewcomer() const;
  bool beginServing(Seat seat);
  void keepLog();
  void sendBlocks(std::uint32_t from);
  void sendLog(std::uint32_t from);
  void sendVouch(Seat seat, Tick tick);
  void admit(Seat seat, Tick start);
  void openSeat(Seat seat, Tick start);
  void receiveRestart(Seat seat);
  Address addressOf(Seat seat) const;
  bool newestKept(Tick& tick, std::uint32_t& slot) const;

  // Joining: as a newcomer.
  void pollJoining();
  Frame frameJoining();
  void receiveAsNewcomer(Seat seat, lockstep::Packet type, PacketReader& reader);
  void receiveBlock(PacketReader& reader);
  void receiveVouch(Seat seat, PacketReader& reader);
  void receiveLog(PacketReader& reader);
  bool readTick(PacketReader& reader, Tick tick);
  void receiveAdmission(Seat seat, PacketReader& reader);
  void sendFetch(Seat seat, bool vouches);
  void chooseServer();
  void distrust(Seat seat);
  void judgeState();
  SeatMask heardOfLate() const;
  void fetchMore();
  void fetchRest();
  void forgetState();
  void takeLogged(Seat seat, Tick tick, bool present, const lockstep::InputEntry& entry);

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
  bool hasRestarted(Seat seat) const;
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
  /// The tick after the last one whose input of a seat may be taken.
  Tick inputLimit(Seat seat) const {
    return std::min(ends[seat], std::max(certain, starts[seat]) + 2 * lockstep::kMaxLead);
  }
  bool keepsStates() const { return canLocate() || canServe(); }
  lockstep::InputStream& own() { return streams[settings.localSeat]; }

  SessionSettings settings;
  Game game;
  Transport transport;
  std::uint64_t now = 0;
  SessionState state = SessionState::connecting;
  EndReason reason = EndReason::none;
  bool paused = false;
  bool leaving = false;
  bool inCall = false;       ///< A call of frame or poll is under way.
  Seat seats;                ///< Number of seats that there may be.
  std::uint64_t endsAt = 0;  ///< When a leaver stops answering; 0: is not leaving.

  std::vector<lockstep::InputStream> streams;
  std::array<Link, kMaxPlayers> links{};
  /// The ticks of each seat's first input and of the one after the last, as far as known; and of the times
  /// before, newest first.
  std::array<Tick, kMaxPlayers> starts{};
  std::array<Tick, kMaxPlayers> ends{};
  std::array<std::array<lockstep::Stay, 2>, kMaxPlayers> stays{};
  Tick firstTick = 0;  ///< First tick that this peer knows.
  /// The view that let each seat in; 0: it was there from the start.
  std::array<std::uint32_t, kMaxPlayers> admittedIn{};
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
  std::uint64_t goneSince = 0;    ///< When nobody was to be dropped last, as far as a change was needed.
  std::uint64_t proposedAt = 0;
  std::uint64_t askedAt = 0;
  std::uint64_t wantedAt = 0;

  lockstep::HashLog ownHashes;                        ///< Hashes of our steps, also uncertain ones.
  std::array<lockstep::HashLog, kMaxPlayers> hashes;  ///< Hashes told by each seat; ours when certain.
  Tick hashesUpTo = 0;
  SeatMask desynced = 0;
  lockstep::Locating locating;
  lockstep::HashLog keptHashes;  ///< Hashes of certain states in the interval of keepInterval.

  std::array<lockstep::Newcomer, kMaxPlayers> newcomers{};
  lockstep::Serving serving;
  lockstep::Joining joining;

  std::array<SessionEvent, lockstep::kKeptEvents> events;
  std::uint64_t eventsTold = 0;
  std::uint64_t eventsTaken = 0;
  SessionStats stats;
};

}  // namespace samestep
