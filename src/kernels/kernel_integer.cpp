// SPDX-License-Identifier: MIT
#include "contact_passes.h"
#include "integer_lanes.h"
#include "kernels.h"

namespace samestep::kernels {

const ContactPasses<FastNumbers> fastBy1 =
    kPassesOf<FastLanes<OneAtATime>, CoefficientLanes<OneAtATime, FastNumbers>>;

}  // namespace samestep::kernels
