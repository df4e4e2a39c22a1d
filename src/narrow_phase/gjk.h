// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/collision.h>

#include "narrow_phase/support.h"

namespace samestep {

/// Finds where two shapes, without their radii, are nearest: the point of their Minkowski difference nearest
/// to the origin (Gilbert, Johnson, Keerthi), or what epa finds where the origin lies inside. Every decision
/// is the sign of an exact product; only the answer is rounded.
/// @param start  the id of an earlier answer for this pair, or 0; any value is safe
/// @param axis   without a start: any direction across the line between the shapes; zero is safe
/// MIS: GJK
template <Scalar S>
ClosestPoints<S> gjk(const SupportPair<S>& pair, std::uint32_t start, const Vector<S>& axis,
                     CollisionStats* stats);

}  // namespace samestep
