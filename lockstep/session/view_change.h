// SPDX-License-Identifier: MIT
// How the players agree on who is dropped, and with which last input: one decree of Paxos for each change.
#pragma once

#include <samestep/game.h>

#include <array>
#include <cstdint>

namespace samestep::lockstep {

/// Bit by seat.
using SeatMask = std::uint16_t;
constexpr SeatMask bit(Seat seat) { return static_cast<SeatMask>(1u << seat); }
int count(SeatMask seats);

/// A decision: who votes from then on, who was dropped, and the tick after the last input of each of these;
/// who has joined, and the tick of its first input.
struct View {
  SeatMask voters = 0;
  SeatMask dropped = 0;
  std::array<Tick, kMaxPlayers> end{};
  SeatMask joined = 0;
  Tick start = 0;
  friend bool operator==(const View&, const View&) = default;
};

/// True if some of the voters may decide: more than half, or half of them with the lowest seat. Any two such
/// sets share a voter.
bool quorum(SeatMask some, SeatMask voters);

/// One peer's part in one decision. As acceptor it promises to hear no lower ballot, stops taking inputs of
/// those to be dropped, and tells how many it has; what it accepted once it tells every later proposer.
///
/// A proposer asks all who shall stay: the last input of a dropped player is the latest that any of them has,
/// so nobody who goes on has used a later one. A peer accepts when it has all of these inputs, and a decision
/// waits for all who stay: whoever had them may go afterwards.
///
/// A ballot that lets somebody in names the tick. Whoever promises it makes no step from there on that is
/// certain before it is decided, and all who stay have promised it.
class ViewChange {
 public:
  struct Promise {
    std::uint32_t ballot = 0;
    std::uint32_t acceptedBallot = 0;
    View accepted;
    std::array<Tick, kMaxPlayers> end{};
  };

  /// Begins the decision after the one that made these the voters.
  void begin(SeatMask voters);
  SeatMask voters() const { return voters_; }
  /// Seats whose inputs are not taken until it is decided.
  SeatMask frozen() const { return frozen_; }
  bool underWay() const { return promised_ != 0; }

  /// No tick from here on becomes certain until it is decided.
  Tick barrier() const { return barrier_; }
  /// Whom some ballot was to let in.
  SeatMask joining() const { return joining_; }

  // These are the acceptor's part.
  bool promise(std::uint32_t ballot, SeatMask dropped, SeatMask joined = 0, Tick start = 0);
  bool accept(std::uint32_t ballot, const View& view);
  std::uint32_t promised() const { return promised_; }
  std::uint32_t acceptedBallot() const { return acceptedBallot_; }
  const View& accepted() const { return accepted_; }

  // These are the proposer's part.
  /// Starts a ballot above all heard of.
  void propose(Seat self, SeatMask stay, SeatMask dropped, SeatMask joined = 0, Tick start = 0);
  std::uint32_t ballot() const { return ballot_; }
  SeatMask dropped() const { return dropped_; }
  /// Newcomers whom the ballot asked for, before it had to take up an earlier one.
  SeatMask joined() const { return joined_; }
  Tick start() const { return start_; }
  bool proposing() const { return ballot_ != 0; }
  /// True if all have promised, so that value() is asked to be accepted.
  bool asking() const { return ballot_ != 0 && (stay_ & ~promises_) == 0 && quorum(promises_, voters_); }
  /// Gives up the ballot for a higher one.
  void yield() { ballot_ = 0; }
  const View& value() const { return value_; }
  /// Seats that are still to answer.
  SeatMask missing() const;
  void promisedBy(Seat seat, const Promise& promise);
  /// @return true when it is decided
  bool acceptedBy(Seat seat, std::uint32_t ballot);

 private:
  SeatMask voters_ = 0;
  SeatMask frozen_ = 0;
  SeatMask joining_ = 0;
  Tick barrier_ = 0xffffffffu;
  std::uint32_t promised_ = 0;
  std::uint32_t acceptedBallot_ = 0;
  View accepted_;

  std::uint32_t ballot_ = 0;
  SeatMask stay_ = 0;
  SeatMask dropped_ = 0;
  SeatMask joined_ = 0;
  Tick start_ = 0;
  SeatMask promises_ = 0;
  SeatMask accepts_ = 0;
  std::uint32_t best_ = 0;
  View value_;
};

}  // namespace samestep::lockstep
