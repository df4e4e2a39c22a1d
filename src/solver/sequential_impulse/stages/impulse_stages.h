// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "context/step_context.h"
#include "solver/joints/joint_solver.h"
#include "solver/sequential_impulse/sequential_impulse.h"
#include "solver/sequential_impulse/stages/impulse_blows.h"

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
  void pass(StepContext<S>& step);
  void takeBodies(const StepContext<S>& step);
  void prepareJoints(const StepContext<S>& step);
  void buildJoints(const StepContext<S>& step);
  void startJoints();
  void iterateJoints();
  void showBodies();
  void returnBodies();
  void warmStart(const StepContext<S>& step);
  void storeImpulses(StepContext<S>& step);
  void storeVelocities(StepContext<S>& step);

  ImpulseSolver<S> solver_;
  ImpulseBlows<S> blows_;
  JointSolver<S> joints_;
  // The first has a number among the solver's bodies for each body slot; the second leads back.
  std::vector<std::uint32_t> solverIndex_;
  std::vector<std::uint32_t> bodies_;
};

#define SAMESTEP_EACH_SCALAR extern template class ImpulseStages<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
