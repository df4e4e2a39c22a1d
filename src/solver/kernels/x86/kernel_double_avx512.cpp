// SPDX-License-Identifier: MIT
// Built for AVX-512 where the compiler knows it: see kernel_double_avx2.cpp.
#include "base/require_ieee.h"

#include "solver/kernels/kernels.h"

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512BW__) && defined(__AVX512VL__)
#include "solver/kernels/generic/soft_passes.h"
#include "solver/kernels/x86/double_lanes4.h"
#include "solver/kernels/x86/double_lanes8.h"

namespace samestep::kernels {

const SoftPasses<PlainNumbers<double, false>>* const doubleAvx512 =
    &kPassesOf<DoubleLanes8, DoubleLanes8, DoubleLanes4>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const SoftPasses<PlainNumbers<double, false>>* const doubleAvx512 = nullptr;

}  // namespace samestep::kernels
#endif
