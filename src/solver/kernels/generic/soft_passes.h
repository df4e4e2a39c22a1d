// SPDX-License-Identifier: MIT
#pragma once

#include "solver/kernels/contact_block.h"
#include "solver/kernels/generic/move_bodies.h"
#include "solver/kernels/generic/prepare_contacts.h"
#include "solver/kernels/generic/solve_contacts.h"

namespace samestep {
namespace {

/// @tparam L  with which contacts are solved
/// @tparam P  with which their coefficients are prepared
/// @tparam R  with which bodies are moved: lanes that fit the four numbers of one
template <class L, class P = L, class R = L>
inline constexpr SoftPasses<typename L::Numbers> kPassesOf = {prepareBlock<P, L>,
                                                              passOver<L, Pass::start>,
                                                              passOver<L, Pass::solve>,
                                                              passOver<L, Pass::relax>,
                                                              pushOver<L>,
                                                              driveBodies<R>,
                                                              moveBodies<R>};

}  // namespace
}  // namespace samestep
