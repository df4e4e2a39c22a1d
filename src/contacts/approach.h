// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/arbiter.h>

#include "contacts/contact_geometry.h"
#include "contacts/push_contacts.h"
#include "contacts/touching.h"
#include "narrow_phase/sweep.h"

namespace samestep {

/// How far a body will go in a step, as far as forces say, not contacts.
template <Scalar S>
struct StepWay {
  Vector<S> center{};  ///< Of mass, in the world.
  Vector<S> way{};     ///< m
  S turn{};            ///< rad

  /// Of its material at a place.
  Vector<S> at(const Vector<S>& point) const { return way + perp(point - center) * turn; }
};

/// What a contact needs to know of a body and its shape.
template <Scalar S>
struct Approaching {
  const PlacedShape<S>& shape;
  const Frame<S>& frame;
  StepWay<S> way;

  /// A round surface goes where its centre goes, however it turns.
  Vector<S> wayAt(const Vector<S>& point) const {
    return way.at(shape.type == ShapeType::circle ? shape.center() : point);
  }
};

/// Whether a contact between shapes that are apart is one: a contact that would act in this step holds the
/// shapes to a plane, which is right only where they meet on their way. If they do, the contact becomes the
/// one with which they meet.
template <Scalar S>
bool meets(Pair<S>& pair, const Approaching<S>& a, const Approaching<S>& b) {
  const Vector<S> normal = rotate(pair.localNormal, a.frame.rotation);
  S most(0);
  Vector<S> way;
  for (int i = 0; i < pair.count; ++i) {
    const Vector<S> onA = a.frame.toWorld(pair.contacts[i].anchorA);
    const Vector<S> onB = b.frame.toWorld(pair.contacts[i].anchorB);
    const S separation = dot(onB - onA, normal);
    if (separation <= kTouching<S>) return true;
    const Vector<S> relative = a.wayAt(onA) - b.wayAt(onB);
    const S overlap = dot(relative, normal) - separation;
    if (overlap <= most) continue;
    most = overlap;
    way = relative;
  }
  if (most == S(0)) return true;
  CollisionInfo<S> info;
  if (!sweep(a.shape, b.shape, way, info)) return false;
  pushContacts(pair, info, a.frame, b.frame);
  pair.manifold = Manifold::unknown;
  return true;
}

}  // namespace samestep
