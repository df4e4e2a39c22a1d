// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <samestep/space.h>

namespace samestep {

/// A picture of a world as SVG text, the same on every machine: shapes (static grey, kinematic teal, sensors
/// dashed), contacts as red dots with their normals, velocities as arrows of a tenth of a second, ids of
/// bodies. The frame holds everything that moves.
/// @param caption  one line above the picture
template <Scalar S>
std::string drawSvg(const Space<S>& space, const std::string& caption);

}  // namespace samestep
