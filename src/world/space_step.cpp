// SPDX-License-Identifier: MIT
// The step, stage by stage.
#include <samestep/environment.h>

#include <algorithm>
#include <atomic>

#include "base/require_ieee.h"
#include "contacts/push_contacts.h"
#include "world/space_impl.h"

namespace samestep {

namespace {

/// The largest part of an overlap that goes per second.
template <Scalar S>
inline constexpr S kMaxBiasRate = S(1 << 14);
/// The largest factor by which a longer step enlarges the impulses kept from the last one.
template <Scalar S>
inline constexpr S kMaxStepRatio = S(1 << 10);

template <Scalar S>
S stepRatio(S dt, S before) {
  return dt >= before * kMaxStepRatio<S> ? kMaxStepRatio<S> : dt / before;
}

}  // namespace

template <Scalar S>
void Space<S>::step(S dt) {
  requireUnlocked();
  if (dt == S(0)) return;
  checkStep(dt);

  const S before = state_.timeStep;
  state_.timeStep = dt;
  ++state_.stamp;
  impl_->held.assign(state_.bodies.slots(), 0);
  {
    LockGuard guard(*this);
    // What position functions ask about is the world before any of them moved a body; the soft step begins
    // with it: nothing but what was moved by hand has to be placed.
    const bool soft = state_.settings.solver == SolverKind::softStep;
    if (impl_->leftMidway) impl_->touchAll(state_);
    impl_->leftMidway = true;
    if (soft || !impl_->positionFuncs.empty()) refreshTouched();
    typename Impl::KeepPlaced keep(*impl_);
    if (!soft) {
      if (impl_->mayFindTooMany(state_.shapes.size())) impl_->bodiesBefore = state_.bodies;
      integratePositions(dt);
      updateShapes();
      if (!findPairs()) {
        state_.bodies = impl_->bodiesBefore;
        refusePairs(before);
      }
      collidePairs();
      expirePairs();
      preStep(dt);
      integrateVelocities(dt);
      solve(before == S(0) ? S(0) : stepRatio(dt, before));
    } else {
      impl_->forgetTouched();
      endStage(Stage::updateShapes);
      if (!findPairs()) refusePairs(before);
      collidePairs();
      expirePairs();
      softPreStep(dt);
      softSolve();
      softFinish(dt);
      updateShapes();
    }
    postSolve();
    listRangeEvents();
    keep.end();
    impl_->leftMidway = false;
    guard.finish();
  }
}

/// Ends a step that found too many pairs, with all bodies where they were: it is as if it had not begun.
template <Scalar S>
void Space<S>::refusePairs(S timeStepBefore) {
  state_.timeStep = timeStepBefore;
  --state_.stamp;
  impl_->touchAll(state_);
  impl_->leftMidway = false;
  fail<Fault::TooManyPairs>();
}

template <Scalar S>
void Space<S>::endStage(Stage stage) {
  if (impl_->observer != nullptr) impl_->observer(*this, stage, impl_->observerData);
}

template <Scalar S>
void Space<S>::checkStep(S dt) const {
  requireSoundArithmetic<S>();
  require<Fault::ValueOutOfRange>(dt > S(0) && dt <= kMaxTimeStep<S>);
  for (std::uint32_t i = 0; i < state_.bodies.slots(); ++i) {
    if (!state_.bodies.aliveAt(i)) continue;
    const Body<S>& body = state_.bodies.valueAt(i);
    const char* reason = body.cannotStep();
    if (reason != nullptr) [[unlikely]]
      fail<Fault::IllegalBody>(reason);
    if (body.positionFunc() != 0 || body.velocityFunc() != 0) [[unlikely]]
      requireCallbacks(body);
  }
}

/// Lets a body's own function move it; whatever that did, the body is held within the world.
template <Scalar S>
void Space<S>::callPositionFunc(std::uint32_t index, S dt) {
  Body<S>& body = state_.bodies.valueAt(index);
  const auto* entry = Impl::find(impl_->positionFuncs, body.positionFunc());
  {
    const typename Body<S>::WithinStep within(body, impl_->held[index]);
    entry->function(body, dt, entry->data);
  }
  impl_->held[index] |= body.holdPosition(S(0), worldExtent());
}

template <Scalar S>
void Space<S>::callVelocityFunc(std::uint32_t index, S kept, S dt) {
  Body<S>& body = state_.bodies.valueAt(index);
  const auto* entry = Impl::find(impl_->velocityFuncs, body.velocityFunc());
  {
    const typename Body<S>::WithinStep within(body, impl_->held[index]);
    entry->function(body, gravity(), kept, dt, entry->data);
  }
  impl_->touch(index);
}

template <Scalar S>
void Space<S>::integratePositions(S dt) {
  for (std::uint32_t i = 0; i < state_.bodies.slots(); ++i) {
    if (!state_.bodies.aliveAt(i)) continue;
    Body<S>& body = state_.bodies.valueAt(i);
    if (body.type() == BodyType::staticBody) continue;
    if (body.positionFunc() != 0) [[unlikely]] {
      callPositionFunc(i, dt);
    } else {
      impl_->held[i] |= body.holdPosition(dt, worldExtent());
    }
  }
  endStage(Stage::integratePositions);
}

template <Scalar S>
void Space<S>::updateShapes() {
  ensureCache();
  impl_->forgetTouched();
  placeAllShapes();
  endStage(Stage::updateShapes);
}

namespace {

template <Scalar S>
Pair<S> newPair(ShapeId a, ShapeId b) {
  Pair<S> pair;
  pair.a = a;
  pair.b = b;
  return pair;
}

}  // namespace

/// Whether two shapes whose boxes overlap may collide at all. MIS: queryReject
template <Scalar S>
[[gnu::always_inline]] inline bool Space<S>::mayCollide(std::uint32_t a, std::uint32_t b) const {
  const ShapeTraits<S>&traitsA = impl_->traits[a], &traitsB = impl_->traits[b];
  return traitsA.body != traitsB.body && accepts(traitsA.filter, traitsB.filter);
}

/// How far apart two boxes may be for their shapes to be a pair, m.
template <Scalar S>
S Space<S>::pairMargin() const {
  return state_.settings.solver == SolverKind::softStep ? state_.settings.contactMargin : S(0);
}

namespace {

/// Of a pair, by which pairs are sorted.
std::uint64_t sortKey(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

/// As intersects with a box grown by a margin, without a branch: for boxes that are near each other, whether
/// they overlap is as good as random.
template <Scalar S>
[[gnu::always_inline]] inline bool nearBoxes(const BB<S>& a, S margin, const BB<S>& b) {
  const BB<S> grown = inflate(a, margin);
  const int across = int{grown.left <= b.right} & int{b.left <= grown.right};
  const int up = int{grown.bottom <= b.top} & int{b.bottom <= grown.top};
  return (across & up) != 0;
}

}  // namespace

// Candidates and pairs are sorted alike and walked side by side. Where a pair goes is known before any is
// moved, so that none moves twice, and none at all in a world at rest.
/// @return false where there would be too many: pairs are as before then
template <Scalar S>
bool Space<S>::findPairs() {
  Impl& impl = *impl_;
  const S margin = pairMargin();
  if (impl.dynamicTree.margin() != margin) {
    impl.dynamicTree.setMargin(margin);
    impl.staticTree.setMargin(margin);
  }
  const std::uint64_t most = Impl::kCandidatesPerPair * impl.maxPairs;
  if (!impl.dynamicTree.updatePairs(most)) {
    // How much room boxes have to move follows from the past; whether a step is refused must not.
    for (std::uint32_t i = 0; i < state_.shapes.slots(); ++i) {
      if (impl.dynamicTree.contains(i)) impl.dynamicTree.update(i, impl.placed[i].box);
    }
    if (!impl.dynamicTree.updatePairs(most)) return false;
  }
  const std::vector<KeyPair>& candidates = impl.dynamicTree.pairs();
  impl.overlapping.resize(state_.pairs.size() + candidates.size());
  impl.newPairs.clear();
  impl.pairRuns.clear();
  typename Impl::PairRun run{0, 0, 0};
  const std::uint32_t count = static_cast<std::uint32_t>(state_.pairs.size());
  // Bytes may be a part of anything: what is not asked for again is not asked for after each of them.
  const Pair<S>* const pairs = state_.pairs.data();
  const PlacedShape<S>* const placed = impl.placed.data();
  std::uint8_t* const overlapping = impl.overlapping.data();
  std::uint32_t old = 0, to = 0;
  const auto beginRun = [&] {
    impl.pairRuns.push_back(run);
    run = {old, old, std::int64_t{to} - old};
  };
  const auto keep = [&](std::uint8_t overlap) {
    if (std::int64_t{to} - old != run.shift) [[unlikely]]
      beginRun();
    run.end = ++old;
    overlapping[to++] = overlap;
  };
  // Its boxes came apart: only a contact that may come back is kept, and one whose end is still to be told.
  const auto leave = [&] {
    const Pair<S>& pair = pairs[old];
    const bool forgotten =
        pair.state == ArbiterState::cached && pair.age + 1 >= collisionPersistence() && !rests(pair);
    if (pair.state == ArbiterState::apart || forgotten) {
      ++old;
    } else {
      keep(0);
    }
  };
  const auto keyOf = [](const Pair<S>& pair) { return sortKey(pair.a.index, pair.b.index); };
  constexpr std::size_t kChunk = 256;
  std::uint64_t close[kChunk];
  for (std::size_t begin = 0; begin < candidates.size(); begin += kChunk) {
    const std::size_t end = min(begin + kChunk, candidates.size());
    std::size_t found = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const auto [a, b] = candidates[i];
      close[found] = sortKey(a, b);
      found += nearBoxes(placed[a].box, margin, placed[b].box) ? 1 : 0;
    }
    for (std::size_t i = 0; i < found; ++i) {
      const std::uint64_t key = close[i];
      const std::uint32_t a = static_cast<std::uint32_t>(key >> 32), b = static_cast<std::uint32_t>(key);
      if (!mayCollide(a, b)) continue;
      while (old < count && keyOf(pairs[old]) < key) leave();
      if (old < count && keyOf(pairs[old]) == key) {
        keep(1);
      } else {
        impl.newPairs.push_back({to, a, b});
        overlapping[to++] = 1;
      }
    }
  }
  while (old < count) leave();
  if (to > impl.maxPairs) return false;
  impl.pairRuns.push_back(run);
  if (to != count || impl.pairRuns.size() > 1 || !impl.newPairs.empty()) impl.threadsKnown = false;
  movePairs(to);
  endStage(Stage::findPairs);
  return true;
}

/// Puts all pairs where findPairs wants them. Their order stays, so one that moves down finds its place free
/// once those below it that move down have moved, and the same upwards.
template <Scalar S>
void Space<S>::movePairs(std::uint32_t count) {
  Impl& impl = *impl_;
  auto& pairs = state_.pairs;
  impl.overlapping.resize(count);
  // Little room to spare: these are the largest records of a world.
  if (count > pairs.capacity()) pairs.reserve(count + count / 8);
  if (count > pairs.size()) pairs.resize(count);
  const auto first = pairs.begin();
  const auto& runs = impl.pairRuns;
  for (auto run = runs.begin(); run != runs.end(); ++run) {
    if (run->shift < 0) std::copy(first + run->from, first + run->end, first + (run->from + run->shift));
  }
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    if (run->shift > 0) {
      std::copy_backward(first + run->from, first + run->end, first + (run->end + run->shift));
    }
  }
  for (const typename Impl::NewPair& fresh : impl.newPairs) {
    pairs[fresh.to] = newPair<S>(state_.shapes.idAt(fresh.a), state_.shapes.idAt(fresh.b));
  }
  pairs.resize(count);
  // As when a world is built.
  if (impl.newPairs.size() > 4096 && impl.newPairs.size() == count) impl.newPairs = {};
}

