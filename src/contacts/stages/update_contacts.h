// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "contacts/stages/mend_seams.h"
#include "context/step_context.h"

namespace samestep {

/// The stage that collides pairs: manifolds and surfaces are brought up to date, begin and preSolve asked,
/// separate called, and contacts that stayed apart too long forgotten. In three passes: contacts are found,
/// those at seams mended, and then it is decided who touches and what is solved.
template <Scalar S>
class UpdateContacts {
 public:
  /// @param overlapping  of each pair, whether its boxes overlap
  void run(StepContext<S>& step, const std::vector<std::uint8_t>& overlapping) {
    collidePairs(step, overlapping.data());
    expirePairs(step, overlapping.data());
  }
  /// After the soft step's solver: tells which of the pairs that were solved before they touched have
  /// touched, those that an impulse held and those that overlapped; separate is called for the rest.
  static void settle(StepContext<S>& step);
  /// True if the shapes of a pair whose boxes are near each other touch in this step, or may.
  static bool wouldTouch(const StepContext<S>& step, const Pair<S>& pair);

 private:
  // So many pairs are shared out between two questions whether the step shall go on.
  static constexpr std::uint32_t kPairsTogether = 4 * Budget::kPairsAtOnce;

  /// Decisions for the whole step: whether what is solved is decided with the collision, whether pairs have
  /// what surfaces say from the last step, and whether bodies of several shapes move.
  struct Deciding {
    bool now, surfacesKnown, compounds;
  };

  /// Time of the meeting of shapes that have a contact.
  enum class Meeting { notAsked, now, later, none };

  void collidePairs(StepContext<S>& step, const std::uint8_t* overlapping);
  void collideTogether(StepContext<S>& step, const std::uint8_t* overlapping, bool surfacesKnown);
  bool collideRange(StepContext<S>& step, const std::uint8_t* overlapping, std::uint32_t begin,
                    std::uint32_t end, bool surfacesKnown, CollisionStats& stats);
  /// MIS: spaceCollideShapes
  static std::uint8_t collidePair(const StepContext<S>& step, Pair<S>& pair, const Deciding& deciding,
                                  CollisionStats& stats);
  static Meeting meetsInStep(const StepContext<S>& step, Pair<S>& pair);
  void decidePairs(StepContext<S>& step, bool all);
  static void decide(StepContext<S>& step, Pair<S>& pair);
  static void touch(StepContext<S>& step, Pair<S>& pair, bool solvable);
  static bool hasLeft(const Pair<S>& pair);
  /// Takes over a collision and asks the callbacks: whether the pair shall be solved. MIS: arbiterUpdate
  static bool applyCollision(StepContext<S>& step, Pair<S>& pair);
  /// Calls separate where shapes came apart, and forgets contacts that stayed apart too long.
  /// MIS: spaceArbiterSetFilter
  void expirePairs(StepContext<S>& step, const std::uint8_t* overlapping);
  static bool staysInTouch(const StepContext<S>& step, const Pair<S>& pair);
  static void dropApart(StepContext<S>& step, const std::uint8_t* overlapping, std::size_t first);

  // Each pair has an entry of what was found: bits of ContactFound.
  std::vector<std::uint8_t> found_;
  MendSeams<S> mendSeams_;
  bool someLeft_ = false;
  bool someCompound_ = false;
};

#define SAMESTEP_EACH_SCALAR extern template class UpdateContacts<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
