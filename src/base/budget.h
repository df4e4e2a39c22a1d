// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/error.h>
#include <samestep/interrupt.h>

namespace samestep {

/// Work a Space has done and may do, and the function that is asked whether it shall go on. A unit of work is
/// about 10 ns; what is counted, and when, follows from the world alone.
class Budget {
 public:
  static constexpr std::uint64_t kNoEnd = ~std::uint64_t{0};
  /// Pairs between two questions, about: a few milliseconds, and far more than a question takes.
  static constexpr std::uint32_t kPairsAtOnce = 4096;
  static constexpr std::uint32_t kObjectsAtOnce = 1024;
  // These are the units that parts of a step take, each of its kind.
  static constexpr std::uint64_t kPerObject = 8;
  static constexpr std::uint64_t kPerCandidate = 2;
  static constexpr std::uint64_t kPerPair = 32;
  static constexpr std::uint64_t kPerPairAndPass = 4;
  static constexpr std::uint64_t kPerCall = 8;

  Interrupt interrupt{};
  std::uint64_t most = kNoEnd;

  std::uint64_t spent() const { return spent_; }
  /// True if questions are asked at all.
  bool isWatched() const { return most != kNoEnd || interrupt.wanted != nullptr; }
  /// Notes work done where nobody can be asked.
  void note(std::uint64_t units) { spent_ += units; }
  /// Notes work done; whether the call under way shall end. One thread at a time asks, not always the one
  /// that made the call: where the answer is yes, that one calls endWhereAsked() as soon as it may throw.
  bool spend(std::uint64_t units) {
    spent_ += units;
    ends_ = ends_ || spent_ > most || interrupt.isWanted();
    return ends_;
  }
  /// @throws Interrupted
  void endWhereAsked() {
    if (!ends_) [[likely]]
      return;
    ends_ = false;
    if (spent_ > most) fail<Fault::Interrupted>("More work than this Space may do; see Space::setMaxWork.");
    fail<Fault::Interrupted>();
  }
  /// Both.
  /// @throws Interrupted
  void pay(std::uint64_t units) {
    if (spend(units)) [[unlikely]]
      endWhereAsked();
  }

 private:
  std::uint64_t spent_ = 0;
  bool ends_ = false;
};

}  // namespace samestep
