// SPDX-License-Identifier: MIT
#include "session/view_change.h"

#include <algorithm>
#include <bit>

namespace samestep::lockstep {

int count(SeatMask seats) { return std::popcount(seats); }

bool quorum(SeatMask some, SeatMask voters) {
  const SeatMask lowest = static_cast<SeatMask>(voters & -voters);
  // The lowest seat has half a vote more.
  return 2 * (2 * count(some & voters) + ((some & lowest) != 0 ? 1 : 0)) > 2 * count(voters) + 1;
}

void ViewChange::begin(SeatMask voters) {
  *this = ViewChange();
  voters_ = voters;
}

bool ViewChange::promise(std::uint32_t ballot, SeatMask dropped, SeatMask joined, Tick start) {
  if (ballot < promised_) return false;
  promised_ = ballot;
  // Any of these ballots may still be the one that is decided.
  joining_ |= joined;
  if (joined != 0) barrier_ = std::min(barrier_, start);
  // Frozen is who was in any ballot: the proposer of that one may still be heard.
  frozen_ |= dropped;
  return true;
}

bool ViewChange::accept(std::uint32_t ballot, const View& view) {
  if (ballot < promised_) return false;
  promised_ = ballot;
  frozen_ |= view.dropped;
  acceptedBallot_ = ballot;
  accepted_ = view;
  return true;
}

void ViewChange::propose(Seat self, SeatMask stay, SeatMask dropped, SeatMask joined, Tick start) {
  ballot_ = ((std::max(promised_, ballot_) >> 4) + 1) << 4 | self;
  stay_ = stay;
  dropped_ = dropped;
  joined_ = joined;
  start_ = start;
  promises_ = 0;
  accepts_ = 0;
  best_ = 0;
  value_ = {static_cast<SeatMask>(stay | joined), dropped, {}, joined, joined == 0 ? 0 : start};
}

SeatMask ViewChange::missing() const {
  // A voter that has left need not answer, but may. A value of an earlier ballot may drop others.
  const SeatMask dropped = asking() ? value_.dropped : dropped_;
  return static_cast<SeatMask>((voters_ | stay_) & ~dropped & ~(asking() ? accepts_ : promises_));
}

void ViewChange::promisedBy(Seat seat, const Promise& promise) {
  if (promise.ballot != ballot_ || ballot_ == 0 || (missing() & bit(seat)) == 0 || asking()) {
    return;
  }
  promises_ |= bit(seat);
  if (promise.acceptedBallot > best_) {
    // It may be decided already.
    best_ = promise.acceptedBallot;
    value_ = promise.accepted;
  } else if (best_ == 0) {
    for (Seat i = 0; i < kMaxPlayers; ++i) {
      if ((dropped_ & bit(i)) != 0) value_.end[i] = std::max(value_.end[i], promise.end[i]);
    }
  }
}

bool ViewChange::acceptedBy(Seat seat, std::uint32_t ballot) {
  if (!asking() || ballot != ballot_) return false;
  accepts_ |= bit(seat);
  return quorum(accepts_, voters_) && (stay_ & ~value_.dropped & ~accepts_) == 0;
}

}  // namespace samestep::lockstep
