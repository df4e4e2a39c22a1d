// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/scalar.h>

namespace samestep {

/// Says in one number how this build computes with S on this machine, as this thread does right now: a hash
/// of kSimulationRevision, of arithmetic, of every function, of how double rounds and keeps small numbers,
/// and of some steps of a tiny world with each solver. The same on every platform; peers compare it before a
/// match, and those that differ would not stay in step. Takes less than a millisecond, and does not throw in
/// a mode that step would refuse.
template <Scalar S>
std::uint64_t fingerprint();

}  // namespace samestep
