// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/arbiter.h>

#include "contacts/contact_geometry.h"
#include "contacts/push_contacts.h"
#include "contacts/touching.h"
#include "dynamics/body_access.h"
#include "narrow_phase/sweep.h"

namespace samestep {

/// Motion of a body in the step, as far as its velocity and the forces on it say, not contacts.
template <Scalar S>
struct StepWay {
  Vector<S> center{};  ///< Centre of mass, in the world.
  Vector<S> way{};     ///< m
  S turn{};            ///< rad
  S offset{};          ///< No less than the center is from the body's origin, m.

  static StepWay of(const Body<S>& body, const Vector<S>& gravity, S dt) {
    const Vector<S>& center = body.centerOfMass();
    StepWay way{body.worldCenter(), body.velocity() * dt, body.angularVelocity() * dt,
                abs(center.x) + abs(center.y)};
    if (body.isDynamic()) {
      way.way += BodyAccess<S>::acceleration(body, gravity).velocity * (dt * dt * ratio<S>(1, 2));
    }
    return way;
  }

  /// Way of its material at a place.
  Vector<S> at(const Vector<S>& point) const { return way + perp(point - center) * turn; }
  /// Distance that the turn takes a point of a shape, at most.
  /// @param reach  of the shape, in units of 1 / kReachUnits m
  S turnedAtMost(std::int32_t reach) const {
    // A contact's depth is the most a point may lie beside its shape.
    constexpr std::int32_t kBeside = kReachUnits;
    return abs(turn) * (S(reach + kBeside) * ratio<S>(1, kReachUnits) + offset);
  }
};

/// Body and shape as a contact needs them.
template <Scalar S>
struct Approaching {
  const PlacedShape<S>& shape;
  const Frame<S>& frame;
  const StepWay<S>& way;

  /// A round surface goes where its centre goes, however it turns.
  Vector<S> wayAt(const Vector<S>& point) const {
    return way.at(shape.type == ShapeType::circle ? shape.center() : point);
  }
};

/// Tells whether a contact between shapes that are apart is one: a contact that would act in this step holds
/// the shapes to a plane, which is right only where they meet on their way. If they do, the contact becomes
/// the one with which they meet.
/// @param normal  the pair's, in the world
template <Scalar S>
bool meets(Pair<S>& pair, const Approaching<S>& a, const Approaching<S>& b, const Vector<S>& normal) {
  S most(0);
  Vector<S> way;
  for (int i = 0; i < pair.count; ++i) {
    const Vector<S> onA = a.frame.toWorld(pair.contacts[i].anchorA);
    const Vector<S> onB = b.frame.toWorld(pair.contacts[i].anchorB);
    const Vector<S> relative = a.wayAt(onA) - b.wayAt(onB);
    const S overlap = dot(relative - (onB - onA), normal);
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
