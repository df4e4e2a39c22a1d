// SPDX-License-Identifier: MIT
#include "require_ieee.h"

#include "contact_passes.h"
#include "double_lanes2.h"
#include "kernels.h"

namespace samestep::kernels {

const ContactPasses<PlainNumbers<double, false>> doubleBy2 = kPassesOf<DoubleLanes2>;

}  // namespace samestep::kernels
