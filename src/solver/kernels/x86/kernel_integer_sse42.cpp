// SPDX-License-Identifier: MIT
// Built for SSE4.2 where the compiler knows it: see kernel_double_avx2.cpp.
#include "solver/kernels/kernels.h"

#ifdef __SSE4_2__
#include "solver/kernels/generic/coefficient_lanes.h"
#include "solver/kernels/generic/fast_lanes.h"
#include "solver/kernels/generic/soft_passes.h"
#include "solver/kernels/generic/two_lanes.h"
#include "solver/kernels/generic/wide_lanes.h"
#include "solver/kernels/x86/integers_sse42.h"

namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastSse42 =
    &kPassesOf<TwoLanes<FastLanes<FastSse42>>, TwoLanes<CoefficientLanes<FastSse42, FastNumbers>>,
               FastLanes<FastSse42>>;
const SoftPasses<WideNumbers>* const wideSse42 =
    &kPassesOf<TwoLanes<WideLanes<WideSse42>>, TwoLanes<CoefficientLanes<FastSse42, WideNumbers>>,
               WideLanes<WideSse42>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastSse42 = nullptr;
const SoftPasses<WideNumbers>* const wideSse42 = nullptr;

}  // namespace samestep::kernels
#endif
