// SPDX-License-Identifier: MIT
#include "fast_step.h"

#include <bit>

#include "kernels/kernels.h"
#include "require_ieee.h"

namespace samestep {
namespace {

constexpr std::int64_t kMost = FastNumbers::kRange - 1;
/// Room that speeds have for growing within the step: contacts push, and a difference is twice as large.
constexpr int kSpareBits = 4;
/// Speeds of less than 1 m/s get no finer.
constexpr int kMostSpeedBits = 26;
/// A step of less than 2^-14 s has no finer ways.
constexpr int kMostWayBits = 14;
constexpr int kLeastRadiusBits = -16, kMostRadiusBits = 24;

ContactPasses<FastNumbers> fastPasses(KernelTarget target) {
  if (target == KernelTarget::avx2 && kernels::fastAvx2 != nullptr) return *kernels::fastAvx2;
  if (target == KernelTarget::neon && kernels::fastNeon != nullptr) return *kernels::fastNeon;
  if (target == KernelTarget::sse42 && kernels::fastSse42 != nullptr) return *kernels::fastSse42;
  return kernels::fastBy1;
}

/// x / 2^bits to nearest, ties away from zero; x * 2^-bits for negative bits, saturated at 2^62.
std::int64_t shifted(std::int64_t x, int bits) {
  if (bits <= 0) {
    const std::int64_t limit = std::int64_t{1} << (62 + bits);
    return clamp(x, -limit, limit) << -bits;
  }
  if (bits > 62) return 0;
  return (x + (std::int64_t{1} << (bits - 1)) - (x < 0)) >> bits;
}

std::int64_t product(std::int64_t a, std::int64_t b, int bits) { return shifted(a * b, bits); }

std::int32_t narrow(std::int64_t x) { return static_cast<std::int32_t>(x); }

/// How many bits the whole part of a Q32.32 has, less than 0 for small ones.
int wholeBits(std::uint64_t raw) { return static_cast<int>(std::bit_width(raw)) - 32; }

bool fits(std::int64_t x) { return x == std::int64_t{narrow(x)}; }

}  // namespace

template <class S>
FastSolver<S>::FastSolver() : passes_(fastPasses(nextBestKernel(KernelTarget::best))) {}

template <class S>
void FastSolver<S>::setKernel(KernelTarget target) {
  passes_ = fastPasses(target);
}

template <class S>
void FastSolver<S>::makeRoom(const Solver& solver) {
  reach_.assign(solver.bodies.size(), 0);
  radiusBits_.resize(solver.bodies.size());
  bodies_.resize(solver.bodies.size());
  drives_.resize(solver.bodies.size());
  blocks_.resize(solver.blockCount);
  rests_.resize(solver.blockCount);
}

template <class S>
bool FastSolver<S>::run(Solver& solver, int substeps, Crew& crew) {
  const auto bodies = static_cast<std::uint32_t>(bodies_.size());
  const auto blocks = static_cast<std::uint32_t>(blocks_.size());
  chooseScales(solver, substeps);
  if (!takeConstants(solver, substeps)) return false;
  crew.each(bodies, kBodyGrain,
            [&](std::uint32_t begin, std::uint32_t end) { takeBodies(solver, begin, end); });
  Finding misfit;
  crew.each(blocks, kBlockGrain,
            [&](std::uint32_t begin, std::uint32_t end) { misfit.note(!takeBlocks(solver, begin, end)); });
  if (misfit || !makeSubsteps(solver.groups, substeps, crew)) return false;
  crew.each(bodies, kBodyGrain,
            [&](std::uint32_t begin, std::uint32_t end) { giveBodiesBack(solver, begin, end); });
  crew.each(blocks, kBlockGrain,
            [&](std::uint32_t begin, std::uint32_t end) { giveBlocksBack(solver, begin, end); });
  return true;
}

template <class S>
void FastSolver<S>::chooseScales(const Solver& solver, int substeps) {
  for (std::uint32_t n = 0; n < solver.blockCount; ++n) {
    const auto& block = solver.blocks[n];
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      for (int i = 0; i < block.count[lane]; ++i) {
        const auto& point = block.point[i];
        reach_[block.bodyA[lane]] |=
            raw::magnitude(point.normal.armA[lane].raw()) | raw::magnitude(point.tangent.armA[lane].raw());
        reach_[block.bodyB[lane]] |=
            raw::magnitude(point.normal.armB[lane].raw()) | raw::magnitude(point.tangent.armB[lane].raw());
      }
    }
  }
  int fastest = 0;
  for (std::size_t i = 0; i < reach_.size(); ++i) {
    const int radius = clamp(wholeBits(reach_[i]), kLeastRadiusBits, kMostRadiusBits);
    radiusBits_[i] = static_cast<std::int8_t>(radius);
    const auto& body = solver.bodies[i];
    const auto& push = solver.drives[i].push;
    const auto most = [&](int k) {
      return raw::magnitude(body.velocity[k].raw()) |
             raw::magnitude(push[k].raw()) * static_cast<std::uint64_t>(substeps);
    };
    fastest = max(fastest, max(wholeBits(most(0) | most(1)), wholeBits(most(2)) + radius));
  }
  // Every magnitude is below twice the power of two that its bits say.
  speedBits_ = min(30 - kSpareBits - fastest, kMostSpeedBits);
}

