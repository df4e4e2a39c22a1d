// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/collision.h>

namespace samestep {

/// collide for shapes in the order of their types.
/// @throws CollisionError (an internal error) in any other order
template <Scalar S>
void collideSorted(const PlacedShape<S>& a, const PlacedShape<S>& b, CollisionInfo<S>& info,
                   CollisionStats* stats, S margin = S(0));

}  // namespace samestep
