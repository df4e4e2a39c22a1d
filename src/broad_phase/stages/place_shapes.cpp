// SPDX-License-Identifier: MIT
#include "broad_phase/stages/place_shapes.h"

#include "base/require_ieee.h"

namespace samestep {

template <Scalar S>
void PlaceShapes<S>::run(StepContext<S>& step) {
  Derived<S>& derived = step.derived;
  const auto& bodies = step.state.bodies;
  derived.ensure(step.state);
  derived.findActive(step.state);
  // Callbacks may move what no step does.
  for (const std::uint32_t slot : derived.touched) {
    if (bodies.aliveAt(slot)) derived.placeShapesOf(step.state, slot);
  }
  derived.forgetTouched(step.state);
  if (step.team.helpsWith(derived.active.size(), StepContext<S>::kFewBodies)) {
    placeTogether(step);
    return;
  }
  for (const std::uint32_t slot : derived.active) derived.placeShapesOf(step.state, slot);
}

/// Workers place the shapes; the trees are the stepping thread's.
template <Scalar S>
void PlaceShapes<S>::placeTogether(StepContext<S>& step) {
  Derived<S>& derived = step.derived;
  const std::vector<std::uint32_t>& active = derived.active;
  const auto count = static_cast<std::uint32_t>(active.size());
  placedAnew_.resize(count);
  step.team.during(true, [&] {
    step.team.each(count, StepContext<S>::kBodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) {
        placedAnew_[i] = derived.movePlaced(step.state, active[i]) ? 1 : 0;
      }
    });
  });
  for (std::uint32_t i = 0; i < count; ++i) {
    if (placedAnew_[i] != 0) derived.putBoxesOf(step.state, active[i]);
  }
}

#define SAMESTEP_EACH_SCALAR template class PlaceShapes<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
