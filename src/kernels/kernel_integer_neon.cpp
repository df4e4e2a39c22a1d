// SPDX-License-Identifier: MIT
#include "kernels.h"

#ifdef __aarch64__
#include "integers_neon.h"
#include "solve_contacts.h"

namespace samestep::kernels {

const ContactPasses<FastNumbers>* const fastNeon = &kPassesOf<FastLanes<FastNeon>>;
const ContactPasses<WideNumbers>* const wideNeon = &kPassesOf<WideLanes<WideNeon>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const ContactPasses<FastNumbers>* const fastNeon = nullptr;
const ContactPasses<WideNumbers>* const wideNeon = nullptr;

}  // namespace samestep::kernels
#endif
