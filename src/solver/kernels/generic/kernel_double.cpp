// SPDX-License-Identifier: MIT
#include "base/require_ieee.h"

#include "solver/kernels/generic/double_lanes2.h"
#include "solver/kernels/generic/soft_passes.h"
#include "solver/kernels/generic/two_lanes.h"
#include "solver/kernels/kernels.h"

namespace samestep::kernels {

const SoftPasses<PlainNumbers<double, false>> doubleBy2 =
    kPassesOf<TwoLanes<DoubleLanes2>, DoubleLanes2, DoubleLanes2>;

}  // namespace samestep::kernels
