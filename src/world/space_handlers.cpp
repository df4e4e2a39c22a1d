// SPDX-License-Identifier: MIT
// Who is told of collisions: handlers, wildcards, separations.
#include "base/require_ieee.h"
#include "world/space_impl.h"

namespace samestep {

template <Scalar S>
bool Space<S>::touching(const Pair<S>& pair) const {
  return pair.count > 0 && pair.age == 0 &&
         (pair.state == ArbiterState::firstCollision || pair.state == ArbiterState::normal);
}

template <Scalar S>
Arbiter<S> Space<S>::arbiterOf(Pair<S>& pair) {
  // Its setters are for one step.
  impl_->surfacesKnown = false;
  const Shape<S>& shapeA = state_.shapes.valueAt(pair.a.index);
  const Shape<S>& shapeB = state_.shapes.valueAt(pair.b.index);
  return {pair, state_.bodies.valueAt(shapeA.body().index), state_.bodies.valueAt(shapeB.body().index),
          shapeA, shapeB};
}

/// The handler bound to a pair of types in this order, to a type, or to all; null if none is.
template <Scalar S>
const CollisionHandler<S>* Space<S>::boundHandler(HandlerBinding::Kind kind, CollisionType typeA,
                                                  CollisionType typeB) const {
  for (const HandlerBinding& binding : state_.handlers) {
    if (binding.kind == kind && binding.typeA == typeA && binding.typeB == typeB) {
      const auto* entry = Impl::find(impl_->handlers, binding.number);
      return entry == nullptr ? nullptr : &entry->handler;
    }
  }
  return nullptr;
}

/// Finds who answers for an arbiter and turns it round where the handler's types say so. Null: the wildcards.
template <Scalar S>
const CollisionHandler<S>* Space<S>::handlerFor(Arbiter<S>& arbiter) const {
  using Kind = HandlerBinding::Kind;
  const CollisionType a = arbiter.shapeDataA().collisionType();
  const CollisionType b = arbiter.shapeDataB().collisionType();
  if (const auto* handler = boundHandler(Kind::pair, a, b)) return handler;
  if (const auto* handler = boundHandler(Kind::pair, b, a)) {
    arbiter.swapped_ = !arbiter.swapped_;
    return handler;
  }
  return boundHandler(Kind::fallback, kWildcardCollisionType, kWildcardCollisionType);
}

template <Scalar S>
const CollisionHandler<S>* Space<S>::wildcardFor(const Shape<S>& shape) const {
  return boundHandler(HandlerBinding::Kind::wildcard, shape.collisionType(), kWildcardCollisionType);
}

template <Scalar S>
bool Space<S>::callWildcardBeginA(Arbiter<S>& arbiter) {
  const auto* handler = wildcardFor(arbiter.shapeDataA());
  return handler == nullptr || handler->begin == nullptr || handler->begin(arbiter, *this, handler->data);
}

template <Scalar S>
bool Space<S>::callWildcardPreSolveA(Arbiter<S>& arbiter) {
  const auto* handler = wildcardFor(arbiter.shapeDataA());
  return handler == nullptr || handler->preSolve == nullptr ||
         handler->preSolve(arbiter, *this, handler->data);
}

template <Scalar S>
void Space<S>::callWildcardPostSolveA(Arbiter<S>& arbiter) {
  const auto* handler = wildcardFor(arbiter.shapeDataA());
  if (handler != nullptr && handler->postSolve != nullptr) handler->postSolve(arbiter, *this, handler->data);
}

template <Scalar S>
void Space<S>::callWildcardSeparateA(Arbiter<S>& arbiter) {
  const auto* handler = wildcardFor(arbiter.shapeDataA());
  if (handler != nullptr && handler->separate != nullptr) handler->separate(arbiter, *this, handler->data);
}

// B's wildcard sees its own shape as A.

template <Scalar S>
bool Space<S>::callWildcardBeginB(Arbiter<S>& arbiter) {
  const TurnedRound turned(arbiter);
  return callWildcardBeginA(arbiter);
}

template <Scalar S>
bool Space<S>::callWildcardPreSolveB(Arbiter<S>& arbiter) {
  const TurnedRound turned(arbiter);
  return callWildcardPreSolveA(arbiter);
}

template <Scalar S>
void Space<S>::callWildcardPostSolveB(Arbiter<S>& arbiter) {
  const TurnedRound turned(arbiter);
  callWildcardPostSolveA(arbiter);
}

template <Scalar S>
void Space<S>::callWildcardSeparateB(Arbiter<S>& arbiter) {
  const TurnedRound turned(arbiter);
  callWildcardSeparateA(arbiter);
}

/// begin for a first contact, then preSolve; whether the pair is to be solved.
template <Scalar S>
bool Space<S>::askHandlers(Pair<S>& pair) {
  Arbiter<S> arbiter = arbiterOf(pair);
  const CollisionHandler<S>* handler = handlerFor(arbiter);
  // Both wildcards are asked, whatever the first one says.
  const auto begin = [&] {
    if (handler != nullptr && handler->begin != nullptr) return handler->begin(arbiter, *this, handler->data);
    const bool a = callWildcardBeginA(arbiter);
    const bool b = callWildcardBeginB(arbiter);
    return a && b;
  };
  const auto preSolve = [&] {
    if (handler != nullptr && handler->preSolve != nullptr) {
      return handler->preSolve(arbiter, *this, handler->data);
    }
    const bool a = callWildcardPreSolveA(arbiter);
    const bool b = callWildcardPreSolveB(arbiter);
    return a && b;
  };
  if (pair.state == ArbiterState::firstCollision && !begin()) arbiter.ignore();
  return pair.state != ArbiterState::ignored && preSolve() && pair.state != ArbiterState::ignored;
}

template <Scalar S>
void Space<S>::callSeparate(Pair<S>& pair, bool removal) {
  if (state_.handlers.empty()) return;
  Arbiter<S> arbiter = arbiterOf(pair);
  arbiter.removal_ = removal;
  const CollisionHandler<S>* handler = handlerFor(arbiter);
  if (handler != nullptr && handler->separate != nullptr) {
    handler->separate(arbiter, *this, handler->data);
  } else {
    callWildcardSeparateA(arbiter);
    callWildcardSeparateB(arbiter);
  }
}

template <Scalar S>
void Space<S>::postSolve() {
  if (state_.handlers.empty()) return;
  for (Pair<S>& pair : state_.pairs) {
    if (pair.solved == 0) continue;
    Arbiter<S> arbiter = arbiterOf(pair);
    const CollisionHandler<S>* handler = handlerFor(arbiter);
    if (handler != nullptr && handler->postSolve != nullptr) {
      handler->postSolve(arbiter, *this, handler->data);
    } else {
      callWildcardPostSolveA(arbiter);
      callWildcardPostSolveB(arbiter);
    }
  }
}

/// Under a lock: what the callbacks want to add or remove has to wait.
template <Scalar S>
void Space<S>::dropPairs(BodyId body, ShapeId shape) {
  const auto meant = [&](const Pair<S>& pair) {
    const auto is = [&](ShapeId id) {
      return shape.valid() ? id == shape : state_.shapes.valueAt(id.index).body() == body;
    };
    return is(pair.a) || is(pair.b);
  };
  for (Pair<S>& pair : state_.pairs) {
    if (!meant(pair) || pair.state == ArbiterState::apart || pair.state == ArbiterState::cached) continue;
    pair.state = ArbiterState::cached;
    callSeparate(pair, true);
  }
  std::erase_if(state_.pairs, meant);
  impl_->threadsKnown = false;
}

template <Scalar S>
void Space<S>::filterArbiters(BodyId body, ShapeId shape) {
  requireUnlocked();
  require<Fault::BodyNotFound>(contains(body));
  require<Fault::ShapeNotFound>(!shape.valid() ||
                                (contains(shape) && state_.shapes.valueAt(shape.index).body() == body));
  LockGuard guard(*this);
  dropPairs(body, shape);
  guard.finish();
}

#ifndef SAMESTEP_FIXED_ONLY
template class Space<double>;
#endif
template class Space<Fixed>;
template class Space<CheckedFixed>;
void file_of::spaceHandlers() {}

}  // namespace samestep
