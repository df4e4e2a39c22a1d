// SPDX-License-Identifier: MIT
#include "kernels.h"

#ifdef __aarch64__
#include "integers_neon.h"
#include "soft_passes.h"

namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastNeon =
    &kPassesOf<FastLanes<FastNeon>, CoefficientLanes<FastNeon, FastNumbers>>;
const SoftPasses<WideNumbers>* const wideNeon =
    &kPassesOf<WideLanes<WideNeon>, CoefficientLanes<FastNeon, WideNumbers>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const SoftPasses<FastNumbers>* const fastNeon = nullptr;
const SoftPasses<WideNumbers>* const wideNeon = nullptr;

}  // namespace samestep::kernels
#endif
