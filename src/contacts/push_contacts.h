// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/arbiter.h>
#include <samestep/collision.h>
#include <samestep/error.h>

#include "contacts/contact_geometry.h"

namespace samestep {

/// Material of a shape, as a contact needs it.
template <Scalar S>
struct Surface {
  S elasticity{};
  S friction{};
  Vector<S> velocity{};

  static Surface of(const Shape<S>& shape) {
    return {shape.elasticity(), shape.friction(), shape.surfaceVelocity()};
  }
};

/// Sets for a step what the surfaces of a pair say.
/// @param normal  the pair's, in the world; does not count where both surfaces move alike
template <Scalar S>
void takeSurfaces(Pair<S>& pair, const Surface<S>& a, const Surface<S>& b, const Vector<S>& normal) {
  pair.elasticity = min(a.elasticity * b.elasticity, S(kMaxMaterial));
  pair.friction = min(a.friction * b.friction, S(kMaxMaterial));
  pair.surfaceVelocity = {};
  if (a.velocity == b.velocity) return;
  const Vector<S> velocity = b.velocity - a.velocity;
  pair.surfaceVelocity = velocity - normal * dot(velocity, normal);
}

/// Forgets what a pair shows of the last step and is no state.
template <Scalar S>
void forgetResults(Pair<S>& pair) {
  for (Contact<S>& contact : pair.contacts) contact.normalTotal = contact.tangentTotal = S(0);
  pair.elasticity = pair.friction = S(0);
  pair.surfaceVelocity = {};
  pair.solvedImpulse = pair.solvedNormal = pair.solvedTurn = {};
  pair.solved = 0;
}

/// Puts normal and points of a collision into the pair; a point that the pair had before keeps its impulses.
/// @param a, b  where the bodies stood
/// @throws BufferOverflow (an internal error) if they are more than a pair holds; the pair is as it was
/// MIS: spacePushContacts
template <Scalar S>
void pushContacts(Pair<S>& pair, const CollisionInfo<S>& info, const Frame<S>& a, const Frame<S>& b) {
  require<Fault::BufferOverflow>(info.count >= 0 && info.count <= kMaxContactsPerPair);
  struct {
    S normalSpeed, tangentSpeed;
    std::uint32_t feature;
  } before[kMaxContactsPerPair];
  for (int i = 0; i < kMaxContactsPerPair; ++i) {
    before[i] = {pair.contacts[i].normalSpeed, pair.contacts[i].tangentSpeed, pair.contacts[i].feature};
  }
  for (int i = 0; i < info.count; ++i) {
    Contact<S>& contact = pair.contacts[i];
    contact.anchorA = a.toLocal(info.points[i].pointA);
    contact.anchorB = b.toLocal(info.points[i].pointB);
    contact.normalSpeed = contact.tangentSpeed = contact.normalTotal = contact.tangentTotal = S(0);
    contact.feature = info.points[i].hash;
    for (int j = 0; j < pair.count; ++j) {
      if (before[j].feature != contact.feature) continue;
      contact.normalSpeed = before[j].normalSpeed;
      contact.tangentSpeed = before[j].tangentSpeed;
    }
  }
  for (int i = info.count; i < kMaxContactsPerPair; ++i) pair.contacts[i] = {};
  pair.localNormal = unrotate(info.normal, a.rotation);
  keepRotations(pair, a.rotation, b.rotation);
  pair.count = static_cast<std::uint8_t>(info.count);
}

}  // namespace samestep
