// SPDX-License-Identifier: MIT
#pragma once

#include "context/derived.h"
#include "context/step_events.h"
#include "context/wiring.h"
#include "parallel/crew.h"
#include "world/post_step.h"
#include "world/step.h"

namespace samestep {

/// Parts of a Space beside its state.
template <Scalar S>
struct SpaceParts {
  Derived<S> derived;
  SpaceWiring<S> wiring;
  Crew team;
  StepEvents<S> events;
  Step<S> step;
  PostStepQueue<S> postStep;
  // Queries note the keys found here.
  std::vector<std::uint32_t> found;
  std::vector<std::uint32_t> foundInOne;
};

}  // namespace samestep
