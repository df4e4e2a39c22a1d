// SPDX-License-Identifier: MIT
// Repeats SAMESTEP_EACH_SCALAR, declarations or explicit instantiations that name a scalar S, for each scalar
// that the library is built for. It is included within the namespace, right behind the definition of that
// macro, once for each list, and so has no guard.
#ifdef SAMESTEP_EACH_SCALAR

#ifndef SAMESTEP_FIXED_ONLY
#define S double
SAMESTEP_EACH_SCALAR
#undef S
#endif

#define S Fixed
SAMESTEP_EACH_SCALAR
#undef S

#ifndef SAMESTEP_NO_CHECKED
#define S CheckedFixed
SAMESTEP_EACH_SCALAR
#undef S
#endif

#undef SAMESTEP_EACH_SCALAR
#endif
