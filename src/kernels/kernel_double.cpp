// SPDX-License-Identifier: MIT
#include "require_ieee.h"

#include "double_lanes2.h"
#include "kernels.h"
#include "soft_passes.h"
#include "two_lanes.h"

namespace samestep::kernels {

const SoftPasses<PlainNumbers<double, false>> doubleBy2 =
    kPassesOf<TwoLanes<DoubleLanes2>, DoubleLanes2, DoubleLanes2>;

}  // namespace samestep::kernels
