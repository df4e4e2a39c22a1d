// SPDX-License-Identifier: MIT
#include "contacts/stages/contact_callbacks.h"

#include <algorithm>
#include <span>

#include "base/require_ieee.h"
#include "contacts/stages/list_contacts.h"
#include "islands/rouse.h"

namespace samestep {

template <Scalar S>
Arbiter<S> ContactCallbacks<S>::arbiterOf(Context& context, Pair<S>& pair) {
  // Its setters are for one step.
  context.derived.surfacesKnown = false;
  const Shape<S>& shapeA = context.state.shapes.valueAt(pair.a.index);
  const Shape<S>& shapeB = context.state.shapes.valueAt(pair.b.index);
  return {pair, context.state.bodies.valueAt(shapeA.body().index),
          context.state.bodies.valueAt(shapeB.body().index), shapeA, shapeB};
}

/// The handler bound to a pair of types in this order, to a type, or to all; null if none is.
template <Scalar S>
const CollisionHandler<S>* ContactCallbacks<S>::boundHandler(const Context& context,
                                                             HandlerBinding::Kind kind, CollisionType typeA,
                                                             CollisionType typeB) {
  return context.wiring.bound.find(context.wiring.handlers, kind, typeA, typeB);
}

/// Notes one more call of a handler, before it, in a row of them.
template <Scalar S>
void ContactCallbacks<S>::payForCall(Context& context, std::uint32_t& called) {
  if (++called % Budget::kObjectsAtOnce == 0) context.pay(Budget::kPerCall * Budget::kObjectsAtOnce);
}

/// Finds who answers for an arbiter and turns it round where the handler's types say so. Null: the wildcards.
template <Scalar S>
const CollisionHandler<S>* ContactCallbacks<S>::handlerFor(const Context& context, Arbiter<S>& arbiter) {
  using Kind = HandlerBinding::Kind;
  constexpr CollisionType kAny = kWildcardCollisionType;
  // A handler is looked for under two types in this order, or in the other.
  const auto findPair = [&](CollisionType first, CollisionType second, bool turned) {
    const auto* handler = boundHandler(context, Kind::pair, first, second);
    if (handler == nullptr) {
      handler = boundHandler(context, Kind::pair, second, first);
      turned = !turned;
    }
    if (handler != nullptr && turned) arbiter.swapped_ = !arbiter.swapped_;
    return handler;
  };
  const CollisionType a = arbiter.shapeDataA().collisionType();
  const CollisionType b = arbiter.shapeDataB().collisionType();
  if (const auto* handler = findPair(a, b, false)) return handler;
  // The type of the lower id goes before that of the higher.
  if (a != kAny) {
    if (const auto* handler = findPair(a, kAny, false)) return handler;
  }
  if (b != kAny) {
    if (const auto* handler = findPair(b, kAny, true)) return handler;
  }
  return boundHandler(context, Kind::fallback, kAny, kAny);
}

template <Scalar S>
const CollisionHandler<S>* ContactCallbacks<S>::wildcardFor(const Context& context, const Shape<S>& shape) {
  return boundHandler(context, HandlerBinding::Kind::wildcard, shape.collisionType(), kWildcardCollisionType);
}

template <Scalar S>
bool ContactCallbacks<S>::wildcardBegin(Context& context, Arbiter<S>& arbiter, bool ofB) {
  const TurnedRound turned(arbiter, ofB);
  const auto* handler = wildcardFor(context, arbiter.shapeDataA());
  return handler == nullptr || handler->begin == nullptr ||
         handler->begin(arbiter, context.space, handler->data);
}

template <Scalar S>
bool ContactCallbacks<S>::wildcardPreSolve(Context& context, Arbiter<S>& arbiter, bool ofB) {
  const TurnedRound turned(arbiter, ofB);
  const auto* handler = wildcardFor(context, arbiter.shapeDataA());
  return handler == nullptr || handler->preSolve == nullptr ||
         handler->preSolve(arbiter, context.space, handler->data);
}

template <Scalar S>
void ContactCallbacks<S>::wildcardPostSolve(Context& context, Arbiter<S>& arbiter, bool ofB) {
  const TurnedRound turned(arbiter, ofB);
  const auto* handler = wildcardFor(context, arbiter.shapeDataA());
  if (handler != nullptr && handler->postSolve != nullptr) {
    handler->postSolve(arbiter, context.space, handler->data);
  }
}

template <Scalar S>
void ContactCallbacks<S>::wildcardSeparate(Context& context, Arbiter<S>& arbiter, bool ofB) {
  const TurnedRound turned(arbiter, ofB);
  const auto* handler = wildcardFor(context, arbiter.shapeDataA());
  if (handler != nullptr && handler->separate != nullptr) {
    handler->separate(arbiter, context.space, handler->data);
  }
}

template <Scalar S>
bool ContactCallbacks<S>::mayBeRefused(Context& context, Pair<S>& pair) {
  Arbiter<S> arbiter = arbiterOf(context, pair);
  const CollisionHandler<S>* handler = handlerFor(context, arbiter);
  const auto has = [](const CollisionHandler<S>* asked, auto function) {
    return asked != nullptr && asked->*function != nullptr;
  };
  const auto isAsked = [&](auto function) {
    return has(handler, function) || has(wildcardFor(context, arbiter.shapeDataA()), function) ||
           has(wildcardFor(context, arbiter.shapeDataB()), function);
  };
  return isAsked(&CollisionHandler<S>::begin) || isAsked(&CollisionHandler<S>::preSolve);
}

template <Scalar S>
bool ContactCallbacks<S>::ask(Context& context, Pair<S>& pair) {
  Arbiter<S> arbiter = arbiterOf(context, pair);
  const CollisionHandler<S>* handler = handlerFor(context, arbiter);
  // Both wildcards are asked, whatever the first one says.
  const auto begin = [&] {
    if (handler != nullptr && handler->begin != nullptr)
      return handler->begin(arbiter, context.space, handler->data);
    const bool a = wildcardBegin(context, arbiter, false);
    const bool b = wildcardBegin(context, arbiter, true);
    return a && b;
  };
  const auto preSolve = [&] {
    if (handler != nullptr && handler->preSolve != nullptr) {
      return handler->preSolve(arbiter, context.space, handler->data);
    }
    const bool a = wildcardPreSolve(context, arbiter, false);
    const bool b = wildcardPreSolve(context, arbiter, true);
    return a && b;
  };
  if (pair.state == ArbiterState::firstCollision && !begin()) arbiter.ignore();
  return pair.state != ArbiterState::ignored && preSolve() && pair.state != ArbiterState::ignored;
}

template <Scalar S>
void ContactCallbacks<S>::separate(Context& context, Pair<S>& pair, bool removal) {
  if (context.state.handlers.empty()) return;
  // Callbacks set values for the last step in which shapes touch, and that is over; a saved world does not
  // have them.
  if (!removal) Derived<S>::takeShapesSurfaces(context.state, pair);
  Arbiter<S> arbiter = arbiterOf(context, pair);
  arbiter.removal_ = removal;
  const CollisionHandler<S>* handler = handlerFor(context, arbiter);
  if (handler != nullptr && handler->separate != nullptr) {
    handler->separate(arbiter, context.space, handler->data);
  } else {
    wildcardSeparate(context, arbiter, false);
    wildcardSeparate(context, arbiter, true);
  }
}

template <Scalar S>
void ContactCallbacks<S>::postSolve(Context& context) {
  if (context.state.handlers.empty()) return;
  std::uint32_t called = 0;
  for (Pair<S>& pair : context.state.pairs) {
    if (pair.solved == 0 || !touching(pair)) continue;
    payForCall(context, called);
    Arbiter<S> arbiter = arbiterOf(context, pair);
    const CollisionHandler<S>* handler = handlerFor(context, arbiter);
    if (handler != nullptr && handler->postSolve != nullptr) {
      handler->postSolve(arbiter, context.space, handler->data);
    } else {
      wildcardPostSolve(context, arbiter, false);
      wildcardPostSolve(context, arbiter, true);
    }
  }
}

namespace {

/// Takes the pairs of some places, which rise, out of a list for which `meant` is true.
template <Scalar S, class IsMeant>
bool erasePairs(std::vector<Pair<S>>& pairs, std::span<const std::uint32_t> places, IsMeant&& meant) {
  // Pairs between two shapes that go move down together, each once.
  auto to = pairs.end(), from = pairs.begin();
  for (const std::uint32_t index : places) {
    const auto gone = pairs.begin() + static_cast<std::ptrdiff_t>(index);
    if (!meant(*gone)) continue;
    to = to == pairs.end() ? gone : std::copy(from, gone, to);
    from = gone + 1;
  }
  if (to == pairs.end()) return false;
  pairs.erase(std::copy(from, pairs.end(), to), pairs.end());
  return true;
}

}  // namespace

template <Scalar S>
void ContactCallbacks<S>::dropPairs(Context& context, BodyId body, ShapeId shape) {
  WorldState<S>& world = context.state;
  const auto meant = [&](const Pair<S>& pair) {
    return !shape.valid() || pair.a == shape || pair.b == shape;
  };
  context.derived.completePairs(world);
  const std::span<const std::uint32_t> ofBody = context.derived.pairsOf(world, body);
  const std::span<const std::uint32_t> resting = context.derived.restingPairsOf(world, body);
  context.pay(Budget::kPerCandidate * (world.pairs.size() + ofBody.size() + resting.size()));
  std::uint32_t called = 0;
  const auto end = [&](Pair<S>& pair) {
    if (!meant(pair) || !hasBegun(pair)) return;
    payForCall(context, called);
    pair.state = ArbiterState::cached;
    ListContacts<S>::endBetween(context, pair);
    separate(context, pair, true);
  };
  // Both lists rise by ids.
  auto next = resting.begin();
  for (const std::uint32_t index : ofBody) {
    Pair<S>& pair = world.pairs[index];
    while (next != resting.end() && Pair<S>::before(world.restingPairs[*next], pair)) {
      end(world.restingPairs[*next++]);
    }
    end(pair);
  }
  while (next != resting.end()) end(world.restingPairs[*next++]);

  for (const std::uint32_t index : resting) {
    if (meant(world.restingPairs[index])) Rouse<S>::ends(world, context.derived, world.restingPairs[index]);
  }
  if (erasePairs(world.pairs, ofBody, meant)) context.derived.bodyPairs.known = false;
  if (erasePairs(world.restingPairs, resting, meant)) context.derived.restingPairs.known = false;
}

#define SAMESTEP_EACH_SCALAR template struct ContactCallbacks<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
