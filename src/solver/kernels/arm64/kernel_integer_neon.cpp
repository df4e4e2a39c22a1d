// SPDX-License-Identifier: MIT
#include "solver/kernels/kernels.h"

#ifdef __aarch64__
#include "solver/kernels/arm64/integers_neon.h"
#include "solver/kernels/generic/coefficient_lanes.h"
#include "solver/kernels/generic/fast_lanes.h"
#include "solver/kernels/generic/soft_passes.h"
#include "solver/kernels/generic/two_lanes.h"
#include "solver/kernels/generic/wide_lanes.h"

namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastNeon =
    &kPassesOf<TwoLanes<FastLanes<FastNeon>>, TwoLanes<CoefficientLanes<FastNeon, FastNumbers>>,
               FastLanes<FastNeon>>;
const SoftPasses<WideNumbers>* const wideNeon =
    &kPassesOf<TwoLanes<WideLanes<WideNeon>>, TwoLanes<CoefficientLanes<FastNeon, WideNumbers>>,
               WideLanes<WideNeon>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastNeon = nullptr;
const SoftPasses<WideNumbers>* const wideNeon = nullptr;

}  // namespace samestep::kernels
#endif
