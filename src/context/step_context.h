// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/state.h>

#include "context/derived.h"
#include "context/step_events.h"
#include "context/wiring.h"
#include "parallel/crew.h"

namespace samestep {

/// Context that every stage of a step works on. A stage keeps what it needs for itself in a type of its own.
template <Scalar S>
struct StepContext {
  Space<S>& space;  ///< Space that callbacks are handed.
  WorldState<S>& state;
  Derived<S>& derived;
  SpaceWiring<S>& wiring;
  Crew& team;
  StepEvents<S>& events;
  bool& leftMidway;  ///< See Change.
  S dt{};            ///< Seconds of this step.
  S dtBefore{};      ///< Time step of the step before; 0 in the first.
  /// Set by a stage that finds more pairs than the Space may hold: the step ends there, as if it had not
  /// begun.
  bool refused = false;

  // Fewer pairs, or bodies, are not worth waking other workers for.
  static constexpr std::uint32_t kFewPairs = 256;
  static constexpr std::uint32_t kFewBodies = 512;
  // A part of the work has so many at least.
  static constexpr std::uint32_t kPairGrain = 32;
  static constexpr std::uint32_t kBodyGrain = 64;

  /// Notes work done, and ends the call where that is wanted. On the thread that made it.
  /// @throws Interrupted
  void pay(std::uint64_t units) { wiring.budget.pay(units); }
  bool isSoft() const { return state.settings.solver == SolverKind::softStep; }
  /// Distance that two boxes may have for their shapes to be a pair, m.
  S pairMargin() const { return isSoft() ? state.settings.contactMargin : S(0); }
  /// True if both bodies of a pair are static: nothing looks for such a pair.
  bool rests(const Pair<S>& pair) const {
    const auto isStatic = [&](ShapeId id) {
      return state.bodies.valueAt(state.shapes.valueAt(id.index).body().index).type() == BodyType::staticBody;
    };
    return isStatic(pair.a) && isStatic(pair.b);
  }
};

}  // namespace samestep
