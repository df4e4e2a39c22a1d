// SPDX-License-Identifier: MIT
#include "contacts/stages/update_contacts.h"

#include <atomic>

#include "base/require_ieee.h"
#include "contacts/approach.h"
#include "contacts/push_contacts.h"
#include "contacts/stages/contact_callbacks.h"
#include "contacts/touching.h"
#include "dynamics/body_access.h"
#include "solver/soft_step/block_groups.h"

namespace samestep {

namespace {

/// True if pairs are decided when all have been collided: where handlers are asked, and where what touches is
/// known before the solver tells.
template <Scalar S>
bool decidesLater(const StepContext<S>& step) {
  return !step.state.handlers.empty() || !step.isSoft();
}

}  // namespace

template <Scalar S>
void UpdateContacts<S>::collidePairs(StepContext<S>& step, const std::uint8_t* overlapping) {
  const std::uint32_t count = static_cast<std::uint32_t>(step.state.pairs.size());
  const bool surfacesKnown = step.derived.surfacesKnown;
  step.derived.surfacesKnown = false;
  someLeft_ = false;
  found_.resize(count);
  someCompound_ = step.derived.hasCompound(step.state);
  const bool handled = !step.state.handlers.empty();
  if (!step.team.helpsWith(count, StepContext<S>::kFewPairs)) {
    const std::uint32_t grain = Budget::kPairsAtOnce;
    for (std::uint32_t begin = 0; begin < count; begin += min(grain, count - begin)) {
      const std::uint32_t end = begin + min(grain, count - begin);
      someLeft_ |= collideRange(step, overlapping, begin, end, surfacesKnown, step.events.collisionStats);
      step.pay(Budget::kPerPair * (end - begin));
    }
  } else {
    collideTogether(step, overlapping, surfacesKnown);
  }
  mendSeams_.run(step, found_);
  step.pay(0);
  decidePairs(step, decidesLater(step));
  // Callbacks set values for this step only.
  step.derived.surfacesKnown = !handled;
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
    // Nobody waits for others where nobody asks.
    const std::uint32_t most = step.wiring.budget.isWatched() ? kPairsTogether : count;
    for (std::uint32_t from = 0; from < count; from += min(most, count - from)) {
      const std::uint32_t part = min(most, count - from);
      step.team.each(part, StepContext<S>::kPairGrain, [&](std::uint32_t begin, std::uint32_t end) {
        CollisionStats stats;
        someLeft.note(collideRange(step, overlapping, from + begin, from + end, surfacesKnown, stats));
        add(gjk, stats.highGjkIterations);
        add(gjkToEpa, stats.highGjkToEpaIterations);
        add(epa, stats.highEpaIterations);
      });
      if (step.wiring.budget.spend(Budget::kPerPair * part)) break;
    }
  });
  step.wiring.budget.endWhereAsked();
  someLeft_ = static_cast<bool>(someLeft);
  step.events.collisionStats.highGjkIterations += gjk;
  step.events.collisionStats.highGjkToEpaIterations += gjkToEpa;
  step.events.collisionStats.highEpaIterations += epa;
}

/// Collides the pairs of a range; this writes to nothing but these pairs. In the soft step without handlers
/// it decides about them, too, but for those that may lie at a seam.
/// @return whether any of them touched before and does not now
template <Scalar S>
bool UpdateContacts<S>::collideRange(StepContext<S>& step, const std::uint8_t* overlapping,
                                     std::uint32_t begin, std::uint32_t end, bool surfacesKnown,
                                     CollisionStats& stats) {
  bool someLeft = false;
  const bool later = decidesLater(step);
  const Deciding deciding{!later, surfacesKnown, someCompound_};
  for (std::uint32_t i = begin; i < end; ++i) {
    Pair<S>& pair = step.state.pairs[i];
    if (pair.state == ArbiterState::firstCollision) pair.state = ArbiterState::normal;
    pair.solved = 0;
    pair.solvedImpulse = pair.solvedNormal = {};
    if (pair.state != ArbiterState::apart) {
      if (pair.age != 0xffffffffu) ++pair.age;
      // No callback before the solver's end may see an impulse of the step before: a saved world has none.
      for (Contact<S>& contact : pair.contacts) contact.normalTotal = contact.tangentTotal = S(0);
    }
    std::uint8_t found = 0;
    if (overlapping[i] != 0) {
      found = collidePair(step, pair, deciding, stats);
    } else {
      pair.manifold = Manifold::unknown;
    }
    if (!later && (found & ContactFound::kSeam) == 0) {
      if ((found & ContactFound::kNear) != 0 && pair.solved == 0) decide(step, pair);
      if (hasLeft(pair)) {
        found |= ContactFound::kLeft;
        someLeft = true;
      }
    }
    found_[i] = found;
  }
  return someLeft;
}

