// SPDX-License-Identifier: MIT
// Built for AVX2 where the compiler knows it: see kernel_double_avx2.cpp.
#include "solver/kernels/kernels.h"

#ifdef __AVX2__
#include "solver/kernels/generic/coefficient_lanes.h"
#include "solver/kernels/generic/fast_lanes.h"
#include "solver/kernels/generic/soft_passes.h"
#include "solver/kernels/generic/two_lanes.h"
#include "solver/kernels/generic/wide_lanes.h"
#include "solver/kernels/x86/integers_avx2.h"
#include "solver/kernels/x86/integers_sse42.h"

namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastAvx2 =
    &kPassesOf<TwoLanes<FastLanes<FastAvx2>>, TwoLanes<CoefficientLanes<FastAvx2, FastNumbers>>,
               FastLanes<FastSse42>>;
const SoftPasses<WideNumbers>* const wideAvx2 =
    &kPassesOf<TwoLanes<WideLanes<WideAvx2>>, CoefficientLanes<FastAvx2, WideNumbers>, WideLanes<WideAvx2>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastAvx2 = nullptr;
const SoftPasses<WideNumbers>* const wideAvx2 = nullptr;

}  // namespace samestep::kernels
#endif
