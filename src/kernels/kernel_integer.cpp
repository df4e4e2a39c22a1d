// SPDX-License-Identifier: MIT
#include "integer_lanes.h"
#include "kernels.h"
#include "solve_contacts.h"

namespace samestep::kernels {

const ContactPasses<FastNumbers> fastBy1 = kPassesOf<FastLanes<OneAtATime>>;

}  // namespace samestep::kernels
