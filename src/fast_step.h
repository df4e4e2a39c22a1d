// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "soft_step.h"

namespace samestep {

/// The substeps of a prepared solver in integers of 32 bits, for fixed-point numbers: the accuracy of a float
/// at several times the speed of the accurate kernel. Speeds have one unit for the whole step: one fast body
/// coarsens all.
template <class S>
class FastSolver {
 public:
  FastSolver();

  /// @param target  one that is available
  void setKernel(KernelTarget target);
  /// Takes the memory that run needs.
  void makeRoom(const SoftSolver<S>& solver);
  /// Makes all substeps and writes speeds, ways and sums back into the solver.
  /// @return false, and nothing written, where a number does not fit or left the range on the way. Depends on
  ///         nothing but the solver: every kernel gives the same answer.
  bool run(SoftSolver<S>& solver, int substeps, Crew& crew);

 private:
  using Numbers = FastNumbers;
  using Solver = SoftSolver<S>;

  void chooseScales(const Solver& solver, int substeps);
  bool takeConstants(const Solver& solver, int substeps);
  void takeBodies(const Solver& solver, std::uint32_t begin, std::uint32_t end);
  bool takeBlocks(const Solver& solver, std::uint32_t begin, std::uint32_t end);
  bool makeSubsteps(const std::vector<BlockGroup>& groups, int substeps, Crew& crew);
  std::uint64_t integrateVelocities(std::uint32_t begin, std::uint32_t end);
  std::uint64_t integratePositions(std::uint32_t begin, std::uint32_t end);
  void giveBodiesBack(Solver& solver, std::uint32_t begin, std::uint32_t end) const;
  void giveBlocksBack(Solver& solver, std::uint32_t begin, std::uint32_t end) const;

  std::vector<SoftBody<Numbers>> bodies_;
  std::vector<SoftDrive<Numbers>> drives_;
  std::vector<ContactBlock<Numbers>> blocks_;
  std::vector<BlockRest<Numbers>> rests_;
  std::vector<std::uint64_t> reach_;
  std::vector<std::int8_t> radiusBits_;
  SoftConstants<Numbers> constants_{};
  ContactPasses<Numbers> passes_;
  /// Fraction bits of speeds and of ways.
  int speedBits_ = 0;
  int wayBits_ = 0;
};

#ifndef SAMESTEP_FIXED_ONLY
/// A double gains nothing: its kernel is the accurate one.
template <>
class FastSolver<double> {
 public:
  void setKernel(KernelTarget) {}
  void makeRoom(const SoftSolver<double>&) {}
  bool run(SoftSolver<double>& solver, int substeps, Crew& crew) {
    solver.run(substeps, crew);
    return true;
  }
};
#endif

extern template class FastSolver<Fixed>;
extern template class FastSolver<CheckedFixed>;

}  // namespace samestep
