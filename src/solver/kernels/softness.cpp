// SPDX-License-Identifier: MIT
#include "solver/kernels/softness.h"

#include <samestep/control.h>

#include "base/require_ieee.h"

namespace samestep {

template <Scalar S>
Softness<S> makeSoftness(S hertz, S dampingRatio, S substep) {
  const S omega = S(2) * kPi<S> * hertz;
  const S a1 = S(2) * dampingRatio + substep * omega;
  // A spring may also be too weak for the scalar to tell from none.
  if (hertz == S(0) || a1 == S(0)) return {S(0), S(1), S(0)};
  const S a2 = substep * omega * a1;
  const S a3 = reciprocal(S(1) + a2);
  // More, in substeps of less than 60 us or without damping, would leave the range.
  constexpr S kMost = S(1 << 14);
  return {omega < a1 * kMost ? omega / a1 : kMost, a2 * a3, a3};
}

#define SAMESTEP_EACH_SCALAR template Softness<S> makeSoftness(S, S, S);
#include <samestep/each_scalar.h>

}  // namespace samestep
