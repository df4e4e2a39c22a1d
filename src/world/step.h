// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <samestep/slot_map.h>

#include "broad_phase/stages/find_pairs.h"
#include "broad_phase/stages/place_shapes.h"
#include "contacts/stages/update_contacts.h"
#include "context/step_context.h"
#include "continuous/stages/stop_at_impacts.h"
#include "islands/stages/islands.h"
#include "solver/sequential_impulse/stages/impulse_stages.h"
#include "solver/soft_step/stages/soft_stages.h"

namespace samestep {

/// A step: a list of stages for each solver, see step.cpp, and the stages, each with the memory it keeps for
/// itself.
template <Scalar S>
struct Step {
  /// One line of the list.
  struct Line {
    Stage name;
    void (*run)(Step& stages, StepContext<S>& step);
  };
  static std::span<const Line> lines(SolverKind solver);

  /// @throws ValueOutOfRange, IllegalBody, MissingCallback, UnsoundArithmetic, before anything changes
  static void check(const StepContext<S>& step);
  /// Makes a step of a world that was checked.
  /// @return false where it found too many pairs: then it is as if it had not begun
  /// @throws what callbacks throw
  [[nodiscard]] bool run(StepContext<S>& step);

  PlaceShapes<S> placeShapes;
  FindPairs<S> findPairs;
  Islands<S> islands;
  UpdateContacts<S> updateContacts;
  StopAtImpacts<S> stopAtImpacts;
  ImpulseStages<S> impulses;
  SoftStages<S> soft;

 private:
  /// Within a step queries see the shapes where it placed them.
  class KeepPlaced {
   public:
    explicit KeepPlaced(Derived<S>& derived) : derived_(derived) { derived_.keepPlaced = true; }
    ~KeepPlaced() { derived_.keepPlaced = false; }
    KeepPlaced(const KeepPlaced&) = delete;
    KeepPlaced& operator=(const KeepPlaced&) = delete;

   private:
    Derived<S>& derived_;
  };

  static void placeAndStop(Step& stages, StepContext<S>& step);
  static void tellResults(Step& stages, StepContext<S>& step);
  void meet(StepContext<S>& step);
  [[nodiscard]] bool runLines(StepContext<S>& step);
  void keepBefore(const StepContext<S>& step);
  void takeBack(StepContext<S>& step);

  // The world before a step that may be refused after bodies moved or woke.
  bool keptBodies_ = false, keptPairs_ = false;
  SlotMap<Body<S>, BodyId> bodiesBefore_;
  std::vector<Pair<S>> pairsBefore_, restingBefore_;
};

#define SAMESTEP_EACH_SCALAR extern template struct Step<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
