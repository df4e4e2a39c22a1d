// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "broad_phase/stages/find_pairs.h"
#include "context/step_context.h"

namespace samestep {

/// The stages that put bodies to sleep and wake them. An island is what contacts that were solved hold
/// together, of dynamic bodies; it falls asleep, and wakes, as a whole. The pairs of what rests wait in
/// WorldState::restingPairs, where no step looks at them.
template <Scalar S>
class Islands {
 public:
  /// True if anything is to be woken, or forces taken from static bodies, as a step begins.
  static bool anyRoused(const StepContext<S>& step);
  /// Wakes what was changed since the last step, what rested on it, and what lies where a static body now is.
  void wakeRoused(StepContext<S>& step);
  /// Wakes what something awake touches in this step.
  void wakeTouched(StepContext<S>& step, FindPairs<S>& findPairs);
  /// Counts how long bodies have been at rest, and puts the islands to sleep that have been so for long
  /// enough.
  void fallAsleep(StepContext<S>& step);

 private:
  // These are bits of a body in an island.
  static constexpr std::uint8_t kStaysAwake = 1, kPulled = 2, kHeld = 4;

  static bool isPulled(const StepContext<S>& step, std::uint32_t slot);
  static bool isRoused(const StepContext<S>& step, std::uint32_t slot);
  static bool isIdle(const StepContext<S>& step, std::uint32_t slot);
  void noteRoused(StepContext<S>& step);
  void noteIsland(const StepContext<S>& step, std::uint32_t slot);
  void noteOnRoused(StepContext<S>& step);
  void wakeNoted(StepContext<S>& step);
  void takeAwakePairs(StepContext<S>& step);
  bool noteTouched(StepContext<S>& step, const FindPairs<S>& findPairs);
  bool countRest(StepContext<S>& step);
  void settleStill(StepContext<S>& step);
  template <class Visit>
  void eachEdge(const StepContext<S>& step, Visit&& visit);
  void findIslands(StepContext<S>& step);
  void restPairs(StepContext<S>& step);
  std::uint32_t rootOf(std::uint32_t slot);

  std::vector<std::uint32_t> roused_;
  // Static bodies that were changed by hand: they rest again at the end of the step.
  std::vector<std::uint32_t> stirred_;
  std::vector<std::uint32_t> woken_;
  std::vector<std::uint32_t> slept_;
  // Islands to wake, by Body::island.
  std::vector<std::uint8_t> wanted_;
  bool anyWanted_ = false;
  // Each body slot has an entry: how it was roused; its island so far; what is known of it.
  std::vector<std::uint8_t> roles_;
  std::vector<std::uint32_t> parents_;
  std::vector<std::uint8_t> known_;
  std::vector<Pair<S>> moved_;
};

#define SAMESTEP_EACH_SCALAR extern template class Islands<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