template <class S>
bool FastSolver<S>::takeConstants(const Solver& solver, int substeps) {
  const auto& from = solver.constants;
  const std::int64_t step = from.substep.raw() * substeps;
  const int finer = clamp(-wholeBits(static_cast<std::uint64_t>(step)), 0, kMostWayBits);
  wayBits_ = speedBits_ + finer;
  const int rateShift = 32 + finer - Numbers::kRateBits;
  const auto unit = [](S x) { return narrow(shifted(x.raw(), 32 - Numbers::kUnitBits)); };
  const auto rate = [&](S x) { return shifted(x.raw(), rateShift); };
  const std::int64_t perSubstep = rate(from.perSubstep);
  if (!fits(perSubstep) || speedBits_ < 1) return false;
  for (int i = 0; i < 2; ++i) {
    const Softness<S>& soft = from.softness[i];
    const std::int64_t biasRate = rate(soft.biasRate);
    if (!fits(biasRate)) return false;
    constants_.softness[i] = {narrow(biasRate), unit(soft.massScale), unit(soft.impulseScale)};
  }
  constants_.substep = narrow(shifted(from.substep.raw(), 32 - finer - Numbers::kUnitBits));
  constants_.perSubstep = narrow(perSubstep);
  constants_.pushSpeed = narrow(min(shifted(from.pushSpeed.raw(), 32 - speedBits_), kMost / 2));
  constants_.mostSum = shifted(from.mostSum.raw(), 32 - speedBits_);
  // What is farther apart is not reached within a substep at any speed in range.
  constants_.mostGap =
      narrow(min((kMost / 2 << Numbers::kRateBits) / max(perSubstep, std::int64_t{1}), kMost));
  return true;
}

template <class S>
void FastSolver<S>::takeBodies(const Solver& solver, std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t i = begin; i < end; ++i) {
    const auto& from = solver.drives[i];
    SoftDrive<Numbers>& drive = drives_[i];
    bodies_[i] = {};
    drive = {};
    for (int k = 0; k < 3; ++k) {
      const int shift = 32 - speedBits_ - (k == 2 ? radiusBits_[i] : 0);
      bodies_[i].velocity[k] = narrow(shifted(solver.bodies[i].velocity[k].raw(), shift));
      drive.push[k] = narrow(shifted(from.push[k].raw(), shift));
      // A kept impulse may be larger than any speed; what does not fit shows in the first pass.
      drive.base[k] = narrow(clamp(shifted(from.base[k].raw(), shift), -kMost, kMost));
    }
    drive.kept = narrow(shifted(from.kept.raw(), 32 - Numbers::kUnitBits));
  }
}

