// SPDX-License-Identifier: MIT
// Built for AVX2 where the compiler knows it: see kernel_double_avx2.cpp.
#include "kernels.h"

#ifdef __AVX2__
#include "integers_avx2.h"
#include "solve_contacts.h"

namespace samestep::kernels {

const ContactPasses<FastNumbers>* const fastAvx2 = &kPassesOf<FastLanes<FastAvx2>>;
const ContactPasses<WideNumbers>* const wideAvx2 = &kPassesOf<WideLanes<WideAvx2>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const ContactPasses<FastNumbers>* const fastAvx2 = nullptr;
const ContactPasses<WideNumbers>* const wideAvx2 = nullptr;

}  // namespace samestep::kernels
#endif