template <Scalar S>
void Space<S>::collidePairs() {
  Impl& impl = *impl_;
  Crew& crew = impl.crew;
  const std::uint32_t count = static_cast<std::uint32_t>(state_.pairs.size());
  const bool surfacesKnown = impl.surfacesKnown;
  impl.surfacesKnown = false;
  impl.someLeft = false;
  impl.left.resize(count);
  // Handlers are asked in order, and see the pairs before theirs updated, those after it not.
  if (!crew.helpsWith(count, Impl::kFewPairs) || !state_.handlers.empty()) {
    impl.someLeft = collidePairs(0, count, surfacesKnown, collisionStats_);
  } else {
    Finding someLeft;
    std::atomic<std::uint32_t> gjk{0}, gjkToEpa{0}, epa{0};
    const auto add = [](std::atomic<std::uint32_t>& to, std::uint64_t number) {
      if (number != 0) to.fetch_add(static_cast<std::uint32_t>(number), std::memory_order_relaxed);
    };
    crew.during(true, [&] {
      crew.each(count, Impl::kPairGrain, [&](std::uint32_t begin, std::uint32_t end) {
        CollisionStats stats;
        someLeft.note(collidePairs(begin, end, surfacesKnown, stats));
        add(gjk, stats.highGjkIterations);
        add(gjkToEpa, stats.highGjkToEpaIterations);
        add(epa, stats.highEpaIterations);
      });
    });
    impl.someLeft = static_cast<bool>(someLeft);
    collisionStats_.highGjkIterations += gjk;
    collisionStats_.highGjkToEpaIterations += gjkToEpa;
    collisionStats_.highEpaIterations += epa;
  }
  // What callbacks have set is for this step.
  impl.surfacesKnown = state_.handlers.empty();
}

