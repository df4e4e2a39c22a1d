// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/kernel.h>

#include "block_groups.h"
#include "contact_block.h"
#include "contact_row.h"

namespace samestep {

/// Small substeps with soft contacts and relaxation: each substep solves all contacts once as damped springs,
/// moves the bodies, then solves them once more without the springs, so that what pushed overlaps apart
/// leaves no speed behind.
/// Sources: M. Macklin et al., "Small Steps in Physics Simulation" (2019); E. Catto, "Soft Constraints" (GDC
/// 2011) and "Solver2D" (box2d.org, 2024).

template <Scalar S>
Softness<S> makeSoftness(S hertz, S dampingRatio, S substep);

/// What the solver's blocks hold for a scalar.
template <Scalar S>
using SolverNumbers = PlainNumbers<S, !ScalarTraits<S>::kCheapProducts>;

template <Scalar S>
struct SoftSolver {
  using Numbers = SolverNumbers<S>;
  using Block = ContactBlock<Numbers>;
  using Rest = BlockRest<Numbers>;

  /// Those that touch something; the first stands for all that never move.
  std::vector<SoftBody<Numbers>> bodies;
  std::vector<SoftDrive<Numbers>> drives;
  /// Those that touch nothing, after the step.
  std::vector<SoftBody<Numbers>> freeBodies;
  std::vector<std::uint8_t> freeHeld;
  /// The first blockCount are in use; the rest keep their memory.
  std::vector<Block> blocks;
  std::vector<Rest> rests;
  std::uint32_t blockCount = 0;
  /// Of the blocks, in their order.
  std::vector<BlockGroup> groups;
  /// Whether any contact may bounce.
  bool bounces = false;
  /// Inverse moment times mass of each body, 1/m^2.
  std::vector<S> momentsPerMass;
  SoftConstants<Numbers> constants{};
  ContactPasses<Numbers> passes;

  SoftSolver();

  /// @param target  one that is available
  void setKernel(KernelTarget target);
  /// Forgets the last step.
  void clear();
  /// Adds a body that touches something, and says as which.
  std::uint32_t addBody(const Body<S>& body, const SoftDrive<Numbers>& drive);
  /// Makes all substeps of a body that touches nothing.
  void addFree(const Body<S>& body, const SoftDrive<Numbers>& drive, int substeps);
  /// Makes room for the groups, whose blocks are then to be opened.
  void makeRoom();
  /// Readies a block, whose lanes hold anything.
  void openBlock(std::uint32_t at);
  /// Empties the lanes of a block that hold no pair.
  void closeBlock(std::uint32_t at, int lanes);
  /// Puts a pair into a lane of a block and gives its kept impulses to the bodies.
  void addPair(std::uint32_t at, int lane, const Pair<S>& pair, std::uint32_t pairIndex, std::uint32_t indexA,
               std::uint32_t indexB, const Body<S>& a, const Body<S>& b, bool roundA, bool roundB,
               S bounceThreshold);
  /// Makes all substeps.
  void run(int substeps, Crew& crew);
  /// After the last one: what bounces.
  void bounce();
  /// Writes the impulses back.
  void store(std::vector<Pair<S>>& pairs, Crew& crew) const;

 private:
  void integrateVelocity(SoftBody<Numbers>& body, SoftDrive<Numbers>& drive) const;
  void integratePosition(SoftBody<Numbers>& body) const;
  void pass(ContactPass<Numbers> kernel, Crew& crew);
  void storeBlock(std::uint32_t at, std::vector<Pair<S>>& pairs) const;
};

#ifndef SAMESTEP_FIXED_ONLY
extern template struct SoftSolver<double>;
#endif
extern template struct SoftSolver<Fixed>;
extern template struct SoftSolver<CheckedFixed>;

}  // namespace samestep
