// SPDX-License-Identifier: MIT
#pragma once

#include "contact_block.h"
#include "move_bodies.h"
#include "solve_contacts.h"

namespace samestep {
namespace {

/// @tparam R  with which bodies are moved: lanes that fit the four numbers of one
template <class L, class R = L>
inline constexpr SoftPasses<typename L::Numbers> kPassesOf = {passOver<L, true>, passOver<L, false>,
                                                              driveBodies<R>, moveBodies<R>};

}  // namespace
}  // namespace samestep