/// Those of a range; without handlers this writes to nothing but these pairs.
/// @return whether any of them touched before and does not now
template <Scalar S>
bool Space<S>::collidePairs(std::uint32_t begin, std::uint32_t end, bool surfacesKnown,
                            CollisionStats& stats) {
  Impl& impl = *impl_;
  bool someLeft = false;
  for (std::uint32_t i = begin; i < end; ++i) {
    Pair<S>& pair = state_.pairs[i];
    if (pair.state == ArbiterState::firstCollision) pair.state = ArbiterState::normal;
    pair.solved = 0;
    if (pair.state != ArbiterState::apart && pair.age != 0xffffffffu) ++pair.age;
    if (impl.overlapping[i] != 0) collidePair(pair, surfacesKnown, stats);
    const bool left = pair.state != ArbiterState::apart && pair.age != 0;
    impl.left[i] = left ? 1 : 0;
    someLeft |= left;
  }
  return someLeft;
}

template <Scalar S>
void Space<S>::collidePair(Pair<S>& pair, bool surfacesKnown, CollisionStats& stats) {
  const Impl& impl = *impl_;
  const ShapeTraits<S>&shapeA = impl.traits[pair.a.index], &shapeB = impl.traits[pair.b.index];
  const PlacedPose<S>&bodyA = impl.poses[shapeA.body], &bodyB = impl.poses[shapeB.body];
  const bool sensor = shapeA.sensor || shapeB.sensor;
  // A circle is collided faster than remembered, and no margin goes round a sensor.
  const bool recycles =
      state_.settings.solver == SolverKind::softStep && !sensor && !shapeA.round && !shapeB.round;
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
    const CollisionInfo<S> info = collide(impl.placed[pair.a.index], impl.placed[pair.b.index],
                                          pair.collisionId, &stats, sensor ? S(0) : pairMargin());
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
  const Surface<S>&surfaceA = impl.surfaces[shapeA.surface], &surfaceB = impl.surfaces[shapeB.surface];
  const bool belt = surfaceA.velocity != surfaceB.velocity;
  if (!same || !surfacesKnown || belt) {
    const Vector<S> normal = belt ? rotate(pair.localNormal, bodyA.frame.rotation) : Vector<S>();
    takeSurfaces(pair, surfaceA, surfaceB, normal);
  }
  const bool wanted = applyCollision(pair);
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

/// Takes over a collision and asks the callbacks. MIS: arbiterUpdate
template <Scalar S>
bool Space<S>::applyCollision(Pair<S>& pair) {
  if (pair.state == ArbiterState::apart || pair.state == ArbiterState::cached) {
    pair.state = ArbiterState::firstCollision;
  }
  if (state_.handlers.empty()) return pair.state != ArbiterState::ignored;
  return askHandlers(pair);
}

/// Whether both bodies are static: such a pair stays as it is.
template <Scalar S>
bool Space<S>::rests(const Pair<S>& pair) const {
  const auto isStatic = [&](ShapeId id) {
    return state_.bodies.valueAt(state_.shapes.valueAt(id.index).body().index).type() == BodyType::staticBody;
  };
  return isStatic(pair.a) && isStatic(pair.b);
}

/// Calls separate where shapes came apart, and forgets contacts that stayed apart too long.
/// MIS: spaceArbiterSetFilter
template <Scalar S>
void Space<S>::expirePairs() {
  Impl& impl = *impl_;
  std::size_t firstDropped = state_.pairs.size();
  for (std::size_t i = 0; impl.someLeft && i < state_.pairs.size(); ++i) {
    if (impl.left[i] == 0) continue;
    Pair<S>& pair = state_.pairs[i];
    if (rests(pair)) continue;
    if (pair.state != ArbiterState::cached) {
      pair.state = ArbiterState::cached;
      callSeparate(pair, false);
    }
    if (pair.age < collisionPersistence()) continue;
    if (impl.overlapping[i] != 0) {
      Pair<S> fresh = newPair<S>(pair.a, pair.b);
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
  if (firstDropped != state_.pairs.size()) {
    std::size_t kept = firstDropped;
    for (std::size_t i = firstDropped; i < state_.pairs.size(); ++i) {
      if (state_.pairs[i].state == ArbiterState::apart && impl.overlapping[i] == 0) continue;
      if (kept != i) state_.pairs[kept] = state_.pairs[i];
      ++kept;
    }
    state_.pairs.resize(kept);
    impl.threadsKnown = false;
  }
  endStage(Stage::collide);
}

namespace {

template <Scalar S>
ImpulseBody<S> velocitiesOf(const Body<S>& body) {
  return {body.velocity(), body.angularVelocity(), body.velocityBias(), body.angularVelocityBias()};
}

}  // namespace

/// Calls visit(pair, solver index of A, of B, body A, body B) for each pair to be solved, in order.
template <Scalar S>
template <class Visit>
void Space<S>::eachSolvedPair(Visit&& visit) {
  Impl& impl = *impl_;
  impl.solverBodies.clear();
  impl.solverIndex.assign(state_.bodies.slots(), Impl::kNone);
  for (const Pair<S>& pair : state_.pairs) {
    if (pair.solved == 0) continue;
    const std::uint32_t a = state_.shapes.valueAt(pair.a.index).body().index;
    const std::uint32_t b = state_.shapes.valueAt(pair.b.index).body().index;
    const std::uint32_t solverA = impl.solverIndexOf(a);
    const std::uint32_t solverB = impl.solverIndexOf(b);
    visit(pair, solverA, solverB, state_.bodies.valueAt(a), state_.bodies.valueAt(b));
  }
}

template <Scalar S>
void Space<S>::preStep(S dt) {
  Impl& impl = *impl_;
  const S remaining = S(1) - pow(collisionBias(), dt);
  const S biasRate = remaining > dt * kMaxBiasRate<S> ? kMaxBiasRate<S> : remaining / dt;
  impl.solver.rows.clear();
  impl.solver.bodies.clear();
  eachSolvedPair(
      [&](const Pair<S>& pair, std::uint32_t indexA, std::uint32_t indexB, const Body<S>& a,
          const Body<S>& b) { impl.solver.preStep(pair, indexA, indexB, a, b, collisionSlop(), biasRate); });
  endStage(Stage::preStep);
}

template <Scalar S>
void Space<S>::integrateVelocities(S dt) {
  const S kept = damping() == S(1) ? S(1) : pow(damping(), dt);
  const Vector<S> pull = gravity();
  for (std::uint32_t i = 0; i < state_.bodies.slots(); ++i) {
    if (!state_.bodies.aliveAt(i)) continue;
    Body<S>& body = state_.bodies.valueAt(i);
    if (body.type() == BodyType::staticBody) {
      // Nothing moves it, and no function is asked to.
    } else if (body.velocityFunc() != 0) [[unlikely]] {
      callVelocityFunc(i, kept, dt);
    } else if (body.isDynamic()) {
      impl_->held[i] |= body.holdVelocity(body.accelerated(pull, kept, dt));
    }
    body.force_ = {};
    body.torque_ = S(0);
  }
  endStage(Stage::integrateVelocities);
}

template <Scalar S>
void Space<S>::solve(S dtCoefficient) {
  Impl& impl = *impl_;
  ImpulseSolver<S>& solver = impl.solver;
  for (const std::uint32_t index : impl.solverBodies) {
    solver.bodies.push_back(velocitiesOf(state_.bodies.valueAt(index)));
  }
  std::size_t next = 0;
  for (const Pair<S>& pair : state_.pairs) {
    if (pair.solved == 0) continue;
    for (int i = 0; i < pair.count; ++i, ++next) {
      if (pair.state != ArbiterState::firstCollision) solver.warmStart(solver.rows[next], dtCoefficient);
    }
  }
  for (int i = 0; i < iterations(); ++i) solver.iterate();

  next = 0;
  for (Pair<S>& pair : state_.pairs) {
    if (pair.solved == 0) continue;
    for (int i = 0; i < pair.count; ++i, ++next) {
      const ImpulseRow<S>& row = solver.rows[next];
      Contact<S>& contact = pair.contacts[i];
      contact.normalSpeed = contact.normalTotal = row.normalSum * row.normalScale;
      contact.tangentSpeed = contact.tangentTotal = row.tangentSum * row.tangentScale;
    }
  }
  for (std::size_t i = 0; i < impl.solverBodies.size(); ++i) {
    const std::uint32_t index = impl.solverBodies[i];
    Body<S>& body = state_.bodies.valueAt(index);
    if (!body.isDynamic()) continue;
    const ImpulseBody<S>& solved = solver.bodies[i];
    impl.held[index] |= body.holdVelocity({solved.velocity, solved.angularVelocity});
    body.velocityBias_ = heldWithin(solved.biasVelocity, kMaxSpeed<S>);
    body.angularVelocityBias_ = clamp(solved.biasAngularVelocity, -kMaxAngularSpeed<S>, kMaxAngularSpeed<S>);
  }
  endStage(Stage::solve);
}

template <Scalar S>
void Space<S>::listRangeEvents() {
  rangeEvents_.clear();
  for (std::uint32_t i = 0; i < impl_->held.size(); ++i) {
    if (impl_->held[i] != 0) [[unlikely]]
      rangeEvents_.push_back({state_.bodies.idAt(i), impl_->held[i]});
  }
  endStage(Stage::callbacks);
}

#ifndef SAMESTEP_FIXED_ONLY
template class Space<double>;
#endif
template class Space<Fixed>;
template class Space<CheckedFixed>;
void file_of::spaceStep() {}

}  // namespace samestep
