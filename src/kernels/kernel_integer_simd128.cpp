// SPDX-License-Identifier: MIT
#include "kernels.h"

#ifdef __wasm_simd128__
#include "integers_simd128.h"
#include "soft_passes.h"
#include "two_lanes.h"

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
