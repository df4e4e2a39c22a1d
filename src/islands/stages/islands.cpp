// SPDX-License-Identifier: MIT
#include "islands/stages/islands.h"

#include <algorithm>

#include "base/require_ieee.h"
#include "contacts/push_contacts.h"
#include "contacts/stages/contact_callbacks.h"
#include "contacts/stages/list_contacts.h"
#include "contacts/stages/update_contacts.h"
#include "contacts/touching.h"
#include "dynamics/body_access.h"

namespace samestep {
namespace {

// A body was roused by a change of itself, or of what lies on it wherever it is.
constexpr std::uint8_t kMoves = 1, kIsStatic = 2;

template <Scalar S>
bool standsStill(const Body<S>& body) {
  return body.velocity() == Vector<S>() && body.angularVelocity() == S(0);
}

/// Tells whether steps leave both bodies of a pair alone. What a callback rouses wakes with the next one.
template <Scalar S>
bool bothRest(const StepContext<S>& step, const Pair<S>& pair) {
  const auto rests = [&](ShapeId shape) {
    const std::uint32_t body = step.derived.traits[shape.index].body;
    return step.state.bodies.valueAt(body).activity() != Activity::awake;
  };
  return rests(pair.a) && rests(pair.b);
}

/// Takes those out of a list, in order, that are meant.
template <Scalar S, class IsMeant>
void takeOut(std::vector<Pair<S>>& pairs, std::vector<Pair<S>>& out, IsMeant&& isMeant) {
  out.clear();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (isMeant(pairs[i])) {
      out.push_back(pairs[i]);
    } else {
      if (kept != i) pairs[kept] = pairs[i];
      ++kept;
    }
  }
  pairs.resize(kept);
}

}  // namespace

template <Scalar S>
bool Islands<S>::isRoused(const StepContext<S>& step, std::uint32_t slot) {
  if (!step.state.bodies.aliveAt(slot)) return false;
  const Body<S>& body = step.state.bodies.valueAt(slot);
  if (body.activity() == Activity::roused) return true;
  const bool mayRest = step.state.settings.sleepTimeThreshold != S(0);
  return mayRest && body.type() == BodyType::staticBody && body.activity() == Activity::awake;
}

/// Tells of a static body, which nothing moves, whether a force is to be taken from it.
template <Scalar S>
bool Islands<S>::isPulled(const StepContext<S>& step, std::uint32_t slot) {
  if (!step.state.bodies.aliveAt(slot)) return false;
  const Body<S>& body = step.state.bodies.valueAt(slot);
  return body.type() == BodyType::staticBody && (body.force() != Vector<S>() || body.torque() != S(0));
}

template <Scalar S>
bool Islands<S>::anyRoused(const StepContext<S>& step) {
  if (!step.derived.cached) return true;
  return std::any_of(step.derived.touched.begin(), step.derived.touched.end(),
                     [&](std::uint32_t slot) { return isRoused(step, slot) || isPulled(step, slot); });
}

template <Scalar S>
void Islands<S>::wakeRoused(StepContext<S>& step) {
  Derived<S>& derived = step.derived;
  derived.ensure(step.state);
  noteRoused(step);
  if (roused_.empty()) {
    derived.findActive(step.state);
    return;
  }
  noteOnRoused(step);
  wakeNoted(step);
  takeAwakePairs(step);
}

/// Lists what was changed, by rising slot.
template <Scalar S>
void Islands<S>::noteRoused(StepContext<S>& step) {
  roused_.clear();
  stirred_.clear();
  for (const std::uint32_t slot : step.derived.touched) {
    if (isRoused(step, slot)) roused_.push_back(slot);
    // No stage looks at a static body.
    if (isPulled(step, slot)) BodyAccess<S>::clearForces(step.state.bodies.valueAt(slot));
  }
  // total order: each is touched once
  std::sort(roused_.begin(), roused_.end());
}

/// Notes that the island of a sleeper is to wake.
template <Scalar S>
void Islands<S>::noteIsland(const StepContext<S>& step, std::uint32_t slot) {
  const Body<S>& body = step.state.bodies.valueAt(slot);
  if (body.activity() == Activity::awake || body.island() >= wanted_.size()) return;
  if (body.island() == 0) return;
  wanted_[body.island()] = 1;
  anyWanted_ = true;
}