template <class S>
bool FastSolver<S>::takeBlocks(const Solver& solver, std::uint32_t begin, std::uint32_t end) {
  std::int64_t misfit = 0;
  const auto held = [&](std::int64_t x) {
    misfit |= x ^ narrow(x);
    return narrow(x);
  };
  const int unitShift = 32 - Numbers::kUnitBits;
  const int speedShift = 32 - speedBits_;
  const int wayShift = 32 - wayBits_;
  for (std::uint32_t i = begin; i < end; ++i) {
    const auto& from = solver.blocks[i];
    ContactBlock<Numbers>& block = blocks_[i];
    rests_[i] = {};
    block.points = from.points;
    block.fixedA = from.fixedA;
    block.fixedB = from.fixedB;
    block.roundA = from.roundA;
    block.roundB = from.roundB;
    block.stiff = from.stiff;
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      block.bodyA[lane] = from.bodyA[lane];
      block.bodyB[lane] = from.bodyB[lane];
      block.count[lane] = from.count[lane];
      block.normalX[lane] = narrow(shifted(from.normalX[lane].raw(), unitShift));
      block.normalY[lane] = narrow(shifted(from.normalY[lane].raw(), unitShift));
      block.shareA[lane] = narrow(shifted(from.shareA[lane].raw(), unitShift));
      block.friction[lane] = held(shifted(from.friction[lane].raw(), 32 - Numbers::kFrictionBits));
      block.surface[lane] = held(shifted(from.surface[lane].raw(), speedShift));
      const int radiusA = radiusBits_[from.bodyA[lane]];
      const int radiusB = radiusBits_[from.bodyB[lane]];
      const auto take = [&](const auto& axis, BlockAxis<Numbers>& to) {
        to.armA[lane] = narrow(shifted(axis.armA[lane].raw(), unitShift + radiusA));
        to.armB[lane] = narrow(shifted(axis.armB[lane].raw(), unitShift + radiusB));
        to.mass[lane] = narrow(shifted(axis.mass[lane].raw(), unitShift));
        to.sum[lane] = shifted(axis.sum[lane].raw(), speedShift);
        to.spinA[lane] = held(shifted(axis.spinA[lane].raw(), 32 - Numbers::kSpinBits - radiusA));
        to.spinB[lane] = held(shifted(axis.spinB[lane].raw(), 32 - Numbers::kSpinBits - radiusB));
      };
      for (int k = 0; k < 2; ++k) {
        take(from.point[k].normal, block.point[k].normal);
        take(from.point[k].tangent, block.point[k].tangent);
        block.point[k].separation[lane] =
            narrow(clamp(shifted(from.point[k].separation[lane].raw(), wayShift), -kMost, kMost));
      }
    }
  }
  return misfit == 0;
}

template <class S>
bool FastSolver<S>::makeSubsteps(const std::vector<BlockGroup>& groups, int substeps, Crew& crew) {
  const auto count = static_cast<std::uint32_t>(bodies_.size());
  Finding left;
  const auto pass = [&](ContactPass<Numbers> kernel) {
    left.note(passOverGroups(kernel, blocks_, rests_, groups, bodies_, constants_, crew));
  };
  for (int i = 0; i < substeps; ++i) {
    crew.each(count, kBodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
      left.note(integrateVelocities(begin, end) != 0);
    });
    pass(passes_.solve);
    crew.each(count, kBodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
      left.note(integratePositions(begin, end) != 0);
    });
    pass(passes_.relax);
    if (left) return false;
  }
  return true;
}