/// Finds the contact of a pair, or takes that of the last step. Of bodies that contacts move, with surfaces
/// that move alike, it is solved where that may be said now.
/// @return what was found: bits of ContactFound
template <Scalar S>
std::uint8_t UpdateContacts<S>::collidePair(const StepContext<S>& step, Pair<S>& pair,
                                            const Deciding& deciding, CollisionStats& stats) {
  const Derived<S>& derived = step.derived;
  const ShapeTraits<S>&shapeA = derived.traits[pair.a.index], &shapeB = derived.traits[pair.b.index];
  const PlacedPose<S>&bodyA = derived.poses[shapeA.body], &bodyB = derived.poses[shapeB.body];
  const bool sensor = shapeA.sensor || shapeB.sensor;
  const bool soft = step.isSoft() && !sensor;
  // A circle is collided faster than remembered, and no margin goes round a sensor.
  const bool recycles = soft && !shapeA.round && !shapeB.round;
  RelativePose pose;
  bool same = false;
  if (recycles) {
    // The pose is that of the larger shape, for a small turn of its body moves its ends far.
    const bool byA = shapeA.reach >= shapeB.reach;
    pose = byA ? relativePose(bodyA.frame, bodyB.frame) : relativePose(bodyB.frame, bodyA.frame);
    if (pair.manifold != Manifold::unknown && steady(pose, pair.pose, min(shapeA.reach, shapeB.reach))) {
      if (pair.manifold == Manifold::apart) return 0;
      same = pair.count > 0;
    }
  }
  if (!same) {
    const CollisionInfo<S> info = collide(derived.placed[pair.a.index], derived.placed[pair.b.index],
                                          pair.collisionId, &stats, sensor ? S(0) : step.pairMargin());
    pair.collisionId = info.id;
    pair.pose = pose;
    // A rounded surface that one point touches may roll: a point fixed to it would lag behind and drive it
    // on.
    const bool rolls = info.count == 1 && (shapeA.rounded || shapeB.rounded);
    pair.manifold = Manifold::unknown;
    if (recycles && !rolls) pair.manifold = info.count == 0 ? Manifold::apart : Manifold::touching;
    if (info.count == 0) return 0;
    pushContacts(pair, info, bodyA.frame, bodyB.frame);
  }
  if (same) followRotations(pair, bodyA.frame, bodyB.frame, max(shapeA.reach, shapeB.reach));
  // Now, even if nothing meets in this step: another may take the contact as it is.
  if (!same || !deciding.surfacesKnown) {
    takeSurfaces(pair, derived.surfaces[shapeA.surface], derived.surfaces[shapeB.surface], {});
  }
  const bool movesA = bodyA.type == BodyType::dynamicBody, movesB = bodyB.type == BodyType::dynamicBody;
  // A contact that held something in the last step need not be asked.
  const bool holds = pair.contacts[0].normalSpeed + pair.contacts[1].normalSpeed != S(0);
  Meeting meeting = Meeting::notAsked;
  if (soft && !holds && (movesA || movesB)) {
    meeting = meetsInStep(step, pair);
    if (meeting == Meeting::none) return 0;
  }
  const bool compound =
      deciding.compounds && (derived.isCompound(shapeA.body) || derived.isCompound(shapeB.body));
  const bool seam = !sensor && (movesA != movesB || (movesA && compound));
  if (deciding.now && soft && !seam && movesA && movesB && shapeA.surface == shapeB.surface &&
      pair.state != ArbiterState::ignored) {
    pair.solved = meeting == Meeting::later ? kSolvedApart : 1;
    if (meeting == Meeting::now) noteTouch(pair);
  }
  return static_cast<std::uint8_t>(ContactFound::kNear | (same ? 0 : ContactFound::kFresh) |
                                   (seam ? ContactFound::kSeam : 0));
}

