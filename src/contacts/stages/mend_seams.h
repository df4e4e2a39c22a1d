// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "contacts/seams.h"
#include "context/step_context.h"

namespace samestep {

/// What was found of a pair in a step, as bits.
struct ContactFound {
  static constexpr std::uint8_t kLeft = 1;   ///< It touched before and does not now.
  static constexpr std::uint8_t kNear = 2;   ///< It has a contact.
  static constexpr std::uint8_t kFresh = 4;  ///< Which is not that of the last step.
  static constexpr std::uint8_t kSeam = 8;   ///< Between what moves and what contacts do not move.
};

/// Judges the contacts of shapes that meet several others which do not move against each other: see
/// judgeSeam.
template <Scalar S>
class MendSeams {
 public:
  /// @param found  of each pair; a contact that goes is no longer found, one that changes is fresh
  void run(StepContext<S>& step, std::vector<std::uint8_t>& found);
  /// The pairs of the last run that may lie at a seam, in order.
  std::span<const std::uint32_t> asked() const { return asked_; }

 private:
  struct SeamPair {
    std::uint32_t moving, pair;
    friend auto operator<=>(const SeamPair&, const SeamPair&) = default;
  };

  void collect(const StepContext<S>& step, const std::vector<std::uint8_t>& found);
  void judge(StepContext<S>& step, std::vector<std::uint8_t>& found, std::uint32_t begin, std::uint32_t end);

  std::vector<std::uint32_t> asked_;
  // By the shape that moves; how many contacts a shape has; and those of one.
  std::vector<SeamPair> seams_;
  std::vector<std::uint32_t> count_;
  std::vector<SeamContact<S>> contacts_;
};

#define SAMESTEP_EACH_SCALAR extern template class MendSeams<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
