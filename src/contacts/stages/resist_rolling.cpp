// SPDX-License-Identifier: MIT
#include "contacts/stages/resist_rolling.h"

#include "base/require_ieee.h"
#include "contacts/contact_row.h"
#include "dynamics/body_access.h"

namespace samestep {
namespace {

template <Scalar S>
bool turns(const Body<S>& body) {
  return body.isDynamic() && body.activity() == Activity::awake && sign(body.inverseMoment()) > 0;
}

/// The largest angular impulse, N m s: the coefficient times the radius is how far before its middle the
/// contact bears.
template <Scalar S>
Scaled<S> mostOf(const StepContext<S>& step, const Pair<S>& pair, S lighterMass) {
  const Shape<S>&a = step.state.shapes.valueAt(pair.a.index), &b = step.state.shapes.valueAt(pair.b.index);
  const S coefficient = max(a.rollingResistance(), b.rollingResistance());
  const S radius = max(a.radius(), b.radius());
  S kept = S(0);
  for (int i = 0; i < pair.count; ++i) kept += clamp(pair.contacts[i].normalSpeed, S(0), kMaxSum<S>);
  // The soft step keeps what a substep took.
  const S times = step.isSoft() ? S(step.state.settings.substeps) : S(1);
  return toScaled(coefficient) * toScaled(radius) * toScaled(kept) * toScaled(times) * toScaled(lighterMass);
}

}  // namespace

template <Scalar S>
void ResistRolling<S>::act(StepContext<S>& step, const Pair<S>& pair) {
  const auto bodyOf = [&](ShapeId shape) -> Body<S>& {
    return step.state.bodies.valueAt(step.derived.traits[shape.index].body);
  };
  Body<S>&a = bodyOf(pair.a), &b = bodyOf(pair.b);
  if (!turns(a) && !turns(b)) return;
  const Scaled<S> easeA = turns(a) ? a.inverseMoment() : Scaled<S>{};
  const Scaled<S> easeB = turns(b) ? b.inverseMoment() : Scaled<S>{};
  const S lighter = !b.isDynamic() ? a.mass() : !a.isDynamic() ? b.mass() : min(a.mass(), b.mass());
  const Scaled<S> most = mostOf(step, pair, lighter);
  Scaled<S> angular = toScaled(b.angularVelocity() - a.angularVelocity()) / (easeA + easeB);
  if (angular > most) angular = most;
  if (angular < -most) angular = -most;
  const auto slow = [](Body<S>& body, const Scaled<S>& by) {
    if (!turns(body)) return;
    const S change = toScalarWithin<S>(by, S(2) * kMaxAngularSpeed<S>);
    BodyAccess<S>::holdVelocity(body, {body.velocity(), body.angularVelocity() + change});
  };
  slow(a, easeA * angular);
  slow(b, -(easeB * angular));
}

#define SAMESTEP_EACH_SCALAR template struct ResistRolling<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
