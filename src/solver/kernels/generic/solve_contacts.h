// SPDX-License-Identifier: MIT
#pragma once

#include "solver/kernels/contact_block.h"

/// The pass over contact blocks, written once for every kernel. `L` says what a group of lanes is: its
/// vectors of kWidth numbers, V of speeds and C of coefficients, and the operations on them. All of it has
/// internal linkage, since each kernel is built with flags of its own.
namespace samestep {
namespace {

/// Three numbers of a body, of each lane: what is made from V, speeds and ways, where C are coefficients.
template <class L>
struct LaneMotion {
  typename L::V x, y, turn;
};

/// Pass over the contacts: with springs before any body moves, with springs, or without them.
enum class Pass { start, solve, relax };

/// One pair of each lane in a pass: its bodies' motions and the impulses so far. With springs friction comes
/// first, against the normal impulses so far, and the normals have the last word; without them friction comes
/// last, against what the normals then are, since it would otherwise be held by impulses that relaxing is
/// about to lower.
/// @tparam kStays  whether there are pairs in the block that springs do not push apart
template <class L, Pass kPass, bool kStays, class N>
struct LanePass {
  using V = typename L::V;
  using C = typename L::C;

  ContactBlock<N>& block;
  BlockRest<N>& rest;
  const int lane;
  SoftBody<N>* const bodies;
  const SoftConstants<N>& constants;
  L& lanes;
  const C nx, ny, friction;
  LaneMotion<L> velocityA, velocityB, movedA, movedB;
  V bendA, bendB, apart;
  V normalSpeed, tangentSpeed, normalPart, tangentPart;
  int points;

  [[gnu::always_inline]] LanePass(ContactBlock<N>& ofBlock, BlockRest<N>& ofRest, int atLane,
                                  SoftBody<N>* ofBodies, const SoftConstants<N>& with, L& in)
      : block(ofBlock),
        rest(ofRest),
        lane(atLane),
        bodies(ofBodies),
        constants(with),
        lanes(in),
        nx(L::coefficient(ofBlock.normalX + atLane)),
        ny(L::coefficient(ofBlock.normalY + atLane)),
        friction(L::coefficient(ofBlock.friction + atLane)) {}

  [[gnu::always_inline]] void gather() {
    L::gatherVelocity(bodies, block.bodyA + lane, velocityA.x, velocityA.y, velocityA.turn);
    L::gatherVelocity(bodies, block.bodyB + lane, velocityB.x, velocityB.y, velocityB.turn);
    const V dx = velocityB.x - velocityA.x;
    const V dy = velocityB.y - velocityA.y;
    normalSpeed = L::dot2(nx, dx, ny, dy);
    tangentSpeed = L::cross2(nx, dy, ny, dx) + L::load(block.surface + lane);
    normalPart = L::zero();
    tangentPart = L::zero();
    points = L::pointsOf(block, lane);
  }

  /// Gathers how far the bodies have moved since the step began.
  [[gnu::always_inline]] void gatherMoved() {
    L::gatherMoved(bodies, block.bodyA + lane, movedA.x, movedA.y, movedA.turn, bendA);
    L::gatherMoved(bodies, block.bodyB + lane, movedB.x, movedB.y, movedB.turn, bendB);
    bendA = L::unless(block.roundA, lane, bendA);
    bendB = L::unless(block.roundB, lane, bendB);
    apart = L::dot2(nx, movedB.x - movedA.x, ny, movedB.y - movedA.y);
  }

  /// Gives the spins of both bodies what a change of an impulse does to them.
  template <class Axis>
  [[gnu::always_inline]] void turn(const Axis& axis, C armA, C armB, V change) {
    velocityA.turn = lanes.checkedTurn(velocityA.turn - L::spinA(block.moments, axis, lane, armA, change));
    velocityB.turn = lanes.checkedTurn(velocityB.turn + L::spinB(block.moments, axis, lane, armB, change));
  }

  /// Solves friction at a point.
  [[gnu::always_inline]] void rub(int i) {
    auto& axis = block.point[i].tangent;
    const C armA = L::coefficient(axis.armA + lane);
    const C armB = L::coefficient(axis.armB + lane);
    const V before = L::load(axis.sum + lane);
    const V limit = L::frictionLimit(block, friction, L::load(block.point[i].normal.sum + lane));
    const V speed = lanes.checked(tangentSpeed + L::cross2(armB, velocityB.turn, armA, velocityA.turn));
    const V sum =
        lanes.checked(L::within(before - L::product(L::coefficient(axis.mass + lane), speed), -limit, limit));
    L::store(axis.sum + lane, sum);
    const V change = lanes.checkedChange(sum - before);
    tangentSpeed = tangentSpeed + change;
    tangentPart = tangentPart + change;
    turn(axis, armA, armB, change);
    L::note("soft step: friction limit", limit);
    L::note("soft step: relative speed", speed);
    if constexpr (kPass == Pass::relax) {
      L::store(rest.tangentTotal[i] + lane, lanes.checkedTotal(L::load(rest.tangentTotal[i] + lane) + sum));
    }
  }

