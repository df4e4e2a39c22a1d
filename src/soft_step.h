// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

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

/// Whether the kernels of a scalar keep what saves them a product.
template <Scalar S>
inline constexpr bool kStoresSpins = !ScalarTraits<S>::kCheapProducts;

template <Scalar S>
struct SoftSolver {
  using Block = ContactBlock<S, kStoresSpins<S>>;

  std::vector<SoftBody<S>> bodies;
  std::vector<SoftDrive<S>> drives;
  std::vector<Block> blocks;
  std::vector<BlockRest<S>> rests;
  SoftConstants<S> constants{};
  ContactPasses<S, kStoresSpins<S>> passes;

  SoftSolver();

  /// Adds an empty block.
  void openBlock();
  /// Puts a pair into a lane of the last block and gives its kept impulses to the bodies.
  void addPair(int lane, const Pair<S>& pair, std::uint32_t pairIndex, std::uint32_t indexA,
               std::uint32_t indexB, const Body<S>& a, const Body<S>& b, bool roundA, bool roundB,
               S bounceThreshold);
  /// One substep.
  void step();
  /// After the last one: what bounces.
  void bounce();
  /// Writes the impulses back.
  void store(std::vector<Pair<S>>& pairs) const;

 private:
  void integrateVelocities();
  void integratePositions();
  void pass(ContactPass<S, kStoresSpins<S>> kernel);
};

#ifndef SAMESTEP_FIXED_ONLY
extern template struct SoftSolver<double>;
#endif
extern template struct SoftSolver<Fixed>;
extern template struct SoftSolver<CheckedFixed>;

}  // namespace samestep
