// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "context/step_context.h"
#include "solver/soft_step/contact_groups.h"
#include "solver/soft_step/soft_step.h"

namespace samestep {

/// The stages of the soft step: contacts are put into groups and blocks, substeps made, and what they did
/// brought back to bodies and pairs.
template <Scalar S>
class SoftStages {
 public:
  void setKernel(KernelTarget target) { soft_.solvers.setKernel(target); }
  void prepare(StepContext<S>& step);
  void solve(StepContext<S>& step);
  /// Moves the bodies as the substeps say.
  void finish(StepContext<S>& step);

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  // This bit of solverIndex_ marks a body that touches nothing, by its place among them.
  static constexpr std::uint32_t kFree = 0x80000000u;

  struct SolvedPair {
    std::uint32_t pair;
    std::uint32_t a, b;
    bool roundA, roundB;
  };

  void findGroups(StepContext<S>& step);
  void takeStill(const StepContext<S>& step);
  void findJoints(const StepContext<S>& step);
  void takeBodies(StepContext<S>& step);
  void takeBody(const StepContext<S>& step, std::uint32_t slot, SoftStart<S>& start, const S (&pull)[3]);
  SoftFrame<S> frameOf(const Body<S>& body, std::uint32_t index, int radiusBits) const;
  void takePairs(StepContext<S>& step);
  void layOutBlocks(std::uint32_t lanes);
  template <class Solver>
  bool fillBlocks(StepContext<S>& step, Solver& solver);
  void fetchAhead(const std::vector<Pair<S>>& pairs, std::uint32_t place) const;
  void finish(StepContext<S>& step, std::uint32_t begin, std::uint32_t end);

  SoftStep<S> soft_;
  ContactGroups groups_;
  std::vector<SolvedPair> solvedPairs_;
  // Bodies of them that contacts do not move, each once.
  std::vector<std::uint32_t> unmoved_;
  // Numbers of solvedPairs_, group after group.
  std::vector<std::uint32_t> groupOrder_;
  // Each body slot has an entry.
  std::vector<std::uint32_t> solverIndex_;
};

#define SAMESTEP_EACH_SCALAR extern template class SoftStages<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
