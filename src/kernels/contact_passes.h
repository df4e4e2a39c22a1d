// SPDX-License-Identifier: MIT
#pragma once

#include "prepare_contacts.h"
#include "solve_contacts.h"

namespace samestep {
namespace {

/// A kernel, by its lanes, and by those that it prepares coefficients by.
template <class L, class P = L>
inline constexpr ContactPasses<typename L::Numbers> kPassesOf = {
    prepareBlock<P, L>, passOver<L, Pass::start>, passOver<L, Pass::solve>, passOver<L, Pass::relax>};

}  // namespace
}  // namespace samestep
