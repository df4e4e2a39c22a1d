// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/arbiter.h>
#include <samestep/collision.h>
#include <samestep/error.h>

namespace samestep {

/// Puts the points of a collision into the pair; a point that the pair had before keeps its impulses.
/// @throws BufferOverflow (an internal error) if they are more than a pair holds; the pair is as it was
/// MIS: spacePushContacts
template <Scalar S>
void pushContacts(Pair<S>& pair, const CollisionInfo<S>& info) {
  require<Fault::BufferOverflow>(info.count >= 0 && info.count <= kMaxContactsPerPair);
  Contact<S> contacts[kMaxContactsPerPair];
  for (int i = 0; i < info.count; ++i) {
    Contact<S>& contact = contacts[i];
    contact.pointA = info.points[i].pointA;
    contact.pointB = info.points[i].pointB;
    contact.feature = info.points[i].hash;
    for (int j = 0; j < pair.count; ++j) {
      if (pair.contacts[j].feature != contact.feature) continue;
      contact.normalSpeed = pair.contacts[j].normalSpeed;
      contact.tangentSpeed = pair.contacts[j].tangentSpeed;
    }
  }
  for (int i = 0; i < kMaxContactsPerPair; ++i) pair.contacts[i] = contacts[i];
  pair.count = static_cast<std::uint8_t>(info.count);
}

}  // namespace samestep
