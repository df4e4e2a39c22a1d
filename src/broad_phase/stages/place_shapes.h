// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "context/step_context.h"

namespace samestep {

/// The stage that places the shapes of what moved anew. MIS: shapeUpdateFunc
template <Scalar S>
class PlaceShapes {
 public:
  void run(StepContext<S>& step);

 private:
  void placeTogether(StepContext<S>& step);

  // Each entry says of a body that moves whether its boxes have to follow.
  std::vector<std::uint8_t> placedAnew_;
};

#define SAMESTEP_EACH_SCALAR extern template class PlaceShapes<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
