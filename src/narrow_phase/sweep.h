// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/collision.h>

namespace samestep {

/// Finds how two shapes that are apart first touch where one of them goes straight on, without turning: the
/// points as collide finds them there, brought back to where the shapes stand now.
/// @param way   of A against B, m
/// @param info  filled where they touch; its id is kept
/// @return whether they touch on that way: come within 2^-15 m of each other
template <Scalar S>
bool sweep(const PlacedShape<S>& a, const PlacedShape<S>& b, const Vector<S>& way, CollisionInfo<S>& info);

}  // namespace samestep
