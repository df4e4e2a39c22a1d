// SPDX-License-Identifier: MIT
#include "continuous/stages/stop_at_impacts.h"

#include <algorithm>

#include "base/require_ieee.h"
#include "contacts/push_contacts.h"
#include "contacts/stages/contact_callbacks.h"
#include "dynamics/body_access.h"
#include "narrow_phase/moving_shape.h"

namespace samestep {
namespace {

/// The distance at which bodies are stopped where contacts act before a touch, m.
template <Scalar S>
inline constexpr S kStopDistance = S(0x1p-11);
/// The overlap, m, with which they are stopped where contacts act from a touch on.
template <Scalar S>
inline constexpr S kStopOverlap = S(0x1p-9);

std::uint64_t keyOf(std::uint32_t a, std::uint32_t b) { return std::uint64_t{min(a, b)} << 32 | max(a, b); }

template <class T>
bool holds(const std::vector<T>& list, const T& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

/// Distances at which a pair of shapes counts as having met.
template <Scalar S>
struct StopDistances {
  S overlap;  ///< That is left to contacts: they still push the shapes apart to the side they came from.
  S touch;    ///< A body that comes deeper is stopped where it first came this near.
  /// True if contacts may not act where it is stopped: between shapes too thin to overlap.
  bool holds;

  /// @param own, other  half of what the shapes measure where they are thinnest, m
  /// @param margin      distance from which on contacts act, m
  StopDistances(S own, S other, S margin) : overlap(min(own + other, own + own) * ratio<S>(1, 4)) {
    // What has sunk halfway into a thin wall would be pushed out on its other side.
    if (other > S(0)) overlap = min(overlap, max(other * ratio<S>(1, 2), S(2) * kImpactDistance<S>));
    const bool early = margin >= S(2) * kStopDistance<S>;
    touch = early ? kStopDistance<S> : max(deep(), -min(kStopOverlap<S>, overlap * ratio<S>(1, 2)));
    holds = !early && touch > S(0);
  }
  S deep() const { return kImpactDistance<S> - overlap; }

  /// The impact at which a body is stopped, if it is.
  Impact<S> stop(MovingShape<S>& a, MovingShape<S>& b) const {
    const Impact<S> touches = timeOfImpact(a, b, touch);
    if (!touches.hit) return {};
    if (touches.part > S(0)) return timeOfImpact(a, b, deep()).hit ? touches : Impact<S>{};
    // In touch as it begins: contacts hold it, but for what a spin does in a step; it sinks by little at a
    // time.
    const S begins = touches.there.distance;
    if (holds && begins > S(0)) return touches;
    const S sunk = min(touch, begins) - max(overlap * ratio<S>(1, 4), kImpactDistance<S>);
    if (!timeOfImpact(a, b, min(sunk, deep())).hit) return {};
    return timeOfImpact(a, b, sunk);
  }
};

}  // namespace

template <Scalar S>
bool StopAtImpacts<S>::Hit::isBetterThan(const Hit& before) const {
  if (before.other == kNone || impact.part != before.impact.part) {
    return before.other == kNone || impact.part < before.impact.part;
  }
  return own != before.own ? own < before.own : other < before.other;
}

template <Scalar S>
RigidMotion<S> StopAtImpacts<S>::motionOf(const StepContext<S>& step, std::uint32_t body) const {
  const Body<S>& ended = step.state.bodies.valueAt(body);
  if (step.events.fast.motions[body] == FastBodies<S>::kStays) {
    return {ended.centerOfMass(), ended.worldCenter(), ended.angle(), {}, S(0)};
  }
  const auto& start = step.events.fast.starts[body];
  return {ended.centerOfMass(), start.center, start.angle, ended.worldCenter() - start.center,
          ended.angle() - start.angle};
}

template <Scalar S>
BB<S> StopAtImpacts<S>::sweptBox(const StepContext<S>& step, std::uint32_t shape,
                                 const RigidMotion<S>& motion) const {
  const CircleAround<S>& around = step.derived.around[shape];
  const S reach = length(around.center - motion.pivot) + around.radius + kStopDistance<S>;
  return merge(BB<S>::forCircle(motion.start, reach), BB<S>::forCircle(motion.start + motion.way, reach));
}

template <Scalar S>
void StopAtImpacts<S>::run(StepContext<S>& step) {
  seen_.clear();
  made_.clear();
  const std::vector<std::uint8_t>& motions = step.events.fast.motions;
  if (!step.events.fast.watched) return;
  if (std::find(motions.begin(), motions.end(), FastBodies<S>::kGoesFar) == motions.end()) return;
  step.derived.findKeptApart(step.state);
  takeMovers(step);
  takeSubjects(step);
  for (Subject& subject : subjects_) follow(step, subject);
  apply(step);
  takeBullets(step);
  if (subjects_.empty()) return;
  for (Subject& subject : subjects_) follow(step, subject);
  apply(step);
}

/// Notes what moves by itself.
template <Scalar S>
void StopAtImpacts<S>::takeMovers(StepContext<S>& step) {
  const Derived<S>& derived = step.derived;
  kinematics_.clear();
  dynamics_.clear();
  fastKinematics_.clear();
  for (std::uint32_t i = 0; i < derived.poses.size(); ++i) {
    if (derived.poses[i].type != BodyType::kinematicBody || !step.state.bodies.aliveAt(i)) continue;
    if (derived.firstShape[i] == kNone) continue;
    if (step.events.fast.isFast(i)) fastKinematics_.push_back(i);
    const RigidMotion<S> motion = motionOf(step, i);
    for (std::uint32_t shape = derived.firstShape[i]; shape != kNone; shape = derived.nextShape[shape]) {
      kinematics_.push_back({shape, i, sweptBox(step, shape, motion)});
    }
  }
}

/// True if something fast that moves by itself may pass a body that is not fast: it comes by, and goes
/// farther than the body's room as the body sees it.
template <Scalar S>
bool StopAtImpacts<S>::isOvertaken(StepContext<S>& step, std::uint32_t body) const {
  Derived<S>& derived = step.derived;
  const BodyBulk<S>& bulk = derived.bulkOf(step.state, body);
  const RigidMotion<S> own = motionOf(step, body);
  for (const std::uint32_t other : fastKinematics_) {
    const RigidMotion<S> motion = motionOf(step, other);
    const Vector<S> arm = own.start - motion.start;
    const S turn = abs(motion.turn);
    Vector<S> passing = motion.way - own.way;
    S more = turn * bulk.reach;
    if (turn <= S(1)) {
      passing += perp(arm) * motion.turn;
      more += (abs(arm.x) + abs(arm.y)) * (turn * turn);
    }
    if (turn <= S(1) && abs(passing.x) + abs(passing.y) + more <= bulk.room) continue;
    for (std::uint32_t i = derived.firstShape[body]; i != kNone; i = derived.nextShape[i]) {
      const BB<S> box = inflate(derived.placed[i].box, bulk.room);
      for (const Mover& mover : kinematics_) {
        if (mover.body == other && intersects(mover.around, box)) return true;
      }
    }
  }
  return false;
}

/// Notes what is followed in the first pass: what contacts move and went far, and what was overtaken.
template <Scalar S>
void StopAtImpacts<S>::takeSubjects(StepContext<S>& step) {
  const Derived<S>& derived = step.derived;
  subjects_.clear();
  for (std::uint32_t i = 0; i < derived.poses.size(); ++i) {
    if (derived.poses[i].type != BodyType::dynamicBody || derived.firstShape[i] == kNone) continue;
    // Sleepers stay where they are.
    if (step.events.fast.motions[i] == FastBodies<S>::kStays) continue;
    const bool fast = step.events.fast.isFast(i);
    if (!fast && (fastKinematics_.empty() || !isOvertaken(step, i))) continue;
    const Body<S>& body = step.state.bodies.valueAt(i);
    // A body with a function of its own is where that put it.
    if (body.positionFunc() != 0) continue;
    Subject subject;
    subject.body = i;
    subjects_.push_back(subject);
  }
}

/// Notes what is followed in the second pass: bullets, and all that they may meet.
template <Scalar S>
void StopAtImpacts<S>::takeBullets(StepContext<S>& step) {
  const Derived<S>& derived = step.derived;
  subjects_.clear();
  bool anyFast = false;
  for (std::uint32_t i = 0; i < derived.poses.size() && !anyFast; ++i) {
    anyFast = step.events.fast.isFast(i) && derived.poses[i].type == BodyType::dynamicBody;
  }
  if (!anyFast) return;
  BB<S> area;
  for (std::uint32_t i = 0; i < derived.poses.size(); ++i) {
    if (derived.poses[i].type != BodyType::dynamicBody || derived.firstShape[i] == kNone) continue;
    const Body<S>& body = step.state.bodies.valueAt(i);
    if (!body.bullet() || body.positionFunc() != 0) continue;
    if (step.events.fast.motions[i] == FastBodies<S>::kStays) continue;
    const RigidMotion<S> motion = motionOf(step, i);
    for (std::uint32_t shape = derived.firstShape[i]; shape != kNone; shape = derived.nextShape[shape]) {
      const BB<S> box = sweptBox(step, shape, motion);
      area = subjects_.empty() && shape == derived.firstShape[i] ? box : merge(area, box);
    }
    Subject subject;
    subject.body = i;
    subject.isBullet = true;
    subjects_.push_back(subject);
  }
  for (std::uint32_t i = 0; i < derived.poses.size() && !subjects_.empty(); ++i) {
    if (derived.poses[i].type != BodyType::dynamicBody) continue;
    for (std::uint32_t shape = derived.firstShape[i]; shape != kNone; shape = derived.nextShape[shape]) {
      const BB<S> box = sweptBox(step, shape, motionOf(step, i));
      if (intersects(area, box)) dynamics_.push_back({shape, i, box});
    }
  }
}

/// Goes with a body from hit to hit. What it meets holds it from there on: it stays where it is to that, and
/// is taken along by what moves.
template <Scalar S>
void StopAtImpacts<S>::follow(StepContext<S>& step, Subject& subject) {
  ridden_.clear();
  refused_.clear();
  tests_ = 0;
  Leg leg{motionOf(step, subject.body), S(0)};
  for (int rides = 0; rides < kMaxRides;) {
    seenOnLeg_.clear();
    const Hit hit = firstHit(step, subject, leg);
    if (hit.other != kNone && !isAccepted(step, subject, leg, hit)) {
      refused_.push_back(keyOf(hit.own, hit.other));
      continue;
    }
    for (Seen& seen : seenOnLeg_) {
      seen.order = static_cast<std::uint32_t>(seen_.size());
      if (hit.other == kNone || seen.part <= hit.impact.part) seen_.push_back(seen);
    }
    if (hit.other == kNone) {
      if (rides > 0) endAt(step, subject, leg.motion, S(1));
      break;
    }
    ++rides;
    endAt(step, subject, leg.motion, hit.impact.part);
    const std::uint32_t by = step.derived.traits[hit.other].body;
    const Body<S>& carrier = step.state.bodies.valueAt(by);
    const S begins = leg.begins + (S(1) - leg.begins) * hit.impact.part;
    // Two bullets that meet both stop.
    const bool stays = carrier.type() == BodyType::staticBody || (carrier.isDynamic() && carrier.bullet());
    if (stays || begins >= S(1)) break;
    const Transform<S> pose = leg.motion.at(hit.impact.part);
    RigidMotion<S> taken = motionOf(step, by).from(begins);
    taken.pivot = unrotate(taken.start - Vector<S>(pose.tx, pose.ty), Vector<S>(pose.a, pose.b));
    taken.angle = mulAdd(leg.motion.turn, hit.impact.part, leg.motion.angle);
    leg = {taken, begins};
    ridden_.push_back(by);
  }
  step.pay(Budget::kPerPair * tests_);
}

template <Scalar S>
typename StopAtImpacts<S>::Hit StopAtImpacts<S>::firstHit(StepContext<S>& step, const Subject& subject,
                                                          const Leg& leg) {
  const Derived<S>& derived = step.derived;
  Hit first;
  const Vector<S> end = leg.motion.start + leg.motion.way;
  const bool fast = step.events.fast.isFast(subject.body);
  for (std::uint32_t own = derived.firstShape[subject.body]; own != kNone; own = derived.nextShape[own]) {
    const CircleAround<S>& around = derived.around[own];
    const S reach = length(around.center - leg.motion.pivot) + around.radius + kStopDistance<S>;
    derived.staticTree.collectAlong(leg.motion.start, end, reach, found_);
    for (const IndexKey other : found_) meet(step, subject, leg, own, other, first);
    const BB<S> box = sweptBox(step, own, leg.motion);
    for (const Mover& mover : kinematics_) {
      if (intersects(mover.around, box)) meet(step, subject, leg, own, mover.shape, first);
    }
    for (const Mover& mover : dynamics_) {
      if (!intersects(mover.around, box) || (!fast && !step.events.fast.isFast(mover.body))) continue;
      meet(step, subject, leg, own, mover.shape, first);
    }
  }
  return first;
}

/// Finds out whether and when a shape of the body meets another shape, and keeps the first hit of all.
template <Scalar S>
void StopAtImpacts<S>::meet(StepContext<S>& step, const Subject& subject, const Leg& leg, std::uint32_t own,
                            std::uint32_t other, Hit& first) {
  const Derived<S>& derived = step.derived;
  const ShapeTraits<S>&mine = derived.traits[own], &theirs = derived.traits[other];
  if (theirs.body == subject.body || !mayCollide(mine, theirs)) return;
  if (!step.state.joints.empty() && derived.areKeptApart(mine.body, theirs.body)) return;
  if (holds(ridden_, theirs.body) || holds(refused_, keyOf(own, other))) return;
  ++tests_;
  const bool stays = derived.poses[theirs.body].type == BodyType::staticBody;
  MovingShape<S> a(derived.placed[own], leg.motion);
  const auto met = [&](MovingShape<S>& b) {
    if (mine.sensor || theirs.sensor) {
      const Impact<S> impact = timeOfImpact(a, b, S(0));
      // A sensor in touch as the step begins is told by its contact.
      if (!impact.hit || impact.part == S(0)) return;
      const Transform<S> pose = leg.motion.at(impact.part);
      const Frame<S> frame{{pose.tx, pose.ty}, {pose.a, pose.b}};
      const Frame<S>& theirFrame = derived.poses[theirs.body].frame;
      seenOnLeg_.push_back({own, other, 0, impact.part, frame.toLocal(impact.there.pointA),
                            theirFrame.toLocal(impact.there.pointB), impact.there.normal});
      return;
    }
    const StopDistances<S> distances(derived.around[own].thickness, derived.around[other].thickness,
                                     mayBeAsked(step, own, other) ? S(0) : step.pairMargin());
    const Hit hit{own, other, distances.stop(a, b)};
    if (!hit.impact.hit) return;
    if (hit.isBetterThan(first)) first = hit;
  };
  if (stays) {
    MovingShape<S> b(derived.placed[other]);
    met(b);
  } else {
    MovingShape<S> b(derived.placed[other], motionOf(step, theirs.body).from(leg.begins));
    met(b);
  }
}

/// True if handlers are asked about a pair: then its contact acts from a touch on.
template <Scalar S>
bool StopAtImpacts<S>::mayBeAsked(StepContext<S>& step, std::uint32_t a, std::uint32_t b) {
  if (step.state.handlers.empty()) return false;
  Pair<S> pair;
  pair.a = step.state.shapes.idAt(min(a, b));
  pair.b = step.state.shapes.idAt(max(a, b));
  return ContactCallbacks<S>::mayBeRefused(step, pair);
}

/// Finds the pair of two shapes, or makes it; null where there may be no more.
template <Scalar S>
Pair<S>* StopAtImpacts<S>::pairFor(StepContext<S>& step, std::uint32_t a, std::uint32_t b) {
  auto& pairs = step.state.pairs;
  Pair<S> pair;
  pair.a = step.state.shapes.idAt(min(a, b));
  pair.b = step.state.shapes.idAt(max(a, b));
  const auto place = std::lower_bound(pairs.begin(), pairs.end(), pair, Pair<S>::before);
  if (place != pairs.end() && !Pair<S>::before(pair, *place)) return &*place;
  if (pairs.size() >= step.wiring.maxPairs) return nullptr;
  made_.push_back(keyOf(a, b));
  step.derived.bodyPairs.known = false;
  return &*pairs.insert(place, pair);
}

/// Asks the handlers of a hit whether it is one, with the body where it meets the other.
template <Scalar S>
bool StopAtImpacts<S>::isAccepted(StepContext<S>& step, const Subject& subject, const Leg& leg,
                                  const Hit& hit) {
  if (!mayBeAsked(step, hit.own, hit.other)) return true;
  Pair<S>* const pair = pairFor(step, hit.own, hit.other);
  if (pair == nullptr) return true;
  if (pair->state == ArbiterState::ignored) return false;
  // The soft step has asked about it already, if it touched as the step began.
  if (step.isSoft() && pair->age == 0 && ContactCallbacks<S>::hasBegun(*pair)) return pair->solved != 0;

  Body<S>& own = step.state.bodies.valueAt(subject.body);
  const std::uint32_t by = step.derived.traits[hit.other].body;
  Body<S>& other = step.state.bodies.valueAt(by);
  const Body<S> ownBefore = own, otherBefore = other;
  Subject there = subject;
  endAt(step, there, leg.motion, hit.impact.part);
  BodyAccess<S>::setPose(own, there.center, there.angle);
  if (other.type() != BodyType::staticBody) {
    const RigidMotion<S> motion = motionOf(step, by);
    const S part = leg.begins + (S(1) - leg.begins) * hit.impact.part;
    there.body = by;
    endAt(step, there, motion, part);
    BodyAccess<S>::setPose(other, there.center, there.angle);
  }
  const bool ownIsA = hit.own < hit.other;
  const ShapeDistance<S>& at = hit.impact.there;
  CollisionInfo<S> info;
  info.normal = ownIsA ? at.normal : -at.normal;
  info.push(ownIsA ? at.pointA : at.pointB, ownIsA ? at.pointB : at.pointA, 0);
  pushContacts(*pair, info, Frame<S>::of(ownIsA ? own : other), Frame<S>::of(ownIsA ? other : own));
  pair->manifold = Manifold::unknown;
  Derived<S>::takeShapesSurfaces(step.state, *pair);
  pair->age = 0;
  if (pair->state == ArbiterState::apart || pair->state == ArbiterState::cached) {
    pair->state = ArbiterState::firstCollision;
  }
  const bool accepted = ContactCallbacks<S>::ask(step, *pair);
  BodyAccess<S>::setPose(own, ownBefore.worldCenter(), ownBefore.angle());
  BodyAccess<S>::setPose(other, otherBefore.worldCenter(), otherBefore.angle());
  if (!accepted) {
    // An impulse that is not solved must not come back as an old one.
    for (Contact<S>& contact : pair->contacts) contact.normalSpeed = contact.tangentSpeed = S(0);
  }
  return accepted;
}

template <Scalar S>
void StopAtImpacts<S>::endAt(const StepContext<S>& step, Subject& subject, const RigidMotion<S>& motion,
                             S part) const {
  const Transform<S> pose = motion.at(part);
  const Vector<S>& centerOfMass = step.state.bodies.valueAt(subject.body).centerOfMass();
  subject.moved = true;
  subject.center = heldWithin(transformPoint(pose, centerOfMass), step.state.settings.worldExtent);
  subject.angle = clamp(mulAdd(motion.turn, part, motion.angle), -kMaxAngle<S>, kMaxAngle<S>);
}

template <Scalar S>
void StopAtImpacts<S>::apply(StepContext<S>& step) {
  for (const Subject& subject : subjects_) {
    if (!subject.moved) continue;
    BodyAccess<S>::setPose(step.state.bodies.valueAt(subject.body), subject.center, subject.angle);
    step.derived.placeShapesOf(step.state, subject.body);
  }
}

template <Scalar S>
void StopAtImpacts<S>::tellSeen(StepContext<S>& step) {
  // total order: the numbers of those before are unique
  std::sort(seen_.begin(), seen_.end(), [](const Seen& x, const Seen& y) {
    const std::uint64_t first = keyOf(x.a, x.b), second = keyOf(y.a, y.b);
    return first != second ? first < second : x.order < y.order;
  });
  for (const Seen& seen : seen_) {
    Pair<S>* const pair = pairFor(step, seen.a, seen.b);
    if (pair == nullptr || ContactCallbacks<S>::hasBegun(*pair)) continue;
    const bool inOrder = seen.a < seen.b;
    for (Contact<S>& contact : pair->contacts) contact = {};
    pair->contacts[0].anchorA = inOrder ? seen.pointA : seen.pointB;
    pair->contacts[0].anchorB = inOrder ? seen.pointB : seen.pointA;
    const std::uint32_t first = step.derived.traits[min(seen.a, seen.b)].body;
    pair->localNormal =
        unrotate(inOrder ? seen.normal : -seen.normal, step.derived.poses[first].frame.rotation);
    pair->count = 1;
    pair->manifold = Manifold::unknown;
    pair->age = 0;
    pair->state = ArbiterState::firstCollision;
    Derived<S>::takeShapesSurfaces(step.state, *pair);
    if (!step.state.handlers.empty()) ContactCallbacks<S>::ask(step, *pair);
  }
  seen_.clear();
}

template <Scalar S>
void StopAtImpacts<S>::takeBack(StepContext<S>& step) {
  auto& pairs = step.state.pairs;
  const auto isMade = [&](const Pair<S>& pair) { return holds(made_, keyOf(pair.a.index, pair.b.index)); };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), isMade), pairs.end());
  step.derived.bodyPairs.known = false;
  seen_.clear();
  made_.clear();
}

#define SAMESTEP_EACH_SCALAR template class StopAtImpacts<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
