// SPDX-License-Identifier: MIT
#pragma once

#include "solver/kernels/contact_block.h"

/// The kernels that were built, by what they compute with. All of one kind give the same bits. A pointer is
/// null where the compiler does not know the processor's instructions; only a processor that has them may be
/// sent there.
namespace samestep::kernels {

/// Two doubles at a time, in vectors that every compiler translates.
extern const SoftPasses<PlainNumbers<double, false>> doubleBy2;
extern const SoftPasses<PlainNumbers<double, false>>* const doubleAvx2;
extern const SoftPasses<PlainNumbers<double, false>>* const doubleAvx512;

/// One integer at a time; what the wide ones do that way depends on the scalar, see scalar_lanes.h.
extern const SoftPasses<FastNumbers> fastBy1;
extern const SoftPasses<FastNumbers>* const fastSse42;
extern const SoftPasses<FastNumbers>* const fastAvx2;
extern const SoftPasses<FastNumbers>* const fastAvx512;
extern const SoftPasses<WideNumbers>* const wideSse42;
extern const SoftPasses<WideNumbers>* const wideAvx2;
extern const SoftPasses<WideNumbers>* const wideAvx512;
/// Every processor of 64-bit ARM can run these.
extern const SoftPasses<FastNumbers>* const fastNeon;
extern const SoftPasses<WideNumbers>* const wideNeon;
/// A WebAssembly build has these or has them not; an engine without them refuses the whole module.
extern const SoftPasses<FastNumbers>* const fastSimd128;
extern const SoftPasses<WideNumbers>* const wideSimd128;

}  // namespace samestep::kernels
