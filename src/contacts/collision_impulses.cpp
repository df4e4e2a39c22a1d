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

#ifndef SAMESTEP_FIXED_ONLY
template Vector<double> relativeVelocity<double>(const Body<double>&, const Body<double>&,
                                                 const Vector<double>&, const Vector<double>&);
template double normalRelativeVelocity<double>(const Body<double>&, const Body<double>&,
                                               const Vector<double>&, const Vector<double>&,
                                               const Vector<double>&);
template void applyImpulse<double>(Body<double>&, const Vector<double>&, const Vector<double>&);
template void applyImpulses<double>(Body<double>&, Body<double>&, const Vector<double>&,
                                    const Vector<double>&, const Vector<double>&);
template void applyBiasImpulse<double>(Body<double>&, const Vector<double>&, const Vector<double>&);
template void applyBiasImpulses<double>(Body<double>&, Body<double>&, const Vector<double>&,
                                        const Vector<double>&, const Vector<double>&);
template Scaled<double> inverseMassAlong<double>(const Body<double>&, const Vector<double>&,
                                                 const Vector<double>&);
template Scaled<double> inverseMassAlong<double>(const Body<double>&, const Body<double>&,
                                                 const Vector<double>&, const Vector<double>&,
                                                 const Vector<double>&);
#endif
template Vector<Fixed> relativeVelocity<Fixed>(const Body<Fixed>&, const Body<Fixed>&, const Vector<Fixed>&,
                                               const Vector<Fixed>&);
template Fixed normalRelativeVelocity<Fixed>(const Body<Fixed>&, const Body<Fixed>&, const Vector<Fixed>&,
                                             const Vector<Fixed>&, const Vector<Fixed>&);
template void applyImpulse<Fixed>(Body<Fixed>&, const Vector<Fixed>&, const Vector<Fixed>&);
template void applyImpulses<Fixed>(Body<Fixed>&, Body<Fixed>&, const Vector<Fixed>&, const Vector<Fixed>&,
                                   const Vector<Fixed>&);
template void applyBiasImpulse<Fixed>(Body<Fixed>&, const Vector<Fixed>&, const Vector<Fixed>&);
template void applyBiasImpulses<Fixed>(Body<Fixed>&, Body<Fixed>&, const Vector<Fixed>&, const Vector<Fixed>&,
                                       const Vector<Fixed>&);
template Scaled<Fixed> inverseMassAlong<Fixed>(const Body<Fixed>&, const Vector<Fixed>&,
                                               const Vector<Fixed>&);
template Scaled<Fixed> inverseMassAlong<Fixed>(const Body<Fixed>&, const Body<Fixed>&, const Vector<Fixed>&,
                                               const Vector<Fixed>&, const Vector<Fixed>&);
template Vector<CheckedFixed> relativeVelocity<CheckedFixed>(const Body<CheckedFixed>&,
                                                             const Body<CheckedFixed>&,
                                                             const Vector<CheckedFixed>&,
                                                             const Vector<CheckedFixed>&);
template CheckedFixed normalRelativeVelocity<CheckedFixed>(const Body<CheckedFixed>&,
                                                           const Body<CheckedFixed>&,
                                                           const Vector<CheckedFixed>&,
                                                           const Vector<CheckedFixed>&,
                                                           const Vector<CheckedFixed>&);
template void applyImpulse<CheckedFixed>(Body<CheckedFixed>&, const Vector<CheckedFixed>&,
                                         const Vector<CheckedFixed>&);
template void applyImpulses<CheckedFixed>(Body<CheckedFixed>&, Body<CheckedFixed>&,
                                          const Vector<CheckedFixed>&, const Vector<CheckedFixed>&,
                                          const Vector<CheckedFixed>&);
template void applyBiasImpulse<CheckedFixed>(Body<CheckedFixed>&, const Vector<CheckedFixed>&,
                                             const Vector<CheckedFixed>&);
template void applyBiasImpulses<CheckedFixed>(Body<CheckedFixed>&, Body<CheckedFixed>&,
                                              const Vector<CheckedFixed>&, const Vector<CheckedFixed>&,
                                              const Vector<CheckedFixed>&);
template Scaled<CheckedFixed> inverseMassAlong<CheckedFixed>(const Body<CheckedFixed>&,
                                                             const Vector<CheckedFixed>&,
                                                             const Vector<CheckedFixed>&);
template Scaled<CheckedFixed> inverseMassAlong<CheckedFixed>(const Body<CheckedFixed>&,
                                                             const Body<CheckedFixed>&,
                                                             const Vector<CheckedFixed>&,
                                                             const Vector<CheckedFixed>&,
                                                             const Vector<CheckedFixed>&);

}  // namespace samestep
