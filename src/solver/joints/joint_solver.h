// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "solver/joints/joint_row.h"
#include "solver/joints/joint_trees.h"
#include "solver/joints/joint_work.h"

namespace samestep {

/// The joints of a step, one after the other by their ids: the order in which joints came does not show, nor
/// does how many workers there are.
template <Scalar S>
class JointSolver {
 public:
  std::vector<JointBody<S>> bodies;

  bool empty() const { return joints_.empty(); }
  std::size_t size() const { return joints_.size(); }
  /// Takes the joints of a world that move something awake, and their bodies.
  void begin(const JointedWorld<S>& world, const JointTiming<S>& timing);
  /// The kept impulses are again what they were when the step began, times a factor.
  void restart(S factor = S(1));
  /// Makes the rows of all joints where the bodies are now.
  void build();
  /// Gives the bodies what joints kept.
  void warmStart();
  /// One pass over all joints.
  /// @param corrects  whether places are corrected, too
  /// @param backward  from the last joint to the first
  void solve(bool corrects, bool backward);
  /// Keeps what the rows have come to.
  void keep();
  /// Adds it to what the joints gave in the step.
  void addTotals();
  /// Writes kept impulses, forces and torques into the world's joints.
  void store(SlotMap<Joint<S>, JointId>& joints) const;

 private:
  std::uint32_t indexOf(std::uint32_t body);
  void takeJoint(std::uint32_t slot);
  void solveJoint(JointWork<S>& joint, bool corrects);

  JointTiming<S> timing_{};
  JointedWorld<S> world_{};
  std::vector<JointWork<S>> joints_;
  std::vector<JointRow<S>> rows_;
  JointTrees<S> trees_;
  // Numbers of the bodies here, by body slot.
  std::vector<std::uint32_t> index_;
};

#define SAMESTEP_EACH_SCALAR extern template class JointSolver<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
