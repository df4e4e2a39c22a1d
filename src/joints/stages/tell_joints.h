// SPDX-License-Identifier: MIT
#pragma once

#include "context/step_context.h"

namespace samestep {

/// The stage in which joints that bore too much break, and what happened to joints is listed.
template <Scalar S>
struct TellJoints {
  static void run(StepContext<S>& step);

 private:
  static bool breaks(const Joint<S>& joint);
};

#define SAMESTEP_EACH_SCALAR extern template struct TellJoints<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
