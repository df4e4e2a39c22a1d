// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/collision.h>

#include "narrow_phase/support.h"

namespace samestep {

/// Finds how deep two shapes overlap and along which normal, by growing a polygon inside their Minkowski
/// difference until its edge nearest to the origin is one of the difference's own (expanding polytope
/// algorithm).
/// @param v0, v1, v2  vertices of the difference, clockwise, with the origin between them
/// @throws SameVertices (an internal error) where an edge of that polygon has no length
/// MIS: EPA
template <Scalar S>
ClosestPoints<S> epa(const SupportPair<S>& pair, const MinkowskiPoint<S>& v0, const MinkowskiPoint<S>& v1,
                     const MinkowskiPoint<S>& v2, CollisionStats* stats);

}  // namespace samestep
