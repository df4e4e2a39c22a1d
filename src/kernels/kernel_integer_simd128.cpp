// SPDX-License-Identifier: MIT
#include "kernels.h"

#ifdef __wasm_simd128__
#include "integers_simd128.h"
#include "soft_passes.h"

namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastSimd128 =
    &kPassesOf<FastLanes<FastSimd128>, CoefficientLanes<FastSimd128, FastNumbers>>;
const SoftPasses<WideNumbers>* const wideSimd128 =
    &kPassesOf<WideLanes<WideSimd128>, CoefficientLanes<FastSimd128, WideNumbers>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastSimd128 = nullptr;
const SoftPasses<WideNumbers>* const wideSimd128 = nullptr;

}  // namespace samestep::kernels
#endif