template <Scalar S>
bool UpdateContacts<S>::wouldTouch(const StepContext<S>& step, const Pair<S>& pair) {
  Pair<S> tried = pair;
  CollisionStats stats;
  const Deciding deciding{false, true, false};
  return (collidePair(step, tried, deciding, stats) & ContactFound::kNear) != 0;
}

/// Tells whether a contact is one in this step, and of shapes that touch now: see meets.
template <Scalar S>
typename UpdateContacts<S>::Meeting UpdateContacts<S>::meetsInStep(const StepContext<S>& step,
                                                                   Pair<S>& pair) {
  const Derived<S>& derived = step.derived;
  const ShapeTraits<S>&shapeA = derived.traits[pair.a.index], &shapeB = derived.traits[pair.b.index];
  const Frame<S>&a = derived.poses[shapeA.body].frame, &b = derived.poses[shapeB.body].frame;
  const Vector<S> normal = rotate(pair.localNormal, a.rotation);
  const S gap = leastSeparation(pair, normal, a, b);
  if (gap <= kTouching<S>) return Meeting::now;
  // In one substep more than the step has: the last one ends with speeds that hold contacts for another one.
  const S dt = step.dt + step.dt / S(step.state.settings.substeps);
  const auto wayOf = [&](std::uint32_t body) {
    return StepWay<S>::of(step.state.bodies.valueAt(body), step.state.settings.gravity, dt);
  };
  const StepWay<S> wayA = wayOf(shapeA.body), wayB = wayOf(shapeB.body);
  const S turned = wayA.turnedAtMost(shapeA.reach) + wayB.turnedAtMost(shapeB.reach);
  if (dot(wayA.way - wayB.way, normal) + turned <= gap) return Meeting::later;
  const bool met = meets(pair, Approaching<S>{derived.placed[pair.a.index], a, wayA},
                         Approaching<S>{derived.placed[pair.b.index], b, wayB}, normal);
  return met ? Meeting::later : Meeting::none;
}

/// Decides about the pairs that were left for now, in order: handlers see the pairs before theirs decided,
/// those after it not.
/// @param all  whether none was decided
template <Scalar S>
void UpdateContacts<S>::decidePairs(StepContext<S>& step, bool all) {
  const auto decideOne = [&](std::uint32_t i) {
    Pair<S>& pair = step.state.pairs[i];
    // Some contacts at seams are gone.
    if ((found_[i] & ContactFound::kNear) != 0) decide(step, pair);
    if (!hasLeft(pair)) return;
    found_[i] |= ContactFound::kLeft;
    someLeft_ = true;
  };
  if (all) {
    for (std::uint32_t i = 0; i < found_.size(); ++i) {
      if ((i + 1) % Budget::kPairsAtOnce == 0) step.pay(Budget::kPerCall * Budget::kPairsAtOnce);
      decideOne(i);
    }
  } else {
    for (const std::uint32_t i : mendSeams_.asked()) decideOne(i);
  }
}

/// Tells whether a pair touched before and does not now. Of what is solved before it touches, the solver
/// tells whether it did.
template <Scalar S>
bool UpdateContacts<S>::hasLeft(const Pair<S>& pair) {
  return pair.solved == 0 && pair.age != 0 && pair.state != ArbiterState::apart;
}

