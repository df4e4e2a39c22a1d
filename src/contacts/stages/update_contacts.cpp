// SPDX-License-Identifier: MIT
#include "contacts/stages/update_contacts.h"

#include <atomic>

#include "base/require_ieee.h"
#include "contacts/push_contacts.h"
#include "contacts/stages/contact_callbacks.h"
#include "solver/soft_step/block_groups.h"

namespace samestep {

template <Scalar S>
void UpdateContacts<S>::collidePairs(StepContext<S>& step, const std::uint8_t* overlapping) {
  const std::uint32_t count = static_cast<std::uint32_t>(step.state.pairs.size());
  const bool surfacesKnown = step.derived.surfacesKnown;
  step.derived.surfacesKnown = false;
  someLeft_ = false;
  left_.resize(count);
  // Handlers are asked in order, and see the pairs before theirs updated, those after it not.
  if (!step.team.helpsWith(count, StepContext<S>::kFewPairs) || !step.state.handlers.empty()) {
    someLeft_ = collideRange(step, overlapping, 0, count, surfacesKnown, step.events.collisionStats);
  } else {
    collideTogether(step, overlapping, surfacesKnown);
  }
  // What callbacks have set is for this step.
  step.derived.surfacesKnown = step.state.handlers.empty();
}

template <Scalar S>
void UpdateContacts<S>::collideTogether(StepContext<S>& step, const std::uint8_t* overlapping,
                                        bool surfacesKnown) {
  const std::uint32_t count = static_cast<std::uint32_t>(step.state.pairs.size());
  Finding someLeft;
  std::atomic<std::uint32_t> gjk{0}, gjkToEpa{0}, epa{0};
  const auto add = [](std::atomic<std::uint32_t>& to, std::uint64_t number) {
    if (number != 0) to.fetch_add(static_cast<std::uint32_t>(number), std::memory_order_relaxed);
  };
  step.team.during(true, [&] {
    step.team.each(count, StepContext<S>::kPairGrain, [&](std::uint32_t begin, std::uint32_t end) {
      CollisionStats stats;
      someLeft.note(collideRange(step, overlapping, begin, end, surfacesKnown, stats));
      add(gjk, stats.highGjkIterations);
      add(gjkToEpa, stats.highGjkToEpaIterations);
      add(epa, stats.highEpaIterations);
    });
  });
  someLeft_ = static_cast<bool>(someLeft);
  step.events.collisionStats.highGjkIterations += gjk;
  step.events.collisionStats.highGjkToEpaIterations += gjkToEpa;
  step.events.collisionStats.highEpaIterations += epa;
}

/// Those of a range; without handlers this writes to nothing but these pairs.
/// @return whether any of them touched before and does not now
template <Scalar S>
bool UpdateContacts<S>::collideRange(StepContext<S>& step, const std::uint8_t* overlapping,
                                     std::uint32_t begin, std::uint32_t end, bool surfacesKnown,
                                     CollisionStats& stats) {
  bool someLeft = false;
  for (std::uint32_t i = begin; i < end; ++i) {
    Pair<S>& pair = step.state.pairs[i];
    if (pair.state == ArbiterState::firstCollision) pair.state = ArbiterState::normal;
    pair.solved = 0;
    if (pair.state != ArbiterState::apart && pair.age != 0xffffffffu) ++pair.age;
    if (overlapping[i] != 0) collidePair(step, pair, surfacesKnown, stats);
    const bool left = pair.state != ArbiterState::apart && pair.age != 0;
    left_[i] = left ? 1 : 0;
    someLeft |= left;
  }
  return someLeft;
}

template <Scalar S>
void UpdateContacts<S>::collidePair(StepContext<S>& step, Pair<S>& pair, bool surfacesKnown,
                                    CollisionStats& stats) {
  const Derived<S>& derived = step.derived;
  const ShapeTraits<S>&shapeA = derived.traits[pair.a.index], &shapeB = derived.traits[pair.b.index];
  const PlacedPose<S>&bodyA = derived.poses[shapeA.body], &bodyB = derived.poses[shapeB.body];
  const bool sensor = shapeA.sensor || shapeB.sensor;
  // A circle is collided faster than remembered, and no margin goes round a sensor.
  const bool recycles = step.isSoft() && !sensor && !shapeA.round && !shapeB.round;
  RelativePose pose;
  bool same = false;
  if (recycles) {
    // Seen from the larger shape, for a small turn of its body moves its ends far.
    const bool byA = shapeA.reach >= shapeB.reach;
    pose = byA ? relativePose(bodyA.frame, bodyB.frame) : relativePose(bodyB.frame, bodyA.frame);
    if (pair.manifold != Manifold::unknown && steady(pose, pair.pose, min(shapeA.reach, shapeB.reach))) {
      if (pair.manifold == Manifold::apart) return;
      same = pair.age == 1;
    }
  }
  if (!same) {
    const CollisionInfo<S> info = collide(derived.placed[pair.a.index], derived.placed[pair.b.index],
                                          pair.collisionId, &stats, sensor ? S(0) : step.pairMargin());
    pair.collisionId = info.id;
    pair.pose = pose;
    // Where one point touches a rounded surface, that surface may roll: a point fixed to it would lag behind
    // and drive it on.
    const bool rolls = info.count == 1 && (shapeA.rounded || shapeB.rounded);
    pair.manifold = Manifold::unknown;
    if (recycles && !rolls) pair.manifold = info.count == 0 ? Manifold::apart : Manifold::touching;
    if (info.count == 0) return;
    pushContacts(pair, info, bodyA.frame, bodyB.frame);
  }
  pair.age = 0;
  const Surface<S>&surfaceA = derived.surfaces[shapeA.surface], &surfaceB = derived.surfaces[shapeB.surface];
  const bool belt = surfaceA.velocity != surfaceB.velocity;
  if (!same || !surfacesKnown || belt) {
    const Vector<S> normal = belt ? rotate(pair.localNormal, bodyA.frame.rotation) : Vector<S>();
    takeSurfaces(pair, surfaceA, surfaceB, normal);
  }
  const bool wanted = applyCollision(step, pair);
  const bool moves = bodyA.type == BodyType::dynamicBody || bodyB.type == BodyType::dynamicBody;
  if (wanted && moves && !sensor) {
    pair.solved = 1;
  } else {
    // What is not solved must not come back as an old impulse.
    for (Contact<S>& contact : pair.contacts) {
      contact.normalSpeed = contact.tangentSpeed = contact.normalTotal = contact.tangentTotal = S(0);
    }
    if (pair.state != ArbiterState::ignored && pair.state != ArbiterState::firstCollision) {
      pair.state = ArbiterState::normal;
    }
  }
}

template <Scalar S>
bool UpdateContacts<S>::applyCollision(StepContext<S>& step, Pair<S>& pair) {
  if (pair.state == ArbiterState::apart || pair.state == ArbiterState::cached) {
    pair.state = ArbiterState::firstCollision;
  }
  if (step.state.handlers.empty()) return pair.state != ArbiterState::ignored;
  return ContactCallbacks<S>::ask(step, pair);
}

/// Whether two static shapes that touched while one of them moved still do. Nothing looks for such pairs:
/// they are kept, as they are, for when one moves again.
template <Scalar S>
bool UpdateContacts<S>::staysInTouch(const StepContext<S>& step, const Pair<S>& pair) {
  if (pair.state == ArbiterState::cached) return false;
  const Derived<S>& derived = step.derived;
  const ShapeTraits<S>&shapeA = derived.traits[pair.a.index], &shapeB = derived.traits[pair.b.index];
  if (!mayCollide(shapeA, shapeB)) return false;
  const PlacedShape<S>&placedA = derived.placed[pair.a.index], &placedB = derived.placed[pair.b.index];
  const S margin = shapeA.sensor || shapeB.sensor ? S(0) : step.pairMargin();
  if (!intersects(inflate(placedA.box, margin), placedB.box)) return false;
  const CollisionInfo<S> info = collide(placedA, placedB, pair.collisionId, nullptr, margin);
  if (margin == S(0)) return info.count > 0;
  for (int i = 0; i < info.count; ++i) {
    if (dot(info.points[i].pointB - info.points[i].pointA, info.normal) <= S(0)) return true;
  }
  return false;
}

template <Scalar S>
void UpdateContacts<S>::expirePairs(StepContext<S>& step, const std::uint8_t* overlapping) {
  auto& pairs = step.state.pairs;
  std::size_t firstDropped = pairs.size();
  for (std::size_t i = 0; someLeft_ && i < pairs.size(); ++i) {
    if (left_[i] == 0) continue;
    Pair<S>& pair = pairs[i];
    if (step.rests(pair) && staysInTouch(step, pair)) continue;
    if (pair.state != ArbiterState::cached) {
      pair.state = ArbiterState::cached;
      ContactCallbacks<S>::separate(step, pair, false);
    }
    if (pair.age < step.state.settings.collisionPersistence) continue;
    if (overlapping[i] != 0) {
      Pair<S> fresh;
      fresh.a = pair.a;
      fresh.b = pair.b;
      fresh.collisionId = pair.collisionId;
      fresh.pose = pair.pose;
      fresh.manifold = pair.manifold;
      pair = fresh;
    } else {
      pair.state = ArbiterState::apart;
      pair.age = 0;
      firstDropped = min(firstDropped, i);
    }
  }
  if (firstDropped != pairs.size()) dropApart(step, overlapping, firstDropped);
}

/// Forgets the pairs that stand apart and whose boxes do, from one on.
template <Scalar S>
void UpdateContacts<S>::dropApart(StepContext<S>& step, const std::uint8_t* overlapping, std::size_t first) {
  auto& pairs = step.state.pairs;
  std::size_t kept = first;
  for (std::size_t i = first; i < pairs.size(); ++i) {
    if (pairs[i].state == ArbiterState::apart && overlapping[i] == 0) continue;
    if (kept != i) pairs[kept] = pairs[i];
    ++kept;
  }
  pairs.resize(kept);
  step.derived.bodyPairs.known = false;
}

#define SAMESTEP_EACH_SCALAR template class UpdateContacts<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