/// Notes the islands of what was roused, of what touches it, and of what is near a static body, both where it
/// was and where it is.
template <Scalar S>
void Islands<S>::noteOnRoused(StepContext<S>& step) {
  const auto& bodies = step.state.bodies;
  const bool sleeps = step.derived.anySleeps(step.state);
  anyWanted_ = false;
  wanted_.assign(bodies.slots() + std::size_t{1}, 0);
  roles_.assign(bodies.slots(), 0);
  for (const std::uint32_t slot : roused_) {
    roles_[slot] = bodies.valueAt(slot).type() == BodyType::staticBody ? kIsStatic : kMoves;
    noteIsland(step, slot);
  }
  for (const Pair<S>& pair : step.state.restingPairs) {
    const std::uint32_t a = step.derived.traits[pair.a.index].body,
                        b = step.derived.traits[pair.b.index].body;
    const std::uint8_t roles = roles_[a] | roles_[b];
    if (roles == 0 || (roles == kMoves && !ContactCallbacks<S>::hasBegun(pair))) continue;
    noteIsland(step, a);
    noteIsland(step, b);
  }
  step.state.joints.each([&](JointId, const Joint<S>& joint) {
    if ((roles_[joint.bodyA.index] | roles_[joint.bodyB.index]) == 0) return;
    noteIsland(step, joint.bodyA.index);
    noteIsland(step, joint.bodyB.index);
  });
  if (!sleeps) return;
  // Shapes of what is roused stand where it does before anybody asks what is near them.
  step.derived.refresh(step.state);
  for (const std::uint32_t slot : roused_) {
    if (roles_[slot] != kIsStatic) continue;
    for (std::uint32_t i = step.derived.firstShape[slot]; i != Derived<S>::kNone;
         i = step.derived.nextShape[i]) {
      step.derived.eachSleeperNear(step.state, i, [&](std::uint32_t near) { noteIsland(step, near); });
    }
  }
}

/// Wakes what was roused and the islands noted.
template <Scalar S>
void Islands<S>::wakeNoted(StepContext<S>& step) {
  auto& bodies = step.state.bodies;
  woken_.clear();
  for (std::uint32_t slot = 0; anyWanted_ && slot < bodies.slots(); ++slot) {
    if (!bodies.aliveAt(slot)) continue;
    const std::uint32_t island = bodies.valueAt(slot).island();
    if (island != 0 && island < wanted_.size() && wanted_[island] != 0) woken_.push_back(slot);
  }
  for (const std::uint32_t slot : roused_) {
    woken_.push_back(slot);
    if (bodies.valueAt(slot).type() == BodyType::staticBody) stirred_.push_back(slot);
  }
  roused_.clear();
  for (const std::uint32_t slot : woken_) {
    BodyAccess<S>::wake(bodies.valueAt(slot));
    step.derived.movePlaced(step.state, slot);
    step.derived.putBoxesOf(step.state, slot);
  }
  step.derived.activeKnown = false;
  step.derived.findActive(step.state);
}

/// Gives the pairs of what is awake to the step.
template <Scalar S>
void Islands<S>::takeAwakePairs(StepContext<S>& step) {
  WorldState<S>& world = step.state;
  takeOut(world.restingPairs, moved_, [&](const Pair<S>& pair) { return !bothRest(step, pair); });
  for (Pair<S>& pair : moved_) Derived<S>::takeShapesSurfaces(world, pair);
  FindPairs<S>::mergeInto(world.pairs, moved_);
  step.derived.bodyPairs.known = step.derived.restingPairs.known = false;
}

template <Scalar S>
void Islands<S>::wakeTouched(StepContext<S>& step, FindPairs<S>& findPairs) {
  if (!step.derived.anySleeps(step.state)) return;
  // A body that wakes may touch others that sleep.
  while (noteTouched(step, findPairs)) {
    wakeNoted(step);
    takeOut(step.state.restingPairs, moved_, [&](const Pair<S>& pair) { return !bothRest(step, pair); });
    for (Pair<S>& pair : moved_) Derived<S>::takeShapesSurfaces(step.state, pair);
    findPairs.addRested(step, moved_);
    ListContacts<S>::addBegun(step, moved_);
    step.derived.restingPairs.known = false;
  }
}

