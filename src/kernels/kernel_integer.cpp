// SPDX-License-Identifier: MIT
#include "integer_lanes.h"
#include "kernels.h"
#include "soft_passes.h"

namespace samestep::kernels {

const SoftPasses<FastNumbers> fastBy1 =
    kPassesOf<FastLanes<OneAtATime>, CoefficientLanes<OneAtATime, FastNumbers>>;

}  // namespace samestep::kernels
