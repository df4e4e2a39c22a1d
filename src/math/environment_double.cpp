// SPDX-License-Identifier: MIT
#include <samestep/environment.h>

#include "base/require_ieee.h"

namespace samestep {
namespace {

// Volatile, as the compiler would work out the sums by itself, in its own mode.
const volatile double kOne = 1.0;
const volatile double kSmall = 0x1p-60;
const volatile double kHalf = 0.5;
const volatile double kLeastNormal = 0x1p-1022;
const volatile double kLeastSubnormal = 0x1p-1074;
const volatile double kLarge = 0x1p+1000;

}  // namespace

const char* doubleFlaw() {
  const double one = kOne, small = kSmall;
  // Rounding upward spoils the first, downward or toward zero the second.
  const bool toNearest = one + small == one && one - small == one;
  const bool keepsSubnormals = kLeastNormal * kHalf > 0.0 && kLeastSubnormal * kLarge > 0.0;
  if (toNearest && keepsSubnormals) [[likely]]
    return nullptr;
  return toNearest ? "The processor takes subnormal numbers for zero: double would give other results."
                   : "The processor does not round to nearest: double would give other results.";
}

}  // namespace samestep
