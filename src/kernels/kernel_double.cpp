// SPDX-License-Identifier: MIT
#include "require_ieee.h"

#include "double_lanes2.h"
#include "kernels.h"
#include "solve_contacts.h"

namespace samestep::kernels {

const ContactPasses<double, false> doubleBy2 = {passOver<DoubleLanes2, true, ContactBlock<double, false>>,
                                                passOver<DoubleLanes2, false, ContactBlock<double, false>>};

}  // namespace samestep::kernels