/// Notes the islands that something awake touches; false for none.
template <Scalar S>
bool Islands<S>::noteTouched(StepContext<S>& step, const FindPairs<S>& findPairs) {
  const Derived<S>& derived = step.derived;
  const std::vector<std::uint8_t>& overlapping = findPairs.overlapping();
  anyWanted_ = false;
  wanted_.assign(step.state.bodies.slots() + std::size_t{1}, 0);
  for (std::size_t i = 0; i < overlapping.size(); ++i) {
    const Pair<S>& pair = step.state.pairs[i];
    const ShapeTraits<S>&a = derived.traits[pair.a.index], &b = derived.traits[pair.b.index];
    if (derived.sleeps[a.body] == derived.sleeps[b.body] || overlapping[i] == 0) continue;
    if (a.sensor || b.sensor || pair.state == ArbiterState::ignored) continue;
    if (!UpdateContacts<S>::wouldTouch(step, pair)) continue;
    noteIsland(step, derived.sleeps[a.body] != 0 ? a.body : b.body);
  }
  return anyWanted_;
}

template <Scalar S>
bool Islands<S>::isIdle(const StepContext<S>& step, std::uint32_t slot) {
  const Body<S>& body = step.state.bodies.valueAt(slot);
  const S most = step.state.settings.idleSpeedThreshold;
  const S speed = abs(body.velocity().x) + abs(body.velocity().y);
  if (speed > most) return false;
  const S spin = abs(body.angularVelocity());
  if (spin == S(0)) return true;
  const Derived<S>& derived = step.derived;
  std::int32_t reach = 0;
  for (std::uint32_t i = derived.firstShape[slot]; i != Derived<S>::kNone; i = derived.nextShape[i]) {
    reach = std::max(reach, derived.traits[i].reach);
  }
  const Vector<S>& center = body.centerOfMass();
  const S arm = S(reach) * ratio<S>(1, kReachUnits) + abs(center.x) + abs(center.y);
  return speed + spin * arm <= most;
}

template <Scalar S>
void Islands<S>::fallAsleep(StepContext<S>& step) {
  if (step.state.settings.sleepTimeThreshold == S(0)) return;
  slept_.clear();
  const bool someReady = countRest(step);
  settleStill(step);
  if (someReady) findIslands(step);
  if (slept_.empty()) return;
  for (const std::uint32_t slot : slept_) step.derived.putBoxesOf(step.state, slot);
  restPairs(step);
  step.derived.activeKnown = false;
  step.derived.mostSleepers = Derived<S>::kNone;
}

/// Counts on for what is at rest, and anew for the rest.
/// @return whether anything has been so for long enough
template <Scalar S>
bool Islands<S>::countRest(StepContext<S>& step) {
  const S wait = step.state.settings.sleepTimeThreshold;
  bool some = false;
  for (const std::uint32_t slot : step.derived.active) {
    Body<S>& body = step.state.bodies.valueAt(slot);
    if (!body.isDynamic()) continue;
    const S rest = isIdle(step, slot) ? min(body.restTime() + step.dt, kMaxRestTime<S>) : S(0);
    BodyAccess<S>::setRestTime(body, rest);
    some |= rest >= wait;
  }
  return some;
}

/// Settles bodies that are not dynamic: they rest while nobody moves them.
template <Scalar S>
void Islands<S>::settleStill(StepContext<S>& step) {
  const auto settle = [&](std::uint32_t slot) {
    BodyAccess<S>::fallAsleep(step.state.bodies.valueAt(slot), 0);
    slept_.push_back(slot);
  };
  for (const std::uint32_t slot : stirred_) {
    if (step.state.bodies.valueAt(slot).activity() == Activity::awake) settle(slot);
  }
  stirred_.clear();
  for (const std::uint32_t slot : step.derived.active) {
    const Body<S>& body = step.state.bodies.valueAt(slot);
    const bool byHand = body.positionFunc() != 0 || body.velocityFunc() != 0;
    if (body.type() == BodyType::kinematicBody && standsStill(body) && !byHand && body.maySleep())
      settle(slot);
  }
}

