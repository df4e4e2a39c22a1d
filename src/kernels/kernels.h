// SPDX-License-Identifier: MIT
#pragma once

#include "contact_block.h"

/// The kernels that were built, by number type. Each gives the same bits.
namespace samestep::kernels {

/// Two doubles at a time, on every machine.
extern const ContactPasses<double, false> doubleBy2;
/// Four doubles at a time; null where the compiler has no AVX2.
extern const ContactPasses<double, false>* const doubleAvx2;

}  // namespace samestep::kernels
