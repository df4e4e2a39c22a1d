// SPDX-License-Identifier: MIT
// Included by every source that computes with double: refuses builds that would change its results. Not for
// public headers, as what a client computes for itself is the client's affair.
#pragma once

#include <cfloat>

#ifndef SAMESTEP_FIXED_ONLY
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
#error \
    "Samestep computes with double as IEEE-754 says: build without -ffast-math, or with SAMESTEP_SCALARS=fixed"
#endif
static_assert(FLT_EVAL_METHOD == 0,
              "double arithmetic must round to double: on 32-bit x86 use -msse2 -mfpmath=sse");
#endif
