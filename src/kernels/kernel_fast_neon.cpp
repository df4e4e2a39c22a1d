// SPDX-License-Identifier: MIT
#include "kernels.h"

#ifdef __aarch64__
#include "fast_lanes_neon.h"
#include "solve_contacts.h"

namespace samestep::kernels {

const ContactPasses<FastNumbers>* const fastNeon = &kPassesOf<FastLanes<TwoIntegersOfNeon>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const ContactPasses<FastNumbers>* const fastNeon = nullptr;

}  // namespace samestep::kernels
#endif
