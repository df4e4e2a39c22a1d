// SPDX-License-Identifier: MIT
// The contacts of a Space: visits, filtering, and wildcard handlers that others call. Included by space.cpp
// alone, which instantiates Space.
#pragma once

#include <samestep/space.h>

#include "base/change.h"
#include "contacts/stages/contact_callbacks.h"
#include "islands/rouse.h"
#include "world/space_parts.h"

namespace samestep {

/// Some pairs of a list, by rising places, and what is done with each.
template <Scalar S, class Visit>
struct PairsToVisit {
  std::vector<Pair<S>>& pairs;
  std::span<const std::uint32_t> places;
  bool all;  ///< Takes all of the list, whatever the places are.
  Visit visit;

  std::size_t count() const { return all ? pairs.size() : places.size(); }
  Pair<S>& at(std::size_t i) const { return pairs[all ? i : places[i]]; }
};

/// Visits those of two lists by rising ids.
template <class A, class B>
void visitBoth(const A& a, const B& b) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < a.count(); ++i) {
    for (; next < b.count() && std::decay_t<decltype(b.at(0))>::before(b.at(next), a.at(i)); ++next) {
      b.visit(b.at(next));
    }
    a.visit(a.at(i));
  }
  for (; next < b.count(); ++next) b.visit(b.at(next));
}

template <Scalar S>
void Space<S>::visitArbiters(const BodyId* of, void (*visit)(Arbiter<S>&, void*), void* data) {
  requireUsable();
  StepContext<S> world = contextOf();
  world.derived.completePairs(state_);
  const auto visitPair = [&](Pair<S>& pair) {
    if (!ContactCallbacks<S>::touching(pair)) return;
    Arbiter<S> arbiter = ContactCallbacks<S>::arbiterOf(world, pair);
    visit(arbiter, data);
  };
  const auto visitResting = [&](Pair<S>& pair) {
    const ArbiterState before = pair.state;
    visitPair(pair);
    // An ignored pair holds nothing.
    if (pair.state != before) Rouse<S>::ends(state_, parts_->derived, pair);
  };
  const bool all = of == nullptr;
  std::span<const std::uint32_t> awake, resting;
  if (!all) {
    awake = parts_->derived.pairsOf(state_, *of);
    resting = parts_->derived.restingPairsOf(state_, *of);
  }
  LockGuard guard(*this);
  visitBoth(PairsToVisit<S, decltype(visitPair)>{state_.pairs, awake, all, visitPair},
            PairsToVisit<S, decltype(visitResting)>{state_.restingPairs, resting, all, visitResting});
  guard.finish();
}

template <Scalar S>
void Space<S>::filterArbiters(BodyId body, ShapeId shape) {
  requireUnlocked();
  state_.bodies.template requireAlive<Fault::BodyNotFound>(body, "Space::filterArbiters");
  if (shape.valid())
    state_.shapes.template requireAlive<Fault::ShapeNotFound>(shape, "Space::filterArbiters");
  require<Fault::ShapeNotFound>(!shape.valid() || state_.shapes.valueAt(shape.index).body() == body,
                                "Space::filterArbiters: shape ", shape, " is not one of body ", body);
  LockGuard guard(*this);
  StepContext<S> world = contextOf();
  Change change(leftMidway_);
  ContactCallbacks<S>::dropPairs(world, body, shape);
  change.done();
  guard.finish();
}

template <Scalar S>
bool Space<S>::callWildcardBeginA(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  return ContactCallbacks<S>::wildcardBegin(world, arbiter, false);
}

template <Scalar S>
bool Space<S>::callWildcardBeginB(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  return ContactCallbacks<S>::wildcardBegin(world, arbiter, true);
}

template <Scalar S>
bool Space<S>::callWildcardPreSolveA(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  return ContactCallbacks<S>::wildcardPreSolve(world, arbiter, false);
}

template <Scalar S>
bool Space<S>::callWildcardPreSolveB(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  return ContactCallbacks<S>::wildcardPreSolve(world, arbiter, true);
}

template <Scalar S>
void Space<S>::callWildcardPostSolveA(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  ContactCallbacks<S>::wildcardPostSolve(world, arbiter, false);
}

template <Scalar S>
void Space<S>::callWildcardPostSolveB(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  ContactCallbacks<S>::wildcardPostSolve(world, arbiter, true);
}

template <Scalar S>
void Space<S>::callWildcardSeparateA(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  ContactCallbacks<S>::wildcardSeparate(world, arbiter, false);
}

template <Scalar S>
void Space<S>::callWildcardSeparateB(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  ContactCallbacks<S>::wildcardSeparate(world, arbiter, true);
}

}  // namespace samestep
