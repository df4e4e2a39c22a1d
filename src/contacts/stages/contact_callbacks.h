// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "context/step_context.h"

namespace samestep {

/// Callbacks of collisions: handlers of a pair of types, else the wildcards of both.
template <Scalar S>
struct ContactCallbacks {
  using Context = StepContext<S>;

  static bool touching(const Pair<S>& pair) {
    return pair.count > 0 && pair.age == 0 &&
           (pair.state == ArbiterState::firstCollision || pair.state == ArbiterState::normal);
  }
  /// True if anybody is asked whether the pair shall be solved.
  static bool mayBeRefused(Context& context, Pair<S>& pair);
  /// True if begin has been called for a pair, or would have been, and separate has not.
  static bool hasBegun(const Pair<S>& pair) {
    return pair.state != ArbiterState::apart && pair.state != ArbiterState::cached;
  }
  static Arbiter<S> arbiterOf(Context& context, Pair<S>& pair);
  /// Calls begin for a first contact, then preSolve; whether the pair is to be solved.
  static bool ask(Context& context, Pair<S>& pair);
  static void separate(Context& context, Pair<S>& pair, bool removal);
  /// Calls postSolve for all pairs that were solved and touched.
  static void postSolve(Context& context);
  /// Forgets the pairs of a body, or only those of one of its shapes, as if it had never touched anything;
  /// separate is called for each by rising ids, before any is gone. The Space is locked: what the callbacks
  /// want to add or remove has to wait. MIS: arbiterUnthread
  static void dropPairs(Context& context, BodyId body, ShapeId shape);

  // This calls the wildcard handler of the arbiter's A; with `ofB` that of its B, which sees its own shape as
  // A.
  static bool wildcardBegin(Context& context, Arbiter<S>& arbiter, bool ofB);
  static bool wildcardPreSolve(Context& context, Arbiter<S>& arbiter, bool ofB);
  static void wildcardPostSolve(Context& context, Arbiter<S>& arbiter, bool ofB);
  static void wildcardSeparate(Context& context, Arbiter<S>& arbiter, bool ofB);

 private:
  /// Exchanges A and B of an arbiter while it lives, if it is to.
  class TurnedRound {
   public:
    TurnedRound(Arbiter<S>& arbiter, bool turned) : arbiter_(arbiter), turned_(turned) { turn(); }
    ~TurnedRound() { turn(); }
    TurnedRound(const TurnedRound&) = delete;
    TurnedRound& operator=(const TurnedRound&) = delete;

   private:
    void turn() { arbiter_.swapped_ = arbiter_.swapped_ != turned_; }
    Arbiter<S>& arbiter_;
    bool turned_;
  };

  static void payForCall(Context& context, std::uint32_t& called);
  static const CollisionHandler<S>* boundHandler(const Context& context, HandlerBinding::Kind kind,
                                                 CollisionType typeA, CollisionType typeB);
  static const CollisionHandler<S>* handlerFor(const Context& context, Arbiter<S>& arbiter);
  static const CollisionHandler<S>* wildcardFor(const Context& context, const Shape<S>& shape);
};

#define SAMESTEP_EACH_SCALAR extern template struct ContactCallbacks<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
