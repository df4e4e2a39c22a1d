// SPDX-License-Identifier: MIT
#include "broad_phase/stages/place_shapes.h"

#include "base/require_ieee.h"

namespace samestep {

template <Scalar S>
void PlaceShapes<S>::run(StepContext<S>& step) {
  Derived<S>& derived = step.derived;
  const auto& bodies = step.state.bodies;
  derived.ensure(step.state);
  derived.forgetTouched();
  if (step.team.helpsWith(bodies.slots(), StepContext<S>::kFewBodies)) {
    placeTogether(step);
    return;
  }
  for (std::uint32_t i = 0; i < bodies.slots(); ++i) {
    if (bodies.aliveAt(i)) derived.placeShapesOf(step.state, i);
  }
}

/// Workers place the shapes; the trees are the stepping thread's.
template <Scalar S>
void PlaceShapes<S>::placeTogether(StepContext<S>& step) {
  Derived<S>& derived = step.derived;
  const auto& bodies = step.state.bodies;
  const std::uint32_t slots = bodies.slots();
  placedAnew_.resize(slots);
  step.team.during(true, [&] {
    step.team.each(slots, StepContext<S>::kBodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) {
        placedAnew_[i] = bodies.aliveAt(i) && derived.movePlaced(step.state, i) ? 1 : 0;
      }
    });
  });
  for (std::uint32_t i = 0; i < slots; ++i) {
    if (placedAnew_[i] != 0) derived.putBoxesOf(step.state, i);
  }
}

#define SAMESTEP_EACH_SCALAR template class PlaceShapes<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
