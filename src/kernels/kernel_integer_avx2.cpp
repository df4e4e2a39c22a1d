// SPDX-License-Identifier: MIT
// Built for AVX2 where the compiler knows it: see kernel_double_avx2.cpp.
#include "kernels.h"

#ifdef __AVX2__
#include "integers4.h"
#include "solve_contacts.h"

namespace samestep::kernels {

const ContactPasses<FastNumbers>* const fastAvx2 = &kPassesOf<FastLanes<FourIntegers>>;
const ContactPasses<WideNumbers>* const wideAvx2 = &kPassesOf<WideLanes<FourIntegers>>;

}  // namespace samestep::kernels
#else
namespace samestep::kernels {

const ContactPasses<FastNumbers>* const fastAvx2 = nullptr;
const ContactPasses<WideNumbers>* const wideAvx2 = nullptr;

}  // namespace samestep::kernels
#endif