/// As SoftSolver's.
template <class S>
std::uint64_t FastSolver<S>::integrateVelocities(std::uint32_t begin, std::uint32_t end) {
  std::uint64_t left = 0;
  const std::int64_t mostSpeed = min(shifted(kMaxSpeed<S>.raw(), 32 - speedBits_), kMost);
  for (std::uint32_t i = begin; i < end; ++i) {
    SoftBody<Numbers>& body = bodies_[i];
    SoftDrive<Numbers>& drive = drives_[i];
    const std::int64_t mostTurn =
        min(shifted(kMaxAngularSpeed<S>.raw(), 32 - speedBits_ - radiusBits_[i]), kMost);
    for (int k = 0; k < 3; ++k) {
      const std::int64_t given = std::int64_t{body.velocity[k]} - drive.base[k];
      const std::int64_t limit = k == 2 ? mostTurn : mostSpeed;
      const std::int64_t free = product(body.velocity[k], drive.kept, Numbers::kUnitBits) + drive.push[k];
      const std::int64_t base = clamp(free, -limit, limit);
      if (base != free) [[unlikely]]
        drive.held =
            static_cast<std::uint8_t>(drive.held | (k == 2 ? Body<S>::kHeldSpin : Body<S>::kHeldSpeed));
      const std::int64_t speed = base + given;
      drive.base[k] = narrow(base);
      body.velocity[k] = narrow(speed);
      left |= static_cast<std::uint64_t>(speed + Numbers::kRange) >> 31;
    }
  }
  return left;
}

template <class S>
std::uint64_t FastSolver<S>::integratePositions(std::uint32_t begin, std::uint32_t end) {
  std::uint64_t left = 0;
  for (std::uint32_t i = begin; i < end; ++i) {
    SoftBody<Numbers>& body = bodies_[i];
    for (int k = 0; k < 3; ++k) {
      const std::int64_t way =
          body.moved[k] + product(body.velocity[k], constants_.substep, Numbers::kUnitBits);
      body.moved[k] = narrow(way);
      left |= static_cast<std::uint64_t>(way + Numbers::kRange) >> 31;
    }
    // Half the square of the angle, as a way at the radius.
    const int perRadius = wayBits_ + radiusBits_[i];
    const std::int64_t bend = product(body.moved[2], body.moved[2], perRadius + 1);
    body.moved[3] = narrow(min(bend, min(shifted(1, 3 - perRadius), kMost)));
  }
  return left;
}

template <class S>
void FastSolver<S>::giveBodiesBack(Solver& solver, std::uint32_t begin, std::uint32_t end) const {
  const auto add = [](S& to, std::int64_t raw) { to += S::fromRaw(raw); };
  for (std::uint32_t i = begin; i < end; ++i) {
    auto& body = solver.bodies[i];
    solver.drives[i].held = drives_[i].held;
    for (int k = 0; k < 3; ++k) {
      const int turning = k == 2 ? radiusBits_[i] : 0;
      // What is finer than the unit of this step stays.
      const std::int64_t start = shifted(body.velocity[k].raw(), 32 - speedBits_ - turning);
      add(body.velocity[k], shifted(bodies_[i].velocity[k] - start, speedBits_ + turning - 32));
      body.moved[k] = S::fromRaw(shifted(bodies_[i].moved[k], wayBits_ + turning - 32));
    }
  }
}

template <class S>
void FastSolver<S>::giveBlocksBack(Solver& solver, std::uint32_t begin, std::uint32_t end) const {
  const auto sum = [&](std::int64_t x) { return S::fromRaw(shifted(x, speedBits_ - 32)); };
  for (std::uint32_t i = begin; i < end; ++i) {
    auto& block = solver.blocks[i];
    auto& rest = solver.rests[i];
    for (int k = 0; k < 2; ++k) {
      for (int lane = 0; lane < kBlockLanes; ++lane) {
        block.point[k].normal.sum[lane] = sum(blocks_[i].point[k].normal.sum[lane]);
        block.point[k].tangent.sum[lane] = sum(blocks_[i].point[k].tangent.sum[lane]);
        rest.normalTotal[k][lane] = sum(rests_[i].normalTotal[k][lane]);
        rest.tangentTotal[k][lane] = sum(rests_[i].tangentTotal[k][lane]);
      }
    }
  }
}

template class FastSolver<Fixed>;
template class FastSolver<CheckedFixed>;

}  // namespace samestep