/// Calls visit(a, b, pushes) for the slots of bodies that something holds together.
template <Scalar S>
template <class Visit>
void Islands<S>::eachEdge(const StepContext<S>& step, Visit&& visit) {
  for (const Pair<S>& pair : step.state.pairs) {
    if (pair.solved == 0) continue;
    visit(step.derived.traits[pair.a.index].body, step.derived.traits[pair.b.index].body, wasPushed(pair));
  }
  step.state.joints.each([&](JointId, const Joint<S>& joint) {
    const Body<S>& a = step.state.bodies.valueAt(joint.bodyA.index);
    const Body<S>& b = step.state.bodies.valueAt(joint.bodyB.index);
    // A body that a callback has roused in this step is in no island until the next one wakes it.
    const auto takesPart = [](const Body<S>& body) {
      return !body.isDynamic() || body.activity() == Activity::awake;
    };
    const bool holds = (a.isDynamic() || b.isDynamic()) && takesPart(a) && takesPart(b);
    // A slack rope holds nothing.
    const bool pulls = joint.force != Vector<S>() || joint.torque != S(0);
    if (holds) visit(joint.bodyA.index, joint.bodyB.index, pulls);
  });
}

template <Scalar S>
std::uint32_t Islands<S>::rootOf(std::uint32_t slot) {
  while (parents_[slot] != slot) {
    parents_[slot] = parents_[parents_[slot]];
    slot = parents_[slot];
  }
  return slot;
}

/// Puts the islands to sleep whose bodies may all sleep and which something holds, if anything pulls at them.
template <Scalar S>
void Islands<S>::findIslands(StepContext<S>& step) {
  auto& bodies = step.state.bodies;
  parents_.resize(bodies.slots());
  known_.assign(bodies.slots(), 0);
  for (const std::uint32_t slot : step.derived.active) parents_[slot] = slot;
  eachEdge(step, [&](std::uint32_t a, std::uint32_t b, bool pushes) {
    const Body<S>&bodyA = bodies.valueAt(a), &bodyB = bodies.valueAt(b);
    if (bodyA.isDynamic() && bodyB.isDynamic()) {
      const std::uint32_t rootA = rootOf(a), rootB = rootOf(b);
      // The lowest slot stands for an island, whatever came first.
      parents_[std::max(rootA, rootB)] = std::min(rootA, rootB);
      return;
    }
    const Body<S>& other = bodyA.isDynamic() ? bodyB : bodyA;
    const bool moves = other.type() != BodyType::staticBody && other.activity() != Activity::asleep;
    known_[bodyA.isDynamic() ? a : b] |= moves ? kStaysAwake : pushes ? kHeld : 0;
  });
  const auto& active = step.derived.active;
  for (const std::uint32_t slot : active) {
    const Body<S>& body = bodies.valueAt(slot);
    if (!body.isDynamic()) continue;
    // Contacts hold nothing that a callback has moved since they were solved.
    const bool there = step.derived.poses[slot] == PlacedPose<S>::of(body);
    const bool ready = body.restTime() >= step.state.settings.sleepTimeThreshold && body.maySleep() && there;
    const bool pulled =
        BodyAccess<S>::acceleration(body, step.state.settings.gravity).velocity != Vector<S>();
    known_[rootOf(slot)] |= known_[slot];
    if (!ready) known_[rootOf(slot)] |= kStaysAwake;
    if (pulled) known_[rootOf(slot)] |= kPulled;
  }
  for (const std::uint32_t slot : active) {
    if (!bodies.valueAt(slot).isDynamic()) continue;
    const std::uint32_t root = rootOf(slot);
    const std::uint8_t known = known_[root];
    if ((known & kStaysAwake) != 0 || (known & (kPulled | kHeld)) == kPulled) continue;
    slept_.push_back(slot);
  }
  for (const std::uint32_t slot : slept_) {
    Body<S>& body = bodies.valueAt(slot);
    if (body.isDynamic()) BodyAccess<S>::fallAsleep(body, rootOf(slot) + 1);
  }
}

/// Takes the pairs of what rests out of the step.
template <Scalar S>
void Islands<S>::restPairs(StepContext<S>& step) {
  takeOut(step.state.pairs, moved_, [&](const Pair<S>& pair) { return bothRest(step, pair); });
  if (moved_.empty()) return;
  for (Pair<S>& pair : moved_) {
    forgetResults(pair);
    Derived<S>::takeShapesSurfaces(step.state, pair);
  }
  FindPairs<S>::mergeInto(step.state.restingPairs, moved_);
  step.derived.bodyPairs.known = step.derived.restingPairs.known = false;
}

#define SAMESTEP_EACH_SCALAR template class Islands<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
