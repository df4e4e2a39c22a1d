// SPDX-License-Identifier: MIT
#pragma once

#include "scenes/scene_cursor.h"

namespace samestep {

/// Sets what stands in an object of settings.
template <Scalar S>
void readSettings(Space<S>& space, const Cursor& at);

/// Value of the key "stepsPerSecond".
std::uint32_t readStepsPerSecond(const Cursor& at);

/// Sets what stands in a document of settings, as `samestep tune` writes it.
/// @return its steps per second; 0 where it has none
template <Scalar S>
std::uint32_t readTuned(Space<S>& space, const Cursor& at);

}  // namespace samestep
