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

  /// Makes all substeps and writes speeds, ways and sums back into the solver.
  /// @return false, and nothing written, where a number does not fit or left the range on the way. Depends on
  ///         nothing but the solver: every kernel gives the same answer.
  bool run(SoftSolver<S>& solver, int substeps);

 private:
  using Numbers = FastNumbers;
  using Solver = SoftSolver<S>;

  void chooseScales(const Solver& solver, int substeps);
  bool takeConstants(const Solver& solver, int substeps);
  void takeBodies(const Solver& solver);
  bool takeBlocks(const Solver& solver);
  bool makeSubsteps(int substeps);
  std::uint64_t integrateVelocities();
  std::uint64_t integratePositions();
  void giveBack(Solver& solver) const;

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

/// A double gains nothing: its kernel is the accurate one.
template <>
class FastSolver<double> {
 public:
  bool run(SoftSolver<double>& solver, int substeps) {
    solver.run(substeps);
    return true;
  }
};

extern template class FastSolver<Fixed>;
extern template class FastSolver<CheckedFixed>;

}  // namespace samestep
