// SPDX-License-Identifier: MIT
#include <samestep/arbiter.h>

#include <samestep/error.h>

#include "base/require_ieee.h"
#include "contacts/contact_geometry.h"
#include "contacts/contact_row.h"
#include "geometry/shape_geometry.h"

namespace samestep {

template <Scalar S>
void Arbiter<S>::setRestitution(S restitution) {
  requireMaterial<Fault::NegativeElasticity>(restitution, "Arbiter::setRestitution: restitution is ");
  pair_.elasticity = restitution;
}

template <Scalar S>
void Arbiter<S>::setFriction(S friction) {
  requireMaterial<Fault::NegativeFriction>(friction, "Arbiter::setFriction: friction is ");
  pair_.friction = friction;
}

template <Scalar S>
void Arbiter<S>::setSurfaceVelocity(const Vector<S>& velocity) {
  require<Fault::ValueOutOfRange>(within(velocity, S(kMaxMaterial)),
                                  "Arbiter::setSurfaceVelocity: velocity is ", velocity,
                                  " m/s, allowed are up to ", kMaxMaterial, " m/s along each axis");
  pair_.surfaceVelocity = swapped_ ? -velocity : velocity;
}

template <Scalar S>
Vector<S> Arbiter<S>::pairNormal() const {
  return isSolved() ? pair_.solvedNormal : worldNormal(pair_, *bodies_[0]);
}

template <Scalar S>
Vector<S> Arbiter<S>::normal() const {
  return swapped_ ? -pairNormal() : pairNormal();
}

template <Scalar S>
Vector<S> Arbiter<S>::surfacePoint(int body, int index) const {
  require<Fault::ContactIndexOutOfBounds>(index >= 0 && index < count(), "Arbiter: contact ", index,
                                          " is asked for, of contacts there are ", count());
  const Contact<S>& contact = pair_.contacts[index];
  const Vector<S>& anchor = body == 0 ? contact.anchorA : contact.anchorB;
  const S radius = shapes_[body]->radius();
  if (!isSolved() || radius == S(0)) return bodies_[body]->toWorld(anchor);
  // A round shape turns below its point.
  const Vector<S> before = body == 0 ? pair_.localNormal : unrotate(pair_.solvedNormal, pair_.solvedTurn);
  const S outward = body == 0 ? radius : -radius;
  return bodies_[body]->toWorld(anchor - before * outward) + pair_.solvedNormal * outward;
}

template <Scalar S>
Vector<S> Arbiter<S>::pointA(int index) const {
  return surfacePoint(swapped_ ? 1 : 0, index);
}

template <Scalar S>
Vector<S> Arbiter<S>::pointB(int index) const {
  return surfacePoint(swapped_ ? 0 : 1, index);
}

template <Scalar S>
S Arbiter<S>::depth(int index) const {
  return dot(pointB(index) - pointA(index), normal());
}

template <Scalar S>
ContactPointSet<S> Arbiter<S>::contactPointSet() const {
  ContactPointSet<S> set;
  set.count = count();
  set.normal = normal();
  for (int i = 0; i < set.count; ++i) set.points[i] = {pointA(i), pointB(i), depth(i)};
  return set;
}

namespace {

/// Twice as far as any point of a shape of a body that moves can be: what a contact turns stays in range.
template <Scalar S>
bool isWithinReach(const Body<S>& body, const Vector<S>& point) {
  return body.type() == BodyType::staticBody || within(point - body.worldCenter(), S(4 * kMaxDynamicExtent));
}

}  // namespace

template <Scalar S>
void Arbiter<S>::setContactPointSet(const ContactPointSet<S>& set) {
  require<Fault::ImmutableNumContacts>(set.count == count(), "Arbiter::setContactPointSet: points are ",
                                       set.count, ", allowed are as many as there are contacts, ", count());
  const S slack = ratio<S>(1, 1024);
  const S size = within(set.normal, S(2)) ? length(set.normal) : S(0);
  require<Fault::ValueOutOfRange>(size >= S(1) - slack && size <= S(1) + slack,
                                  "Arbiter::setContactPointSet: the normal is ", set.normal,
                                  ", of length 1 is allowed");
  const Body<S>& first = swapped_ ? *bodies_[1] : *bodies_[0];
  const Body<S>& second = swapped_ ? *bodies_[0] : *bodies_[1];
  for (int i = 0; i < set.count; ++i) {
    require<Fault::ValueOutOfRange>(
        within(set.points[i].pointA, kMaxWorldExtent<S>) && within(set.points[i].pointB, kMaxWorldExtent<S>),
        "Arbiter::setContactPointSet: the places of point ", i, " are ", set.points[i].pointA, " and ",
        set.points[i].pointB, " m, allowed are up to ", kMaxWorldExtent<S>, " m along each axis");
    require<Fault::ValueOutOfRange>(
        isWithinReach(first, set.points[i].pointA) && isWithinReach(second, set.points[i].pointB),
        "Arbiter::setContactPointSet: the places of point ", i, " are ", set.points[i].pointA, " and ",
        set.points[i].pointB, " m, allowed are up to ", 4 * kMaxDynamicExtent,
        " m along each axis from the centre of mass of a body that moves");
  }

  pair_.localNormal = unrotate(swapped_ ? -set.normal : set.normal, bodies_[0]->rotation());
  keepRotations(pair_, bodies_[0]->rotation(), bodies_[1]->rotation());
  for (int i = 0; i < set.count; ++i) {
    Contact<S>& contact = pair_.contacts[i];
    contact.anchorA = bodies_[0]->toLocal(swapped_ ? set.points[i].pointB : set.points[i].pointA);
    contact.anchorB = bodies_[1]->toLocal(swapped_ ? set.points[i].pointA : set.points[i].pointB);
  }
  pair_.manifold = Manifold::unknown;
  pair_.solvedNormal = {};
}

template <Scalar S>
Vector<S> Arbiter<S>::totalImpulse() const {
  if (count() == 0) return {};
  const Scaled<S> mass = lighterMass(*bodies_[0], *bodies_[1]);
  const Vector<S>& speed = pair_.solvedImpulse;
  const Vector<S> impulse(saturated<S>(toScaled(speed.x) * mass), saturated<S>(toScaled(speed.y) * mass));
  return swapped_ ? -impulse : impulse;
}

template <Scalar S>
S Arbiter<S>::totalKE() const {
  if (pair_.solved == 0) return S(0);
  const Body<S>& a = *bodies_[0];
  const Body<S>& b = *bodies_[1];
  const PairResponse<S> whole = respond(a, b);
  const Vector<S> n = pairNormal();
  const Vector<S> t = perp(n);
  const S loss = (S(1) - pair_.elasticity) / (S(1) + pair_.elasticity);
  Scaled<S> sum{};
  for (int i = 0; i < count(); ++i) {
    const Contact<S>& contact = pair_.contacts[i];
    const Vector<S> armA = surfacePoint(0, i) - a.worldCenter(), armB = surfacePoint(1, i) - b.worldCenter();
    const PairResponse<S> response = whole.at(armA, armB);
    const Scaled<S> normalK = toScaled(effectiveInverseMass(response, cross(armA, n), cross(armB, n)));
    const Scaled<S> tangentK = toScaled(effectiveInverseMass(response, cross(armA, t), cross(armB, t)));
    const Scaled<S> normal = toScaled(contact.normalTotal);
    const Scaled<S> tangent = toScaled(contact.tangentTotal);
    sum = sum + toScaled(loss) * normal * normal * normalK + tangent * tangent * tangentK;
  }
  return saturated<S>(sum * lighterMass(a, b));
}

#define SAMESTEP_EACH_SCALAR template class Arbiter<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
