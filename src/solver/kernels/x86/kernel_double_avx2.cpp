// SPDX-License-Identifier: MIT
// Built with -mavx2 where the compiler knows it: nothing here may be called before the processor was asked,
// and nothing may be shared with other sources.
#include "base/require_ieee.h"

#include "solver/kernels/kernels.h"

#ifdef __AVX2__
#include "solver/kernels/generic/soft_passes.h"
#include "solver/kernels/generic/two_lanes.h"
#include "solver/kernels/x86/double_lanes4.h"

namespace samestep::kernels {

const SoftPasses<PlainNumbers<double, false>>* const doubleAvx2 =
    &kPassesOf<TwoLanes<DoubleLanes4>, DoubleLanes4, DoubleLanes4>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const SoftPasses<PlainNumbers<double, false>>* const doubleAvx2 = nullptr;

}  // namespace samestep::kernels
#endif
