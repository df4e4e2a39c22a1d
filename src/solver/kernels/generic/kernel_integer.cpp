// SPDX-License-Identifier: MIT
#include "solver/kernels/generic/coefficient_lanes.h"
#include "solver/kernels/generic/fast_lanes.h"
#include "solver/kernels/generic/integer_vectors.h"
#include "solver/kernels/generic/soft_passes.h"
#include "solver/kernels/kernels.h"

namespace samestep::kernels {

const SoftPasses<FastNumbers> fastBy1 =
    kPassesOf<FastLanes<OneAtATime>, CoefficientLanes<OneAtATime, FastNumbers>>;

}  // namespace samestep::kernels
