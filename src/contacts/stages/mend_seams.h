// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "contacts/seams.h"
#include "context/step_context.h"

namespace samestep {

/// Findings about a pair in a step, as bits.
struct ContactFound {
  static constexpr std::uint8_t kLeft = 1;   ///< It touched before and does not now.
  static constexpr std::uint8_t kNear = 2;   ///< It has a contact.
  static constexpr std::uint8_t kFresh = 4;  ///< The manifold is not that of the last step.
  static constexpr std::uint8_t kSeam = 8;   ///< Between what moves and what contacts do not move.
};

/// Judges the contacts of shapes that meet several others which do not move against each other: those of one
/// body, and those of all bodies that contacts do not move and that move alike without turning, as static
/// ones do. See judgeSeam.
template <Scalar S>
class MendSeams {
 public:
  /// @param found  of each pair; a contact that goes is no longer found, one that changes is fresh
  void run(StepContext<S>& step, std::vector<std::uint8_t>& found);
  /// The pairs of the last run that may lie at a seam, in order.
  std::span<const std::uint32_t> asked() const { return asked_; }

 private:
  /// A pair as one of its shapes sees it.
  struct Side {
    std::uint32_t shape;
    std::uint32_t group;  ///< Group of the other shape: its body, or kAlike.
    std::uint32_t pair;
    Vector<S> velocity{};  ///< Velocity of those of kAlike, m/s.

    bool isWith(const Side& other) const {
      return shape == other.shape && group == other.group && velocity == other.velocity;
    }
    bool operator<(const Side& other) const;
  };
  /// Change of a contact that does not stay.
  struct Change {
    std::uint32_t pair;
    bool byA;  ///< True if A is the shape that sees the others.
    SeamVerdict verdict;
    CollisionInfo<S> info;
  };
  static constexpr std::uint32_t kAlike = 0xffffffffu;
  // Among thousands that lie over each other each takes a while.
  static constexpr std::uint32_t kJudgedAtOnce = 16;

  void collect(const StepContext<S>& step, const std::vector<std::uint8_t>& found);
  void addSide(const StepContext<S>& step, std::uint32_t pair, bool ofA);
  void judge(const StepContext<S>& step, const std::vector<std::uint8_t>& found, std::span<const Side> sides);
  void apply(StepContext<S>& step, std::vector<std::uint8_t>& found);
  void applyOne(StepContext<S>& step, std::uint8_t& found, const Change& change) const;

  std::vector<std::uint32_t> asked_;
  // These are sorted by shape and group: the sides, the contacts of one of both, and what changes.
  std::vector<Side> sides_;
  SeamContacts<S> contacts_;
  std::vector<Change> changes_;
  std::uint32_t judged_ = 0;
};

#define SAMESTEP_EACH_SCALAR extern template class MendSeams<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
