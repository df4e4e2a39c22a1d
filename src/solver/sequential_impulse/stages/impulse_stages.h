// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "context/step_context.h"
#include "solver/sequential_impulse/sequential_impulse.h"

namespace samestep {

/// The stages of sequential impulses: rows of contacts are made from the world before velocities change, and
/// solved after that.
template <Scalar S>
class ImpulseStages {
 public:
  void prepare(StepContext<S>& step);
  void solve(StepContext<S>& step);

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  std::uint32_t solverIndexOf(std::uint32_t body);
  void takeBodies(const StepContext<S>& step);
  void warmStart(const StepContext<S>& step);
  void storeImpulses(StepContext<S>& step);
  void storeVelocities(StepContext<S>& step);

  ImpulseSolver<S> solver_;
  // Of each body slot, its number among the solver's bodies; and back.
  std::vector<std::uint32_t> solverIndex_;
  std::vector<std::uint32_t> bodies_;
};

#ifndef SAMESTEP_FIXED_ONLY
extern template class ImpulseStages<double>;
#endif
extern template class ImpulseStages<Fixed>;
extern template class ImpulseStages<CheckedFixed>;

}  // namespace samestep
