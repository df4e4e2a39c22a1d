// SPDX-License-Identifier: MIT
// The step, stage by stage.
#include <algorithm>

#include "require_ieee.h"
#include "space_impl.h"

namespace samestep {

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
    // What position functions ask about is the world before any of them moved a body.
    if (!impl_->positionFuncs.empty()) refreshTouched();
    typename Impl::KeepPlaced keep(*impl_);
    integratePositions(dt);
    updateShapes();
    findPairs();
    collidePairs();
    expirePairs();
    preStep(dt);
    integrateVelocities(dt);
    solve(before == S(0) ? S(0) : dt / before);
    postSolve();
    listRangeEvents();
    keep.end();
    guard.finish();
  }
}

template <Scalar S>
void Space<S>::endStage(Stage stage) {
  if (impl_->observer != nullptr) impl_->observer(*this, stage, impl_->observerData);
}

template <Scalar S>
void Space<S>::checkStep(S dt) const {
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

template <Scalar S>
void Space<S>::integratePositions(S dt) {
  for (std::uint32_t i = 0; i < state_.bodies.slots(); ++i) {
    if (!state_.bodies.aliveAt(i)) continue;
    Body<S>& body = state_.bodies.valueAt(i);
    if (body.type() == BodyType::staticBody) continue;
    if (body.positionFunc() != 0) [[unlikely]] {
      const auto* entry = Impl::find(impl_->positionFuncs, body.positionFunc());
      {
        const typename Body<S>::WithinStep within(body, impl_->held[i]);
        entry->function(body, dt, entry->data);
      }
      // Whatever it did, the body is held within the world.
      impl_->held[i] |= body.holdPosition(S(0), worldExtent());
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
  for (std::uint32_t i = 0; i < state_.bodies.slots(); ++i) {
    if (state_.bodies.aliveAt(i)) placeShapesOf(i);
  }
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
bool Space<S>::mayCollide(std::uint32_t a, std::uint32_t b) const {
  const Shape<S>& shapeA = state_.shapes.valueAt(a);
  const Shape<S>& shapeB = state_.shapes.valueAt(b);
  return shapeA.body() != shapeB.body() && accepts(shapeA.filter(), shapeB.filter());
}

template <Scalar S>
void Space<S>::findPairs() {
  Impl& impl = *impl_;
  auto& pairs = state_.pairs;
  impl.nextPairs.clear();
  impl.overlapping.clear();
  // Both lists are sorted; a pair that stays in its place costs no copy until the first one that does not.
  std::size_t old = 0;
  bool copying = false;
  const auto startCopying = [&] {
    if (copying) return;
    copying = true;
    impl.nextPairs.assign(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(old));
  };
  const auto keepTouched = [&](const Pair<S>& pair) {
    // Its boxes came apart: only a contact that may come back is kept.
    if (pair.state == ArbiterState::apart) {
      startCopying();
      ++old;
    } else {
      if (copying) impl.nextPairs.push_back(pair);
      impl.overlapping.push_back(0);
      ++old;
    }
  };
  impl.dynamicTree.updatePairs();
  for (const auto [a, b] : impl.dynamicTree.pairs()) {
    if (!intersects(impl.placed[a].box, impl.placed[b].box) || !mayCollide(a, b)) continue;
    while (old < pairs.size() && std::pair(pairs[old].a.index, pairs[old].b.index) < std::pair(a, b)) {
      keepTouched(pairs[old]);
    }
    if (old < pairs.size() && pairs[old].a.index == a && pairs[old].b.index == b) {
      if (copying) impl.nextPairs.push_back(pairs[old]);
      ++old;
    } else {
      startCopying();
      impl.nextPairs.push_back(newPair<S>(state_.shapes.idAt(a), state_.shapes.idAt(b)));
    }
    impl.overlapping.push_back(1);
  }
  while (old < pairs.size()) keepTouched(pairs[old]);
  if (copying) pairs.swap(impl.nextPairs);
  impl.threadsKnown = false;
  endStage(Stage::findPairs);
}

template <Scalar S>
void Space<S>::collidePairs() {
  for (std::size_t i = 0; i < state_.pairs.size(); ++i) {
    Pair<S>& pair = state_.pairs[i];
    if (pair.state == ArbiterState::firstCollision) pair.state = ArbiterState::normal;
    pair.solved = 0;
    if (impl_->overlapping[i] != 0) collidePair(pair);
  }
}

template <Scalar S>
void Space<S>::collidePair(Pair<S>& pair) {
  const CollisionInfo<S> info =
      collide(impl_->placed[pair.a.index], impl_->placed[pair.b.index], pair.collisionId, &collisionStats_);
  pair.collisionId = info.id;
  if (info.count == 0) return;
  const bool wanted = applyCollision(pair, info);
  pair.stamp = state_.stamp;
  const Shape<S>& shapeA = state_.shapes.valueAt(pair.a.index);
  const Shape<S>& shapeB = state_.shapes.valueAt(pair.b.index);
  const Scaled<S> immovable{};
  const bool moves = state_.bodies.valueAt(shapeA.body().index).inverseMass() != immovable ||
                     state_.bodies.valueAt(shapeB.body().index).inverseMass() != immovable;
  if (wanted && moves && !shapeA.sensor() && !shapeB.sensor()) {
    pair.solved = 1;
  } else {
    // What is not solved must not come back as an old impulse.
    for (Contact<S>& contact : pair.contacts) contact.normalSpeed = contact.tangentSpeed = S(0);
    if (pair.state != ArbiterState::ignored && pair.state != ArbiterState::firstCollision) {
      pair.state = ArbiterState::normal;
    }
  }
}

/// Takes over a collision and asks the callbacks. MIS: arbiterUpdate
template <Scalar S>
bool Space<S>::applyCollision(Pair<S>& pair, const CollisionInfo<S>& info) {
  const Shape<S>& shapeA = state_.shapes.valueAt(pair.a.index);
  const Shape<S>& shapeB = state_.shapes.valueAt(pair.b.index);
  Contact<S> contacts[kMaxContactsPerPair];
  for (int i = 0; i < info.count; ++i) {
    Contact<S>& contact = contacts[i];
    contact.pointA = info.points[i].pointA;
    contact.pointB = info.points[i].pointB;
    contact.feature = info.points[i].hash;
    for (int j = 0; j < pair.count; ++j) {
      if (pair.contacts[j].feature != contact.feature) continue;
      contact.normalSpeed = pair.contacts[j].normalSpeed;
      contact.tangentSpeed = pair.contacts[j].tangentSpeed;
    }
  }
  for (int i = 0; i < kMaxContactsPerPair; ++i) pair.contacts[i] = contacts[i];
  pair.count = static_cast<std::uint8_t>(info.count);
  pair.normal = info.normal;
  pair.elasticity = min(shapeA.elasticity() * shapeB.elasticity(), S(kMaxMaterial));
  pair.friction = min(shapeA.friction() * shapeB.friction(), S(kMaxMaterial));
  const Vector<S> surface = shapeB.surfaceVelocity() - shapeA.surfaceVelocity();
  pair.surfaceVelocity = surface - info.normal * dot(surface, info.normal);
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
  bool dropped = false;
  for (std::size_t i = 0; i < state_.pairs.size(); ++i) {
    Pair<S>& pair = state_.pairs[i];
    if (pair.state == ArbiterState::apart || pair.stamp == state_.stamp || rests(pair)) continue;
    if (pair.state != ArbiterState::cached) {
      pair.state = ArbiterState::cached;
      callSeparate(pair, false);
    }
    if (state_.stamp - pair.stamp < collisionPersistence()) continue;
    if (impl.overlapping[i] != 0) {
      const CollisionId id = pair.collisionId;
      pair = newPair<S>(pair.a, pair.b);
      pair.collisionId = id;
    } else {
      pair.state = ArbiterState::apart;
      dropped = true;
    }
  }
  if (dropped) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < state_.pairs.size(); ++i) {
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
SolverBody<S> velocitiesOf(const Body<S>& body) {
  return {body.velocity(), body.angularVelocity(), body.velocityBias(), body.angularVelocityBias()};
}

}  // namespace

template <Scalar S>
void Space<S>::preStep(S dt) {
  Impl& impl = *impl_;
  const S remaining = S(1) - pow(collisionBias(), dt);
  const S biasRate = min(remaining / dt, S(1 << 14));
  impl.solver.rows.clear();
  impl.solver.bodies.clear();
  impl.solverBodies.clear();
  impl.solverIndex.assign(state_.bodies.slots(), Impl::kNone);
  const auto solverIndexOf = [&](std::uint32_t body) {
    std::uint32_t& index = impl.solverIndex[body];
    if (index == Impl::kNone) {
      index = static_cast<std::uint32_t>(impl.solverBodies.size());
      impl.solverBodies.push_back(body);
      impl.solver.bodies.push_back(velocitiesOf(state_.bodies.valueAt(body)));
    }
    return index;
  };
  for (const Pair<S>& pair : state_.pairs) {
    if (pair.solved == 0) continue;
    const std::uint32_t a = state_.shapes.valueAt(pair.a.index).body().index;
    const std::uint32_t b = state_.shapes.valueAt(pair.b.index).body().index;
    impl.solver.preStep(pair, solverIndexOf(a), solverIndexOf(b), state_.bodies.valueAt(a),
                        state_.bodies.valueAt(b), collisionSlop(), biasRate);
  }
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
      const auto* entry = Impl::find(impl_->velocityFuncs, body.velocityFunc());
      {
        const typename Body<S>::WithinStep within(body, impl_->held[i]);
        entry->function(body, pull, kept, dt, entry->data);
      }
      impl_->touch(i);
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
  ContactSolver<S>& solver = impl.solver;
  for (std::size_t i = 0; i < impl.solverBodies.size(); ++i) {
    solver.bodies[i] = velocitiesOf(state_.bodies.valueAt(impl.solverBodies[i]));
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
      const ContactRow<S>& row = solver.rows[next];
      pair.contacts[i].normalSpeed = row.normalSum * row.normalScale;
      pair.contacts[i].tangentSpeed = row.tangentSum * row.tangentScale;
    }
  }
  for (std::size_t i = 0; i < impl.solverBodies.size(); ++i) {
    const std::uint32_t index = impl.solverBodies[i];
    Body<S>& body = state_.bodies.valueAt(index);
    if (!body.isDynamic()) continue;
    const SolverBody<S>& solved = solver.bodies[i];
    impl.held[index] |= body.holdVelocity({solved.velocity, solved.angularVelocity});
    body.velocityBias_ = solved.biasVelocity;
    body.angularVelocityBias_ = solved.biasAngularVelocity;
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

}  // namespace samestep
