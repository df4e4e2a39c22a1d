// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <samestep/space.h>

namespace samestep {

/// A way of solving a scene that is compared with others: a line of a chart, and with a count a column of a
/// table of limits.
struct Method {
  const char* name;    ///< Name in charts and tables; no commas.
  const char* scalar;  ///< "double" or "fixed".
  SolverKind solver;
  ContactPrecision precision;
  const char* unit;             ///< Name of what its count counts: "iterations" or "substeps".
  std::span<const int> counts;  ///< Counts that a chart sweeps.
  std::span<const int> limits;  ///< Counts whose limits are looked for: usual, and thorough.
};

/// All methods of this build. A new one is a row of the table behind it.
std::span<const Method> methods();

/// Makes a world solve by the method with `count` iterations or substeps.
/// @throws InvalidIter
template <Scalar S>
void useMethod(Space<S>& space, const Method& method, int count);

/// Calls visit(S()) for the scalar of the method.
template <class Visit>
auto withScalarOf([[maybe_unused]] const Method& method, Visit&& visit) {
#ifndef SAMESTEP_FIXED_ONLY
  if (std::string_view(method.scalar) == "double") return visit(double());
#endif
  return visit(Fixed());
}

#ifndef SAMESTEP_FIXED_ONLY
extern template void useMethod<double>(Space<double>&, const Method&, int);
#endif
extern template void useMethod<Fixed>(Space<Fixed>&, const Method&, int);

}  // namespace samestep
