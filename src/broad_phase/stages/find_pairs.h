// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "context/step_context.h"

namespace samestep {

/// The stage that finds the pairs of shapes whose boxes are near each other. Candidates of the trees and
/// pairs are sorted alike and walked side by side. Where a pair goes is known before any is moved, so that
/// none moves twice, and none at all in a world at rest. Shapes that filters or bodies keep apart are no
/// pair. MIS: queryReject
template <Scalar S>
class FindPairs {
 public:
  /// Refuses the step where there would be too many: pairs are as before then.
  void run(StepContext<S>& step);
  /// Overlap of the boxes of each pair, after run.
  const std::vector<std::uint8_t>& overlapping() const { return overlapping_; }
  /// Puts pairs, in order, into a list where there are none of them.
  static void mergeInto(std::vector<Pair<S>>& pairs, const std::vector<Pair<S>>& more);
  /// After run: adds pairs that rested until now.
  void addRested(StepContext<S>& step, const std::vector<Pair<S>>& more);
  /// True if so many shapes can be more pairs than are allowed.
  static bool mayFindTooMany(const StepContext<S>& step) {
    const std::uint64_t shapes = step.state.shapes.size();
    return shapes * shapes / 2 > step.wiring.maxPairs;
  }

 private:
  // The shapes that have boxes near each other may be so many times as many as the pairs.
  static constexpr std::uint64_t kCandidatesPerPair = 8;

  struct NewPair {
    std::uint32_t to;
    std::uint32_t a, b;
  };
  // Pairs of the last step that all move by as much; some of them may be gone.
  struct PairRun {
    std::uint32_t from, end;
    std::int64_t shift;
  };

  bool findCandidates(StepContext<S>& step);
  std::uint32_t mergePairs(StepContext<S>& step);
  void movePairs(WorldState<S>& state, std::uint32_t count);

  std::vector<std::uint8_t> overlapping_;
  std::vector<NewPair> newPairs_;
  std::vector<PairRun> pairRuns_;
};

#define SAMESTEP_EACH_SCALAR extern template class FindPairs<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
