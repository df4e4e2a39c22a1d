// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/scalar.h>

#include "solver/kernels/contact_block.h"

namespace samestep {

/// A damped spring for a substep. Source: E. Catto, "Soft Constraints" (GDC 2011).
/// @param hertz    cycles per second; 0: stiff, without correction
/// @param substep  s
template <Scalar S>
Softness<S> makeSoftness(S hertz, S dampingRatio, S substep);

}  // namespace samestep
