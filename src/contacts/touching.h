// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/arbiter.h>

#include "contacts/contact_geometry.h"

namespace samestep {

/// Shapes no farther apart than this, m, touch: more than rounding makes of shapes that just meet.
template <Scalar S>
inline constexpr S kTouching = S(0x1p-20);

/// Between the surface points of a contact along the normal, m; negative where the shapes overlap.
/// @param normal  the pair's, in the world
template <Scalar S>
S separationOf(const Contact<S>& contact, const Vector<S>& normal, const Frame<S>& a, const Frame<S>& b) {
  return dot(b.toWorld(contact.anchorB) - a.toWorld(contact.anchorA), normal);
}

/// Whether the shapes of a pair touch at one of its points where their bodies stand.
template <Scalar S>
bool overlaps(const Pair<S>& pair, const Frame<S>& a, const Frame<S>& b) {
  const Vector<S> normal = rotate(pair.localNormal, a.rotation);
  for (int i = 0; i < pair.count; ++i) {
    if (separationOf(pair.contacts[i], normal, a, b) <= kTouching<S>) return true;
  }
  return false;
}

/// Whether an impulse of the last step acted between the shapes.
template <Scalar S>
bool wasPushed(const Pair<S>& pair) {
  for (int i = 0; i < pair.count; ++i) {
    if (pair.contacts[i].normalTotal != S(0)) return true;
  }
  return false;
}

/// Makes a pair that has been apart long enough one that has not touched yet; its points stay.
template <Scalar S>
void forgetTouch(Pair<S>& pair) {
  pair.state = ArbiterState::apart;
  pair.age = 0;
  for (Contact<S>& contact : pair.contacts) {
    contact.normalSpeed = contact.tangentSpeed = contact.normalTotal = contact.tangentTotal = S(0);
  }
}

}  // namespace samestep
