// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/arbiter.h>

#include "contacts/contact_geometry.h"

namespace samestep {

/// Shapes no farther apart than this, m, touch: more than rounding makes of shapes that just meet.
template <Scalar S>
inline constexpr S kTouching = S(0x1p-20);

/// Separation of the surface points of a contact along the normal, m; negative where the shapes overlap.
/// @param normal  the pair's, in the world
template <Scalar S>
S separationOf(const Contact<S>& contact, const Vector<S>& normal, const Frame<S>& a, const Frame<S>& b) {
  return dot(b.toWorld(contact.anchorB) - a.toWorld(contact.anchorA), normal);
}

/// Separation of the points of a pair that has some, where it is least.
template <Scalar S>
S leastSeparation(const Pair<S>& pair, const Vector<S>& normal, const Frame<S>& a, const Frame<S>& b) {
  const S first = separationOf(pair.contacts[0], normal, a, b);
  return pair.count < 2 ? first : min(first, separationOf(pair.contacts[1], normal, a, b));
}

/// True if the shapes of a pair that has a contact touch where their bodies stand.
template <Scalar S>
bool overlaps(const Pair<S>& pair, const Frame<S>& a, const Frame<S>& b) {
  return leastSeparation(pair, rotate(pair.localNormal, a.rotation), a, b) <= kTouching<S>;
}

/// True if an impulse of the last step acted between the shapes. Points that a pair has not are 0.
template <Scalar S>
bool wasPushed(const Pair<S>& pair) {
  return pair.contacts[0].normalTotal != S(0) || pair.contacts[1].normalTotal != S(0);
}

/// In Pair::solved, of shapes that are known not to touch before the solver.
inline constexpr std::uint8_t kSolvedApart = 2;

/// Notes that the shapes of a pair touch in this step.
template <Scalar S>
void noteTouch(Pair<S>& pair) {
  pair.age = 0;
  if (pair.state == ArbiterState::apart || pair.state == ArbiterState::cached) {
    pair.state = ArbiterState::firstCollision;
  }
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
