// SPDX-License-Identifier: MIT
#pragma once

#include "contact_block.h"

/// The pass over contact blocks, written once for every kernel. `L` says what a group of lanes is: its vector
/// V of kWidth numbers T and the operations on it. All of it has internal linkage, since each kernel is built
/// with flags of its own.
namespace samestep {
namespace {

/// Three numbers of a body, of each lane.
template <class L>
struct LaneMotion {
  typename L::V x, y, turn;
};

/// One pair of each lane: friction of all points against the normal impulses so far, then the normals, which
/// have the last word.
template <class L, bool kSprings, class Block>
[[gnu::always_inline]] inline void solveLanes(Block& block, BlockRest<typename L::T>& rest, int lane,
                                              SoftBody<typename L::T>* bodies,
                                              const SoftConstants<typename L::T>& constants) {
  using V = typename L::V;
  LaneMotion<L> velocityA, velocityB, movedA, movedB;
  V bendA, bendB;
  L::gatherVelocity(bodies, block.bodyA + lane, velocityA.x, velocityA.y, velocityA.turn);
  L::gatherVelocity(bodies, block.bodyB + lane, velocityB.x, velocityB.y, velocityB.turn);
  L::gatherMoved(bodies, block.bodyA + lane, movedA.x, movedA.y, movedA.turn, bendA);
  L::gatherMoved(bodies, block.bodyB + lane, movedB.x, movedB.y, movedB.turn, bendB);
  bendA = L::unless(block.roundA, lane, bendA);
  bendB = L::unless(block.roundB, lane, bendB);

  const V nx = L::load(block.normalX + lane);
  const V ny = L::load(block.normalY + lane);
  const V momentA = L::load(block.momentA + lane);
  const V momentB = L::load(block.momentB + lane);
  const V friction = L::load(block.friction + lane);
  const V dx = velocityB.x - velocityA.x;
  const V dy = velocityB.y - velocityA.y;
  V normalSpeed = L::dot2(nx, dx, ny, dy);
  V tangentSpeed = L::cross2(nx, dy, ny, dx) + L::load(block.surface + lane);
  V normalPart = L::zero();
  V tangentPart = L::zero();
  const int points = L::kWidth == 1 ? block.count[lane] : block.points;

  for (int i = 0; i < points; ++i) {
    auto& axis = block.point[i].tangent;
    const V armA = L::load(axis.armA + lane);
    const V armB = L::load(axis.armB + lane);
    const V before = L::load(axis.sum + lane);
    const V limit = friction * L::load(block.point[i].normal.sum + lane);
    const V speed = tangentSpeed + L::cross2(armB, velocityB.turn, armA, velocityA.turn);
    const V sum = L::within(before - L::load(axis.mass + lane) * speed, -limit, limit);
    L::store(axis.sum + lane, sum);
    const V change = sum - before;
    tangentSpeed = tangentSpeed + change;
    tangentPart = tangentPart + change;
    velocityA.turn = velocityA.turn - L::spinA(axis, lane, momentA, armA, change);
    velocityB.turn = velocityB.turn + L::spinB(axis, lane, momentB, armB, change);
    L::note("soft step: friction limit", limit);
    L::note("soft step: relative speed", speed);
    if constexpr (!kSprings) {
      L::store(rest.tangentTotal[i] + lane, L::load(rest.tangentTotal[i] + lane) + sum);
    }
  }

  const V apart = L::dot2(nx, movedB.x - movedA.x, ny, movedB.y - movedA.y);
  for (int i = 0; i < points; ++i) {
    auto& axis = block.point[i].normal;
    const V armA = L::load(axis.armA + lane);
    const V armB = L::load(axis.armB + lane);
    const V before = L::load(axis.sum + lane);
    // The arms of the tangent are r . n: how far a bend comes nearer.
    const V separation = L::load(block.point[i].separation + lane) + apart +
                         L::dotOf4(armB, movedB.turn, -armA, movedA.turn,  //
                                 L::load(block.point[i].tangent.armA + lane), bendA,
                                 -L::load(block.point[i].tangent.armB + lane), bendB);
    // Not touching yet: may come as near as it is within this substep.
    const V gap = separation * L::all(constants.perSubstep);
    const V speed = normalSpeed + L::cross2(armB, velocityB.turn, armA, velocityA.turn);
    V correction;
    if constexpr (kSprings) {
      const auto soft = L::softness(block.stiff, lane, constants.softness);
      const auto free = separation > L::zero();
      const V push = L::greater(separation * soft.biasRate, L::all(-constants.pushSpeed));
      const V target = L::select(free, gap, push);
      const V full = L::load(axis.mass + lane) * (speed + target);
      correction = L::select(free, full, L::dot2(soft.massScale, full, soft.impulseScale, before));
    } else {
      correction = L::load(axis.mass + lane) * (speed + L::greater(gap, L::zero()));
    }
    const V sum = L::within(before - correction, L::zero(), L::all(constants.mostSum));
    L::store(axis.sum + lane, sum);
    const V change = sum - before;
    normalSpeed = normalSpeed + change;
    normalPart = normalPart + change;
    velocityA.turn = velocityA.turn - L::spinA(axis, lane, momentA, armA, change);
    velocityB.turn = velocityB.turn + L::spinB(axis, lane, momentB, armB, change);
    L::note("soft step: relative speed", speed);
    L::note("soft step: target speed", gap);
    if constexpr (!kSprings) {
      L::store(rest.normalTotal[i] + lane, L::load(rest.normalTotal[i] + lane) + sum);
    }
  }

  const V x = L::cross2(nx, normalPart, ny, tangentPart);
  const V y = L::dot2(ny, normalPart, nx, tangentPart);
  const V shareA = L::load(block.shareA + lane);
  const V shareB = L::all(L::one()) - shareA;
  L::scatterVelocity(bodies, block.bodyA + lane, block.fixedA >> lane, velocityA.x - shareA * x,
                     velocityA.y - shareA * y, velocityA.turn);
  L::scatterVelocity(bodies, block.bodyB + lane, block.fixedB >> lane, velocityB.x + shareB * x,
                     velocityB.y + shareB * y, velocityB.turn);
}

template <class L, bool kSprings, class Block>
void passOver(Block* blocks, BlockRest<typename L::T>* rests, std::uint32_t count,
              SoftBody<typename L::T>* bodies, const SoftConstants<typename L::T>& constants) {
  for (std::uint32_t i = 0; i < count; ++i) {
    for (int lane = 0; lane < kBlockLanes; lane += L::kWidth) {
      if (L::kWidth == 1 && blocks[i].count[lane] == 0) break;
      solveLanes<L, kSprings>(blocks[i], rests[i], lane, bodies, constants);
    }
  }
}

}  // namespace
}  // namespace samestep
