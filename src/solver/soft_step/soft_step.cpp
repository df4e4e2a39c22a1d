// SPDX-License-Identifier: MIT
#include "solver/soft_step/soft_step.h"

#include "base/require_ieee.h"

namespace samestep {

template <Scalar S>
void SoftStep<S>::clear() {
  starts.assign(1, {});
  starts[0].radiusBits = kAnyRadiusBits;
  free.clear();
  groups.clear();
}

// The whole step is done at once without damping: its substeps would only add rounding. What a substep
// changes of the velocity a body has on its way through it by half.
template <Scalar S>
void SoftStep<S>::addFree(const SoftStart<S>& start, const S (&pull)[3], S dt) {
  constexpr S kLimits[3] = {kMaxSpeed<S>, kMaxSpeed<S>, kMaxAngularSpeed<S>};
  constexpr S kHalf = ratio<S>(1, 2);
  SoftMotion<S>& motion = free.emplace_back();
  for (int k = 0; k < 3; ++k) {
    S velocity = start.velocity[k];
    const S whole = mulAdd(pull[k], dt, velocity);
    if (start.kept == S(1) && abs(whole) <= kLimits[k]) {
      motion.velocity[k] = whole;
      motion.moved[k] = (velocity + whole) * kHalf * dt;
      continue;
    }
    S moved = S(0);
    for (int i = 0; i < settings.substeps; ++i) {
      const S next = mulAdd(velocity, start.kept, start.push[k]);
      velocity = clamp(next, -kLimits[k], kLimits[k]);
      if (velocity != next) [[unlikely]]
        motion.held =
            static_cast<std::uint8_t>(motion.held | (k == 2 ? Body<S>::kHeldSpin : Body<S>::kHeldSpeed));
      moved = mulAdd(velocity - start.push[k] * kHalf, settings.substep, moved);
    }
    motion.velocity[k] = velocity;
    motion.moved[k] = moved;
  }
}

#define SAMESTEP_EACH_SCALAR template struct SoftStep<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
