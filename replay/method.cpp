// SPDX-License-Identifier: MIT
#include "method.h"

#include "require_ieee.h"

namespace samestep {
namespace {

constexpr int kIterations[] = {2, 4, 8, 16, 32, 64};
constexpr int kSubsteps[] = {1, 2, 4, 8, 16};
constexpr int kLimitIterations[] = {10, 40};
constexpr int kLimitSubsteps[] = {4, 16};

constexpr Method kMethods[] = {
#ifndef SAMESTEP_FIXED_ONLY
    {"double impulses", "double", SolverKind::sequentialImpulses, "iterations", kIterations,
     kLimitIterations},
    {"double soft step", "double", SolverKind::softStep, "substeps", kSubsteps, kLimitSubsteps},
#endif
    {"fixed impulses", "fixed", SolverKind::sequentialImpulses, "iterations", kIterations, kLimitIterations},
    {"fixed soft step", "fixed", SolverKind::softStep, "substeps", kSubsteps, kLimitSubsteps},
};

}  // namespace

std::span<const Method> methods() { return kMethods; }

template <Scalar S>
void useMethod(Space<S>& space, const Method& method, int count) {
  space.setSolver(method.solver);
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
