// SPDX-License-Identifier: MIT
#include "world/joints.h"

#include "base/require_ieee.h"
#include "islands/rouse.h"
#include "solver/joints/joint_rows.h"

namespace samestep {

/// The joint as the Space keeps it.
template <Scalar S>
Joint<S> Joints<S>::checked(const WorldState<S>& state, const Joint<S>& joint, const char* asked) {
  Joint<S> own = joint;
  own.kept = {};
  own.latch = S(0);
  forgetResults(own);
  state.bodies.template requireAlive<Fault::BodyNotFound>(joint.bodyA, asked);
  state.bodies.template requireAlive<Fault::BodyNotFound>(joint.bodyB, asked);
  require<Fault::IllegalJoint>(joint.bodyA != joint.bodyB, asked, ": both ends are on body ", joint.bodyA);
  const char* flaw = flawOfJoint(own);
  require<Fault::IllegalJoint>(flaw == nullptr, asked, ": ", flaw);
  own.axis = normalize(joint.axis);
  own.bodyA = state.bodies.idAt(joint.bodyA.index);
  own.bodyB = state.bodies.idAt(joint.bodyB.index);
  if (own.kind == JointKind::ratchet) {
    const S angleA = state.bodies.valueAt(own.bodyA.index).angle();
    own.latch = ratchetTooth(own, jointAngle(own, angleA, state.bodies.valueAt(own.bodyB.index).angle()));
  }
  return own;
}

/// Wakes what a joint holds, or held.
template <Scalar S>
void Joints<S>::changed(Context& world, const Joint<S>& joint) {
  world.derived.ensure(world.state);
  Rouse<S>::sleeper(world.state, world.derived, joint.bodyA.index);
  Rouse<S>::sleeper(world.state, world.derived, joint.bodyB.index);
  world.derived.jointedKnown = false;
}

template <Scalar S>
void Joints<S>::insert(Context& world, const Joint<S>& joint, JointId id) {
  const Joint<S> own = checked(world.state, joint, "Space::add: a joint");
  world.state.joints.store(id, own);
  changed(world, own);
}

template <Scalar S>
void Joints<S>::erase(Context& world, JointId id) {
  changed(world, world.state.joints.valueAt(id.index));
  world.state.joints.erase(id);
}

template <Scalar S>
void Joints<S>::replace(Context& world, JointId id, const Joint<S>& joint) {
  Joint<S>& kept = world.state.joints.template at<Fault::JointNotFound>(id, "Space::replace");
  Joint<S> next = checked(world.state, joint, "Space::replace: a joint");
  const bool same = next.kind == kept.kind && next.bodyA == kept.bodyA && next.bodyB == kept.bodyB;
  if (same) {
    next.kept = kept.kept;
    next.force = kept.force;
    next.torque = kept.torque;
    const bool sameTeeth = next.rest == kept.rest && next.angle == kept.angle;
    if (sameTeeth) next.latch = kept.latch;
  }
  changed(world, kept);
  kept = next;
  changed(world, kept);
}

template <Scalar S>
void Joints<S>::eraseOf(Context& world, BodyId id) {
  world.state.joints.each([&](JointId joint, const Joint<S>& of) {
    if (of.bodyA == id || of.bodyB == id) erase(world, joint);
  });
}

template <Scalar S>
bool Joints<S>::hasAny(const WorldState<S>& state, BodyId id) {
  bool found = false;
  state.joints.each(
      [&](JointId, const Joint<S>& joint) { found = found || joint.bodyA == id || joint.bodyB == id; });
  return found;
}

// Bodies are merged into the set of the lowest one, joint by joint.
template <Scalar S>
std::vector<BodyId> Joints<S>::connectedTo(const WorldState<S>& state, BodyId id) {
  std::vector<std::uint32_t> up(state.bodies.slots());
  for (std::uint32_t i = 0; i < up.size(); ++i) up[i] = i;
  const auto rootOf = [&](std::uint32_t i) {
    while (up[i] != i) i = up[i] = up[up[i]];
    return i;
  };
  const auto conducts = [&](std::uint32_t slot) {
    return slot == id.index || state.bodies.valueAt(slot).isDynamic();
  };
  state.joints.each([&](JointId, const Joint<S>& joint) {
    if (!conducts(joint.bodyA.index) || !conducts(joint.bodyB.index)) return;
    const std::uint32_t a = rootOf(joint.bodyA.index), b = rootOf(joint.bodyB.index);
    up[max(a, b)] = min(a, b);
  });
  const std::uint32_t root = rootOf(id.index);
  std::vector<std::uint8_t> isIn(up.size());
  for (std::uint32_t i = 0; i < up.size(); ++i) isIn[i] = rootOf(i) == root ? 1 : 0;
  // Bodies that nothing moves are each joined to their neighbours only.
  state.joints.each([&](JointId, const Joint<S>& joint) {
    const std::uint32_t a = joint.bodyA.index, b = joint.bodyB.index;
    if (rootOf(a) == root && !conducts(b)) isIn[b] = 1;
    if (rootOf(b) == root && !conducts(a)) isIn[a] = 1;
  });
  isIn[id.index] = 0;
  std::vector<BodyId> found;
  for (std::uint32_t i = 0; i < up.size(); ++i) {
    if (isIn[i] != 0 && state.bodies.aliveAt(i)) found.push_back(state.bodies.idAt(i));
  }
  return found;
}

#define SAMESTEP_EACH_SCALAR template struct Joints<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
