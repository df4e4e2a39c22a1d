// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "solver/kernels/softness.h"
#include "solver/restitution/restitution.h"
#include "solver/soft_step/block_solver.h"

namespace samestep {

/// Small substeps with soft contacts and relaxation: each substep solves all contacts once as damped springs,
/// moves the bodies, then solves them once more without the springs, so that what pushed overlaps apart
/// leaves no speed behind.
/// Sources: M. Macklin et al., "Small Steps in Physics Simulation" (2019); E. Catto, "Soft Constraints" (GDC
/// 2011) and "Solver2D" (box2d.org, 2024).

/// The solvers of a scalar, the first one preferred: where the numbers of a step do not fit one, the next
/// takes the step.
template <Scalar S>
class SoftSolvers {
 public:
  SoftSolvers() = default;
  SoftSolvers(const SoftSolvers&) = delete;
  SoftSolvers& operator=(const SoftSolvers&) = delete;
  /// Starts a step. @param fast  whether 32 bits may do
  void begin(bool fast) { chosen_ = fast ? 0 : 1; }
  /// Falls back to the next one; the last takes everything.
  void fallBack() { ++chosen_; }
  /// Calls the function with the one chosen.
  template <class Function>
  decltype(auto) with(Function&& function) {
    if (chosen_ == 1) [[likely]]
      return function(wide_);
    return chosen_ == 0 ? function(fast_) : function(whole_);
  }
  bool isFast() const { return chosen_ == 0; }
  void setKernel(KernelTarget target) {
    fast_.setKernel(target);
    wide_.setKernel(target);
    whole_.setKernel(target);
  }

 private:
  BlockMemory memory_;
  BlockSolver<S, FastNumbers> fast_{memory_};
  BlockSolver<S, WideNumbers> wide_{memory_};
  BlockSolver<S, PlainNumbers<S, true>> whole_{memory_};
  int chosen_ = 1;
};

#ifndef SAMESTEP_FIXED_ONLY
/// A double gains nothing from less accuracy, and holds every number.
template <>
class SoftSolvers<double> {
 public:
  SoftSolvers() = default;
  SoftSolvers(const SoftSolvers&) = delete;
  SoftSolvers& operator=(const SoftSolvers&) = delete;
  void begin(bool) {}
  void fallBack() {}
  template <class Function>
  decltype(auto) with(Function&& function) {
    return function(solver_);
  }
  bool isFast() const { return true; }
  void setKernel(KernelTarget target) { solver_.setKernel(target); }

 private:
  BlockMemory memory_;
  BlockSolver<double, PlainNumbers<double, false>> solver_{memory_};
};
#endif

/// The soft step of a Space, but for what the Space knows.
template <Scalar S>
struct SoftStep {
  SoftSettings<S> settings{};
  /// The bodies that touch something; the first stands for all that never move.
  std::vector<SoftStart<S>> starts;
  /// Frames of every slot of a body; only those of bodies that touch something are of this step.
  std::vector<SoftFrame<S>> frames;
  /// Motions of the bodies that touch nothing, after the step.
  std::vector<SoftMotion<S>> free;
  /// Groups of the blocks, in their order.
  std::vector<BlockGroup> groups;
  /// No kept impulse is larger, as a speed of the lighter body, m/s; asked for where 32 bits are to do.
  S mostKept{};
  /// Marks: any contact may bounce, any strikes, any is pushed apart: see BlockSolver.
  bool bounces = false, strikes = false, pushes = false;
  SoftSolvers<S> solvers;
  Restitution<S> restitution;
  JointSolver<S> joints;

  /// Forgets the last step.
  void clear();
  /// Adds a body that touches something, and says as which.
  std::uint32_t add(const SoftStart<S>& start) {
    starts.push_back(start);
    return static_cast<std::uint32_t>(starts.size() - 1);
  }
  /// Makes the step of a body that touches nothing.
  /// @param pull  its acceleration: x, y, angular
  void addFree(const SoftStart<S>& start, const S (&pull)[3], S dt);
};

#define SAMESTEP_EACH_SCALAR extern template struct SoftStep<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
