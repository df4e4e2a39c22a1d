// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdint>
#include <vector>

#include <samestep/arbiter.h>
#include <samestep/body.h>
#include <samestep/kernel.h>

#include "base/budget.h"
#include "solver/joints/joint_solver.h"
#include "solver/kernels/contact_block.h"
#include "solver/kernels/soft_units.h"
#include "solver/restitution/restitution.h"
#include "solver/soft_step/block_groups.h"
#include "solver/soft_step/block_memory.h"

namespace samestep {

/// The pairs of a soft step, prepared for the kernels of one kind of numbers, and the substeps.
template <Scalar S, class N>
class BlockSolver {
 public:
  using Numbers = N;

  /// @param memory  room for the blocks, whose content is this solver's from begin() to the end of the step
  explicit BlockSolver(BlockMemory& memory);

  /// @param target  one that is available
  void setKernel(KernelTarget target);
  /// Takes bodies, whose first stands for all that never move, and makes room for the groups, whose blocks
  /// are then to be filled.
  /// @param mostKept  no kept impulse is larger, as a speed of the lighter body, m/s
  /// @return false where the numbers of the step do not fit
  /// @throws Interrupted
  bool begin(const SoftSettings<S>& settings, const std::vector<SoftStart<S>>& starts,
             const std::vector<BlockGroup>& groups, S mostKept, Budget& budget);
  /// The pairs of a block on their way into it.
  struct Taken {
    BlockInput<N> input;
    const Pair<S>* pair[N::kLanes];
    const SoftFrame<S>*a[N::kLanes], *b[N::kLanes];
  };
  /// Readies a block, whose lanes hold anything, for so many pairs.
  void openBlock(std::uint32_t at, int pairs, Taken& taken);
  /// Puts a pair into a lane of a block.
  /// @return false where a number does not fit
  bool addPair(std::uint32_t at, int lane, const Pair<S>& pair, std::uint32_t pairIndex,
               const SoftFrame<S>& a, const SoftFrame<S>& b, bool roundA, bool roundB, Taken& taken);
  /// Prepares the points of a block that has its pairs and gives their kept impulses to the bodies.
  /// @return false where a number does not fit
  bool closeBlock(std::uint32_t at, int pairs, S bounceThreshold, const Taken& taken);
  /// True if any point of the block may bounce; strikes, if any strikes.
  bool bounces(std::uint32_t at) const { return blocks_[at].bounces != 0; }
  bool strikes(std::uint32_t at) const { return blocks_[at].strikes != 0; }
  /// True if any pair of the block is pushed apart.
  bool pushes(std::uint32_t at) const { return blocks_[at].pushed != 0; }
  /// Makes all substeps.
  /// @param strikes  whether any point does: nothing kept from the last step says yet how the blow goes on
  ///                 through a pile, so that springs are solved three times in each substep
  /// @param pushes   whether any pair is pushed apart: overlaps that no weight holds move bodies by
  ///                 velocities that are forgotten at the end of the step, for what springs leave of theirs
  ///                 in a velocity stays there for ever
  /// @param joints   solved before the contacts in each pass, by the thread that calls
  /// @param budget   asked after each pass over the blocks
  /// @return false where a number left the range on the way, or the call shall end: nothing is then worth
  ///         anything
  bool run(bool strikes, bool pushes, JointSolver<S>& joints, Crew& crew, Budget& budget);
  /// After the last one: contacts that struck give back what they took, and so do those that passed on more
  /// than a bounce needs.
  /// @param pairs  with what they kept from the step before
  void bounce(const std::vector<Pair<S>>& pairs, S bounceThreshold, Restitution<S>& restitution);
  SoftMotion<S> motion(std::uint32_t body) const;
  /// Writes the impulses back.
  void store(std::vector<Pair<S>>& pairs, Crew& crew) const;

 private:
  using Block = ContactBlock<N>;
  using Rest = BlockRest<N>;
  using Speed = typename N::Speed;
  static constexpr bool kIntegers = std::derived_from<N, IntegerUnits>;

  void clearLane(std::uint32_t at, int lane, Taken& taken);
  void fillMoments(Block& block, int lane, const Pair<S>& pair, const SoftFrame<S>& a, const SoftFrame<S>& b,
                   BlockInput<N>& in) const;
  void fillPoint(typename BlockInput<N>::Point& to, int lane, const Contact<S>& contact,
                 const SoftFrame<S>& a, const SoftFrame<S>& b) const;
  bool placePoints(std::uint32_t at, int lane, S bounceThreshold, const Taken& taken);
  S bounceOf(Block& block, int lane, int point, S bounceThreshold, const Taken& taken) const;
  void tellKept(std::uint32_t begin, std::uint32_t end);
  void setFriction(Block& block, int lane, S friction);
  void markPushed(Block& block, int lane, const Pair<S>& pair, S overlap) const;
  void addPushes(std::uint32_t begin, std::uint32_t end);
  void showBodies(std::vector<JointBody<S>>& bodies) const;
  bool takeBodies(std::vector<JointBody<S>>& bodies);
  bool startJoints(JointSolver<S>& joints);
  bool relaxJoints(JointSolver<S>& joints);
  void takePushes(std::uint32_t begin, std::uint32_t end);
  void findBounces(std::uint32_t at, const std::vector<Pair<S>>& pairs, S bounceThreshold,
                   Restitution<S>& restitution) const;
  void findOthers(std::uint32_t at, const std::vector<Pair<S>>& pairs, std::size_t& next,
                  Restitution<S>& restitution) const;
  BouncePoint<S> bouncePoint(std::uint32_t at, int lane, int index, const Pair<S>& pair) const;
  void takeBounce(const BouncePoint<S>& point, const Restitution<S>& restitution);
  void tellImpulse(std::uint32_t at, int lane, Pair<S>& pair) const;
  void storeBlock(std::uint32_t at, std::vector<Pair<S>>& pairs) const;

  const SoftSettings<S>* settings_ = nullptr;
  const std::vector<SoftStart<S>>* starts_ = nullptr;
  const std::vector<BlockGroup>* groups_ = nullptr;
  SoftUnits<S, N> units_;
  SoftConstants<N> constants_{};
  SoftPasses<N> passes_;
  std::vector<SoftBody<N>> bodies_;
  std::vector<SoftDrive<N>> drives_;
  std::vector<SoftMarks> marks_;
  /// The velocities of pushing apart; what the bodies' own are while these are added to them.
  std::vector<SoftBody<N>> pushes_;
  /// Inverse moment times mass by the squared radius, of integers, in units of spins.
  std::vector<std::int32_t> moments_;
  BlockMemory* memory_;
  /// Both in the memory, blockCount_ of them.
  Block* blocks_ = nullptr;
  Rest* rests_ = nullptr;
  std::uint32_t blockCount_ = 0;
};

#ifndef SAMESTEP_FIXED_ONLY
extern template class BlockSolver<double, PlainNumbers<double, false>>;
#endif
extern template class BlockSolver<Fixed, PlainNumbers<Fixed, true>>;
extern template class BlockSolver<Fixed, WideNumbers>;
extern template class BlockSolver<Fixed, FastNumbers>;
#ifndef SAMESTEP_NO_CHECKED
extern template class BlockSolver<CheckedFixed, PlainNumbers<CheckedFixed, true>>;
extern template class BlockSolver<CheckedFixed, WideNumbers>;
extern template class BlockSolver<CheckedFixed, FastNumbers>;
#endif

}  // namespace samestep
