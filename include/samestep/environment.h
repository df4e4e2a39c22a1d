// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/error.h>
#include <samestep/scalar.h>

namespace samestep {

#ifndef SAMESTEP_FIXED_ONLY
/// Reason why this thread does not compute with double as IEEE-754 does by default, or null: another rounding
/// mode, or subnormal numbers taken for zero. A library may have set either behind the program's back: one
/// linked with -ffast-math does. Costs a few operations.
const char* doubleFlaw();
#endif

/// Refuses to go on where S would not give the same bits as elsewhere. Fixed always does.
/// @throws UnsoundArithmetic
template <Scalar S>
void requireSoundArithmetic() {
#ifndef SAMESTEP_FIXED_ONLY
  if constexpr (ScalarTraits<S>::kKind == ScalarKind::float64) {
    if (const char* flaw = doubleFlaw()) [[unlikely]]
      fail<Fault::UnsoundArithmetic>(flaw);
  }
#endif
}

}  // namespace samestep