  /// Speed at which a point may still come nearer, or, if not above 0, at which its overlap is to become
  /// less.
  [[gnu::always_inline]] V targetOf(int i, C armA, C armB) {
    if constexpr (kPass == Pass::solve) {
      return L::load(block.point[i].target + lane);
    } else {
      V separation = L::load(block.point[i].separation + lane);
      if constexpr (kPass == Pass::relax) {
        // The arms of the tangent are r . n: how far a bend comes nearer.
        separation = separation + apart +
                     L::crosses(armB, movedB.turn, armA, movedA.turn,  //
                                L::coefficient(block.point[i].tangent.armA + lane), bendA,
                                L::coefficient(block.point[i].tangent.armB + lane), bendB);
      }
      separation = L::near(separation, constants);
      // A point that does not touch yet may come as near as it is within this substep.
      const V gap = L::rate(separation, constants.perSubstep);
      const V apartSpeed =
          L::greater(L::rate(separation, L::softness(block.stiff, lane, constants.softness).biasRate),
                     L::all(-constants.pushSpeed));
      const V target = L::select(L::above(separation, L::zero()), gap, apartSpeed);
      L::store(block.point[i].target + lane, target);
      L::note("soft step: target speed", gap);
      return target;
    }
  }

  /// Impulse that takes the speed of a point to its target.
  [[gnu::always_inline]] V correctionOf(V speed, V target, C mass, V before) {
    if constexpr (kPass == Pass::relax) {
      return L::product(mass, lanes.checked(speed + L::greater(target, L::zero())));
    } else {
      const auto soft = L::softness(block.stiff, lane, constants.softness);
      V wanted = target;
      if constexpr (kStays) wanted = L::greater(target, L::unless(block.stays, lane, target));
      const V full = L::product(mass, lanes.checked(speed + wanted));
      return L::select(L::above(target, L::zero()), full, L::soften(soft, full, before));
    }
  }

  /// Solves the normal of a point.
  [[gnu::always_inline]] void push(int i) {
    auto& axis = block.point[i].normal;
    const C armA = L::coefficient(axis.armA + lane);
    const C armB = L::coefficient(axis.armB + lane);
    const V before = L::load(axis.sum + lane);
    const C mass = L::coefficient(axis.mass + lane);
    const V speed = normalSpeed + L::cross2(armB, velocityB.turn, armA, velocityA.turn);
    const V target = targetOf(i, armA, armB);
    const V correction = correctionOf(speed, target, mass, before);
    const V sum = lanes.checked(L::pushing(before - correction, constants));
    L::store(axis.sum + lane, sum);
    const V change = lanes.checkedChange(sum - before);
    normalSpeed = normalSpeed + change;
    normalPart = normalPart + change;
    turn(axis, armA, armB, change);
    L::note("soft step: relative speed", speed);
    if constexpr (kPass == Pass::relax) {
      L::store(rest.normalTotal[i] + lane, lanes.checkedTotal(L::load(rest.normalTotal[i] + lane) + sum));
    }
  }

