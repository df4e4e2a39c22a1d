// SPDX-License-Identifier: MIT
#include "kernels.h"

#ifdef __aarch64__
#include "contact_passes.h"
#include "integers_neon.h"

namespace samestep::kernels {

const ContactPasses<FastNumbers>* const fastNeon =
    &kPassesOf<FastLanes<FastNeon>, CoefficientLanes<FastNeon, FastNumbers>>;
const ContactPasses<WideNumbers>* const wideNeon =
    &kPassesOf<WideLanes<WideNeon>, CoefficientLanes<FastNeon, WideNumbers>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const ContactPasses<FastNumbers>* const fastNeon = nullptr;
const ContactPasses<WideNumbers>* const wideNeon = nullptr;

}  // namespace samestep::kernels
#endif
