// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "context/step_context.h"

namespace samestep {

/// The stage that collides pairs: manifolds and surfaces are brought up to date, begin and preSolve asked,
/// separate called, and contacts that stayed apart too long forgotten.
template <Scalar S>
class UpdateContacts {
 public:
  /// @param overlapping  of each pair, whether its boxes overlap
  void run(StepContext<S>& step, const std::vector<std::uint8_t>& overlapping) {
    collidePairs(step, overlapping.data());
    expirePairs(step, overlapping.data());
  }

 private:
  void collidePairs(StepContext<S>& step, const std::uint8_t* overlapping);
  void collideTogether(StepContext<S>& step, const std::uint8_t* overlapping, bool surfacesKnown);
  bool collideRange(StepContext<S>& step, const std::uint8_t* overlapping, std::uint32_t begin,
                    std::uint32_t end, bool surfacesKnown, CollisionStats& stats);
  /// MIS: spaceCollideShapes
  static void collidePair(StepContext<S>& step, Pair<S>& pair, bool surfacesKnown, CollisionStats& stats);
  /// Takes over a collision and asks the callbacks: whether the pair shall be solved. MIS: arbiterUpdate
  static bool applyCollision(StepContext<S>& step, Pair<S>& pair);
  /// Calls separate where shapes came apart, and forgets contacts that stayed apart too long.
  /// MIS: spaceArbiterSetFilter
  void expirePairs(StepContext<S>& step, const std::uint8_t* overlapping);
  static bool staysInTouch(const StepContext<S>& step, const Pair<S>& pair);
  static void dropApart(StepContext<S>& step, const std::uint8_t* overlapping, std::size_t first);

  // Of each pair: whether it touched before and does not now.
  std::vector<std::uint8_t> left_;
  bool someLeft_ = false;
};

#define SAMESTEP_EACH_SCALAR extern template class UpdateContacts<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
