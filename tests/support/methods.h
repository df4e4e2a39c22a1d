// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/settings.h>

namespace samestep {

/// A solver with what it computes in.
struct Method {
  const char* name;
  SolverKind solver;
  ContactPrecision precision;
};
inline constexpr Method kMethods[] = {
    {"accurate", SolverKind::softStep, ContactPrecision::accurate},
    {"fast", SolverKind::softStep, ContactPrecision::fast},
    {"impulses", SolverKind::sequentialImpulses, ContactPrecision::accurate},
};

}  // namespace samestep
