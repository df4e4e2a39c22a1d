// SPDX-License-Identifier: MIT
// Built for AVX-512 where the compiler knows it: see kernel_double_avx2.cpp.
#include "solver/kernels/kernels.h"

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512BW__) && defined(__AVX512VL__)
#include "solver/kernels/generic/coefficient_lanes.h"
#include "solver/kernels/generic/fast_lanes.h"
#include "solver/kernels/generic/soft_passes.h"
#include "solver/kernels/generic/wide_lanes.h"
#include "solver/kernels/x86/avx512_intrinsics.h"
#include "solver/kernels/x86/integers_avx2.h"
#include "solver/kernels/x86/integers_avx512.h"
#include "solver/kernels/x86/integers_sse42.h"

namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastAvx512 =
    &kPassesOf<FastLanes<FastAvx512>, CoefficientLanes<FastAvx512, FastNumbers>, FastLanes<FastSse42>>;
// Coefficients of eight pairs fill half a vector.
const SoftPasses<WideNumbers>* const wideAvx512 =
    &kPassesOf<WideLanes<WideAvx512>, CoefficientLanes<FastAvx2, WideNumbers>, WideLanes<WideAvx2>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastAvx512 = nullptr;
const SoftPasses<WideNumbers>* const wideAvx512 = nullptr;

}  // namespace samestep::kernels
#endif
