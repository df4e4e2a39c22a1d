// SPDX-License-Identifier: MIT
// Built with -mavx2 where the compiler knows it: nothing here may be called before the processor was asked,
// and nothing may be shared with other sources.
#include "require_ieee.h"

#include "kernels.h"

#ifdef __AVX2__
#include "double_lanes4.h"
#include "soft_passes.h"
#include "two_lanes.h"

namespace samestep::kernels {

const SoftPasses<PlainNumbers<double, false>>* const doubleAvx2 =
    &kPassesOf<TwoLanes<DoubleLanes4>, DoubleLanes4, DoubleLanes4>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const SoftPasses<PlainNumbers<double, false>>* const doubleAvx2 = nullptr;

}  // namespace samestep::kernels
#endif
