// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <samestep/space.h>
#include "support/random.h"
#include "support/world.h"

namespace samestep {

/// A joint of each kind and way of each kind, between two bodies.
template <Scalar S>
std::vector<Joint<S>> jointsOfEachKind(BodyId a, BodyId b, const Vector<S>& anchorA,
                                       const Vector<S>& anchorB) {
  const Vector<S> up(S(0), S(1)), along(S(1), S(0));
  std::vector<Joint<S>> joints = {
      revoluteJoint(a, b, anchorA, anchorB),
      prismaticJoint(a, b, anchorA, anchorB, along),
      distanceJoint(a, b, anchorA, anchorB, S(1)),
      ropeJoint(a, b, anchorA, anchorB, ratio<S>(1, 2), S(2)),
      springJoint(a, b, anchorA, anchorB, S(1), S(3), ratio<S>(1, 2)),
      weldJoint(a, b, anchorA, anchorB, S(0)),
      wheelJoint(a, b, anchorA, anchorB, up, S(4), ratio<S>(3, 4)),
      grooveJoint(a, b, anchorA, anchorA + along, anchorB),
      targetJoint(a, b, anchorA, anchorB, S(4), S(1), S(200)),
      frictionJoint(a, b, S(5), S(5)),
      gearJoint(a, b, S(0), S(2)),
      rotarySpringJoint(a, b, S(1), S(2), ratio<S>(1, 4)),
      rotaryLimitJoint(a, b, S(-1), S(1)),
      motorJoint(a, b, S(3), S(20)),
      ratchetJoint(a, b, S(0), ratio<S>(1, 4)),
  };
  Joint<S> door = joints[0];
  door.limited = door.motor = door.spring = 1;
  door.lower = ratio<S>(-1, 2);
  door.upper = ratio<S>(1, 2);
  door.motorSpeed = S(1);
  door.motorMax = S(10);
  door.hertz = S(2);
  door.damping = ratio<S>(1, 2);
  joints.push_back(door);
  Joint<S> lift = joints[1];
  lift.limited = lift.motor = lift.spring = 1;
  lift.lower = S(-1);
  lift.upper = S(1);
  lift.motorSpeed = S(-1);
  lift.motorMax = S(50);
  lift.hertz = S(2);
  joints.push_back(lift);
  Joint<S> softWeld = joints[5];
  softWeld.hertz = softWeld.angularHertz = S(5);
  joints.push_back(softWeld);
  return joints;
}

/// Hinges between bodies 1 and 2 and between 2 and 3, which collide all the same.
template <Scalar S>
void joinNeighbours(Space<S>& space) {
  for (std::uint32_t i = 1; i < 3; ++i) {
    const BodyId a = space.state().bodies.idAt(i), b = space.state().bodies.idAt(i + 1);
    const Vector<S> middle = (space.body(a).position() + space.body(b).position()) * ratio<S>(1, 2);
    Joint<S> joint = revoluteJoint(a, b, space.body(a).toLocal(middle), space.body(b).toLocal(middle));
    joint.collideConnected = 1;
    space.add(joint);
  }
}

/// Joins some bodies of a world, each to the next one that there is, by all kinds of joints; some break.
template <Scalar S>
void joinAtRandom(Space<S>& space, std::uint64_t seed) {
  Random random(seed);
  std::vector<BodyId> bodies;
  space.eachBody([&](const Body<S>& body) { bodies.push_back(body.id()); });
  for (std::size_t i = 0; i + 1 < bodies.size(); ++i) {
    const Vector<S> anchorA(random.number<S>(-1, 1), random.number<S>(-1, 1));
    const Vector<S> middle = space.body(bodies[i]).toWorld(anchorA);
    const Vector<S> anchorB = heldWithin(space.body(bodies[i + 1]).toLocal(middle), S(2)) * ratio<S>(1, 2);
    const auto kinds = jointsOfEachKind(bodies[i], bodies[i + 1], anchorA, anchorB);
    Joint<S> joint = kinds[random.below(static_cast<std::uint32_t>(kinds.size()))];
    joint.collideConnected = random.oneIn(2) ? 1 : 0;
    joint.userData = random.next();
    if (random.oneIn(4)) joint.breakForce = S(300);
    if (random.oneIn(4)) joint.breakTorque = S(100);
    space.add(joint);
  }
}

}  // namespace samestep
