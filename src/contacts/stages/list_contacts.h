// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "context/step_context.h"

namespace samestep {

/// Lists what began to touch, what ceased to and what struck, by comparing the pairs as a step began with
/// those at its end: whoever decides about a pair in between, the lists agree with what handlers are told.
template <Scalar S>
struct ListContacts {
  using Context = StepContext<S>;

  /// Notes what the step begins with.
  static void begin(Context& context);
  /// Notes those that touched of pairs that rested as the step began, and do so no longer.
  static void addBegun(Context& context, const std::vector<Pair<S>>& pairs);
  /// Makes the lists.
  static void finish(Context& context);
  /// Notes the end of a contact between steps.
  static void endBetween(Context& context, const Pair<S>& pair);

 private:
  static void listChanges(Context& context);
  static void listImpact(Context& context, Pair<S>& pair);
};

#define SAMESTEP_EACH_SCALAR extern template struct ListContacts<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
