// SPDX-License-Identifier: MIT
#include <samestep/body.h>
#include <samestep/collision.h>

namespace samestep {

template <Scalar S>
Vector<S> relativeVelocity(const Body<S>& a, const Body<S>& b, const Vector<S>& armA, const Vector<S>& armB) {
  const auto velocityAt = [](const Body<S>& body, const Vector<S>& arm) {
    return body.velocity() + perp(arm) * body.angularVelocity();
  };
  return velocityAt(b, armB) - velocityAt(a, armA);
}

template <Scalar S>
S normalRelativeVelocity(const Body<S>& a, const Body<S>& b, const Vector<S>& armA, const Vector<S>& armB,
                         const Vector<S>& normal) {
  return dot(relativeVelocity(a, b, armA, armB), normal);
}

template <Scalar S>
void applyImpulse(Body<S>& body, const Vector<S>& impulse, const Vector<S>& arm) {
  body.applyImpulse(impulse, body.worldCenter() + arm);
}

template <Scalar S>
void applyImpulses(Body<S>& a, Body<S>& b, const Vector<S>& armA, const Vector<S>& armB,
                   const Vector<S>& impulse) {
  applyImpulse(a, -impulse, armA);
  applyImpulse(b, impulse, armB);
}

template <Scalar S>
void applyBiasImpulse(Body<S>& body, const Vector<S>& impulse, const Vector<S>& arm) {
  body.applyBiasImpulse(impulse, body.worldCenter() + arm);
}

template <Scalar S>
void applyBiasImpulses(Body<S>& a, Body<S>& b, const Vector<S>& armA, const Vector<S>& armB,
                       const Vector<S>& impulse) {
  applyBiasImpulse(a, -impulse, armA);
  applyBiasImpulse(b, impulse, armB);
}

template <Scalar S>
Scaled<S> inverseMassAlong(const Body<S>& body, const Vector<S>& arm, const Vector<S>& axis) {
  const Scaled<S> lever = toScaled(exactCross(arm, axis));
  return body.inverseMass() + body.inverseMoment() * lever * lever;
}

template <Scalar S>
Scaled<S> inverseMassAlong(const Body<S>& a, const Body<S>& b, const Vector<S>& armA, const Vector<S>& armB,
                           const Vector<S>& axis) {
  const Scaled<S> sum = inverseMassAlong(a, armA, axis) + inverseMassAlong(b, armB, axis);
  require<Fault::UnsolvableCollision>(sign(sum) > 0);
  return sum;
}

#define SAMESTEP_EACH_SCALAR                                                                                 \
  template Vector<S> relativeVelocity<S>(const Body<S>&, const Body<S>&, const Vector<S>&,                   \
                                         const Vector<S>&);                                                  \
  template S normalRelativeVelocity<S>(const Body<S>&, const Body<S>&, const Vector<S>&, const Vector<S>&,   \
                                       const Vector<S>&);                                                    \
  template void applyImpulse<S>(Body<S>&, const Vector<S>&, const Vector<S>&);                               \
  template void applyImpulses<S>(Body<S>&, Body<S>&, const Vector<S>&, const Vector<S>&, const Vector<S>&);  \
  template void applyBiasImpulse<S>(Body<S>&, const Vector<S>&, const Vector<S>&);                           \
  template void applyBiasImpulses<S>(Body<S>&, Body<S>&, const Vector<S>&, const Vector<S>&,                 \
                                     const Vector<S>&);                                                      \
  template Scaled<S> inverseMassAlong<S>(const Body<S>&, const Vector<S>&, const Vector<S>&);                \
  template Scaled<S> inverseMassAlong<S>(const Body<S>&, const Body<S>&, const Vector<S>&, const Vector<S>&, \
                                         const Vector<S>&);
#include <samestep/each_scalar.h>

}  // namespace samestep