/// Decides whether a pair is solved.
template <Scalar S>
void UpdateContacts<S>::decide(StepContext<S>& step, Pair<S>& pair) {
  const Derived<S>& derived = step.derived;
  const ShapeTraits<S>&shapeA = derived.traits[pair.a.index], &shapeB = derived.traits[pair.b.index];
  const PlacedPose<S>&bodyA = derived.poses[shapeA.body], &bodyB = derived.poses[shapeB.body];
  const Surface<S>&surfaceA = derived.surfaces[shapeA.surface], &surfaceB = derived.surfaces[shapeB.surface];
  if (shapeA.surface != shapeB.surface && surfaceA.velocity != surfaceB.velocity) {
    takeSurfaces(pair, surfaceA, surfaceB, rotate(pair.localNormal, bodyA.frame.rotation));
  }
  const bool moves = bodyA.type == BodyType::dynamicBody || bodyB.type == BodyType::dynamicBody;
  const bool solvable = moves && !shapeA.sensor && !shapeB.sensor;
  if (step.isSoft()) {
    const bool handled = !step.state.handlers.empty();
    const bool asked =
        pair.state == ArbiterState::ignored || (handled && ContactCallbacks<S>::mayBeRefused(step, pair));
    if (solvable && !asked) pair.solved = 1;
    // The solver tells, where nobody looks before it is through.
    if (pair.solved != 0 && !handled) return;
    if (!overlaps(pair, bodyA.frame, bodyB.frame)) return;
  }
  touch(step, pair, solvable);
}

/// Takes the shapes of a pair for touching, and asks whether it shall be solved.
template <Scalar S>
void UpdateContacts<S>::touch(StepContext<S>& step, Pair<S>& pair, bool solvable) {
  pair.age = 0;
  const bool wanted = applyCollision(step, pair);
  if (wanted && solvable) {
    pair.solved = 1;
  } else {
    // A pair that is not solved must not come back as an old impulse.
    pair.solved = 0;
    for (Contact<S>& contact : pair.contacts) {
      contact.normalSpeed = contact.tangentSpeed = contact.normalTotal = contact.tangentTotal = S(0);
    }
    if (pair.state != ArbiterState::ignored && pair.state != ArbiterState::firstCollision) {
      pair.state = ArbiterState::normal;
    }
  }
}

template <Scalar S>
void UpdateContacts<S>::settle(StepContext<S>& step) {
  const Derived<S>& derived = step.derived;
  const auto frameOf = [&](ShapeId id) -> const Frame<S>& {
    return derived.poses[derived.traits[id.index].body].frame;
  };
  for (Pair<S>& pair : step.state.pairs) {
    if (pair.solved == 0) continue;
    const bool apart = pair.state == ArbiterState::apart;
    const auto touches = [&] {
      if (wasPushed(pair) || (pair.age == 0 && !apart)) return true;
      return pair.solved != kSolvedApart && overlaps(pair, frameOf(pair.a), frameOf(pair.b));
    };
    if (touches()) {
      noteTouch(pair);
      continue;
    }
    if (apart) continue;
    if (pair.state != ArbiterState::cached) {
      pair.state = ArbiterState::cached;
      ContactCallbacks<S>::separate(step, pair, false);
    }
    if (pair.age >= step.state.settings.collisionPersistence) forgetTouch(pair);
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

/// Tells whether two static shapes that touched while one of them moved still do. Nothing looks for such
/// pairs: they are kept, as they are, for when one moves again.
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
    if (dot(info.points[i].pointB - info.points[i].pointA, info.normal) <= kTouching<S>) return true;
  }
  return false;
}

template <Scalar S>
void UpdateContacts<S>::expirePairs(StepContext<S>& step, const std::uint8_t* overlapping) {
  auto& pairs = step.state.pairs;
  std::size_t firstDropped = pairs.size();
  for (std::size_t i = 0; someLeft_ && i < pairs.size(); ++i) {
    if ((found_[i] & ContactFound::kLeft) == 0) continue;
    Pair<S>& pair = pairs[i];
    if (step.rests(pair) && staysInTouch(step, pair)) continue;
    if (pair.state != ArbiterState::cached) {
      pair.state = ArbiterState::cached;
      ContactCallbacks<S>::separate(step, pair, false);
    }
    if (pair.age < step.state.settings.collisionPersistence) continue;
    if (pair.manifold == Manifold::touching) {
      forgetTouch(pair);
    } else if (overlapping[i] != 0) {
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
