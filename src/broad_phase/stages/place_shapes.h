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

  // Of each body slot: whether its boxes have to follow.
  std::vector<std::uint8_t> placedAnew_;
};

#ifndef SAMESTEP_FIXED_ONLY
extern template class PlaceShapes<double>;
#endif
extern template class PlaceShapes<Fixed>;
extern template class PlaceShapes<CheckedFixed>;

}  // namespace samestep