  [[gnu::always_inline]] void scatter() {
    const C ax = L::coefficient(block.pushAX + lane);
    const C ay = L::coefficient(block.pushAY + lane);
    const C bx = nx - ax;
    const C by = ny - ay;
    lanes.scatterVelocity(bodies, block.bodyA + lane, block.fixedA >> lane,
                          velocityA.x - L::cross2(ax, normalPart, ay, tangentPart),
                          velocityA.y - L::dot2(ay, normalPart, ax, tangentPart), velocityA.turn);
    lanes.scatterVelocity(bodies, block.bodyB + lane, block.fixedB >> lane,
                          velocityB.x + L::cross2(bx, normalPart, by, tangentPart),
                          velocityB.y + L::dot2(by, normalPart, bx, tangentPart), velocityB.turn);
  }
};

template <class L, Pass kPass, bool kStays, class N = typename L::Numbers>
[[gnu::always_inline]] inline void solveLanes(ContactBlock<N>& block, BlockRest<N>& rest, int lane,
                                              SoftBody<N>* bodies, const SoftConstants<N>& constants,
                                              L& lanes) {
  LanePass<L, kPass, kStays, N> pass(block, rest, lane, bodies, constants, lanes);
  pass.gather();
  if constexpr (kPass == Pass::relax) {
    pass.gatherMoved();
    for (int i = 0; i < pass.points; ++i) pass.push(i);
    for (int i = 0; i < pass.points; ++i) pass.rub(i);
  } else {
    for (int i = 0; i < pass.points; ++i) pass.rub(i);
    for (int i = 0; i < pass.points; ++i) pass.push(i);
  }
  pass.scatter();
}

template <class L, Pass kPass, class N = typename L::Numbers>
std::uint64_t passOver(ContactBlock<N>* blocks, BlockRest<N>* rests, std::uint32_t count, SoftBody<N>* bodies,
                       const SoftConstants<N>& constants) {
  L lanes;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (int lane = 0; lane < N::kLanes; lane += L::kWidth) {
      if (L::kWidth < N::kLanes && blocks[i].count[lane] == 0) break;
      if (kPass != Pass::relax && blocks[i].stays != 0) {
        solveLanes<L, kPass, kPass != Pass::relax>(blocks[i], rests[i], lane, bodies, constants, lanes);
      } else {
        solveLanes<L, kPass, false>(blocks[i], rests[i], lane, bodies, constants, lanes);
      }
    }
  }
  return lanes.left();
}

/// One pair of each lane that is pushed apart: without springs, and with velocities that no body keeps.
template <class L, class N = typename L::Numbers>
[[gnu::always_inline]] inline void pushLanes(const ContactBlock<N>& block, BlockRest<N>& rest, int lane,
                                             SoftBody<N>* bodies, const SoftConstants<N>& constants,
                                             L& lanes) {
  using V = typename L::V;
  using C = typename L::C;
  LaneMotion<L> velocityA, velocityB;
  L::gatherVelocity(bodies, block.bodyA + lane, velocityA.x, velocityA.y, velocityA.turn);
  L::gatherVelocity(bodies, block.bodyB + lane, velocityB.x, velocityB.y, velocityB.turn);
  const C nx = L::coefficient(block.normalX + lane);
  const C ny = L::coefficient(block.normalY + lane);
  V normalSpeed = L::dot2(nx, velocityB.x - velocityA.x, ny, velocityB.y - velocityA.y);
  V normalPart = L::zero();
  const int left = static_cast<std::uint16_t>(~block.pushed);
  const int points = L::pointsOf(block, lane);
  for (int i = 0; i < points; ++i) {
    const auto& axis = block.point[i].normal;
    const C armA = L::coefficient(axis.armA + lane);
    const C armB = L::coefficient(axis.armB + lane);
    const V before = L::load(rest.pushSum[i] + lane);
    const V target = L::load(block.point[i].target + lane);
    const V speed = normalSpeed + L::cross2(armB, velocityB.turn, armA, velocityA.turn);
    const V correction = L::product(L::coefficient(axis.mass + lane), lanes.checked(speed + target));
    const V sum = L::unless(left, lane, lanes.checked(L::pushing(before - correction, constants)));
    L::store(rest.pushSum[i] + lane, sum);
    const V change = lanes.checkedChange(sum - before);
    normalSpeed = normalSpeed + change;
    normalPart = normalPart + change;
    velocityA.turn = lanes.checkedTurn(velocityA.turn - L::spinA(block.moments, axis, lane, armA, change));
    velocityB.turn = lanes.checkedTurn(velocityB.turn + L::spinB(block.moments, axis, lane, armB, change));
    L::note("soft step: relative speed", speed);
  }
  const C ax = L::coefficient(block.pushAX + lane);
  const C ay = L::coefficient(block.pushAY + lane);
  lanes.scatterVelocity(bodies, block.bodyA + lane, block.fixedA >> lane,
                        velocityA.x - L::product(ax, normalPart), velocityA.y - L::product(ay, normalPart),
                        velocityA.turn);
  lanes.scatterVelocity(bodies, block.bodyB + lane, block.fixedB >> lane,
                        velocityB.x + L::product(nx - ax, normalPart),
                        velocityB.y + L::product(ny - ay, normalPart), velocityB.turn);
}

template <class L, class N = typename L::Numbers>
std::uint64_t pushOver(ContactBlock<N>* blocks, BlockRest<N>* rests, std::uint32_t count, SoftBody<N>* bodies,
                       const SoftConstants<N>& constants) {
  L lanes;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (blocks[i].pushed == 0) continue;
    for (int lane = 0; lane < N::kLanes; lane += L::kWidth) {
      if (L::kWidth < N::kLanes && blocks[i].count[lane] == 0) break;
      pushLanes(blocks[i], rests[i], lane, bodies, constants, lanes);
    }
  }
  return lanes.left();
}

}  // namespace
}  // namespace samestep
