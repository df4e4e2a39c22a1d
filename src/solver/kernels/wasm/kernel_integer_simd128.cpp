// SPDX-License-Identifier: MIT
#include "solver/kernels/kernels.h"

#ifdef __wasm_simd128__
#include "solver/kernels/generic/coefficient_lanes.h"
#include "solver/kernels/generic/fast_lanes.h"
#include "solver/kernels/generic/soft_passes.h"
#include "solver/kernels/generic/two_lanes.h"
#include "solver/kernels/generic/wide_lanes.h"
#include "solver/kernels/wasm/integers_simd128.h"

namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastSimd128 =
    &kPassesOf<TwoLanes<FastLanes<FastSimd128>>, TwoLanes<CoefficientLanes<FastSimd128, FastNumbers>>,
               FastLanes<FastSimd128>>;
const SoftPasses<WideNumbers>* const wideSimd128 =
    &kPassesOf<TwoLanes<WideLanes<WideSimd128>>, TwoLanes<CoefficientLanes<FastSimd128, WideNumbers>>,
               WideLanes<WideSimd128>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastSimd128 = nullptr;
const SoftPasses<WideNumbers>* const wideSimd128 = nullptr;

}  // namespace samestep::kernels
#endif
