// SPDX-License-Identifier: MIT
#include "study/method.h"

#include "base/require_ieee.h"

namespace samestep {
namespace {

constexpr int kIterations[] = {2, 4, 8, 16, 32, 64};
constexpr int kSubsteps[] = {1, 2, 4, 8, 16};
constexpr int kLimitIterations[] = {10, 40};
constexpr int kLimitSubsteps[] = {4, 16};

constexpr Method impulses(const char* name, const char* scalar) {
  return {
      name,        scalar,          SolverKind::sequentialImpulses, ContactPrecision::accurate, "iterations",
      kIterations, kLimitIterations};
}
constexpr Method softStep(const char* name, const char* scalar, ContactPrecision precision) {
  return {name, scalar, SolverKind::softStep, precision, "substeps", kSubsteps, kLimitSubsteps};
}

constexpr Method kMethods[] = {
#ifndef SAMESTEP_FIXED_ONLY
    impulses("double impulses", "double"),
    softStep("double soft step", "double", ContactPrecision::accurate),
#endif
    impulses("fixed impulses", "fixed"),
    softStep("fixed soft step", "fixed", ContactPrecision::accurate),
    softStep("fixed fast soft step", "fixed", ContactPrecision::fast),
};

}  // namespace

std::span<const Method> methods() { return kMethods; }

template <Scalar S>
void useMethod(Space<S>& space, const Method& method, int count) {
  space.setSolver(method.solver);
  space.setPrecision(method.precision);
  if (method.solver == SolverKind::softStep) {
    space.setSubsteps(count);
  } else {
    space.setIterations(count);
  }
}

#ifndef SAMESTEP_FIXED_ONLY
template void useMethod<double>(Space<double>&, const Method&, int);
#endif
template void useMethod<Fixed>(Space<Fixed>&, const Method&, int);

}  // namespace samestep
