// SPDX-License-Identifier: MIT
#include "soft_step.h"

#include <samestep/high_water.h>

#include "contact_geometry.h"
#include "kernels/kernels.h"
#include "kernels/scalar_lanes.h"
#include "kernels/solve_contacts.h"
#include "require_ieee.h"

namespace samestep {

template <Scalar S>
Softness<S> makeSoftness(S hertz, S dampingRatio, S substep) {
  const S omega = S(2) * kPi<S> * hertz;
  const S a1 = S(2) * dampingRatio + substep * omega;
  // Also where a spring is too weak for the scalar to tell from none.
  if (hertz == S(0) || a1 == S(0)) return {S(0), S(1), S(0)};
  const S a2 = substep * omega * a1;
  const S a3 = reciprocal(S(1) + a2);
  return {omega / a1, a2 * a3, a3};
}

namespace {

#ifndef SAMESTEP_FIXED_ONLY
ContactPasses<SolverNumbers<double>> passesFor(double, KernelTarget target) {
  if (target == KernelTarget::avx2 && kernels::doubleAvx2 != nullptr) return *kernels::doubleAvx2;
  return kernels::doubleBy2;
}
#endif
template <FixedNumber S>
ContactPasses<SolverNumbers<S>> passesFor(S, KernelTarget) {
  return kPassesOf<ScalarLanes<S>>;
}

/// Gives an impulse (x, y), as the speed it gives A and B together, and what it turns them, to a body's
/// velocity.
template <Scalar S>
void give(S velocity[4], S share, S x, S y, S turn) {
  velocity[0] += share * x;
  velocity[1] += share * y;
  velocity[2] += turn;
}

template <class Block, class Axis>
auto spinA(const Block& block, const Axis& axis, int lane) {
  if constexpr (requires { axis.spinA; }) {
    return axis.spinA[lane];
  } else {
    return block.moments.momentA[lane] * axis.armA[lane];
  }
}
template <class Block, class Axis>
auto spinB(const Block& block, const Axis& axis, int lane) {
  if constexpr (requires { axis.spinB; }) {
    return axis.spinB[lane];
  } else {
    return block.moments.momentB[lane] * axis.armB[lane];
  }
}

}  // namespace

template <Scalar S>
SoftSolver<S>::SoftSolver() : passes(passesFor(S(), nextBestKernel(KernelTarget::best))) {}

template <Scalar S>
void SoftSolver<S>::setKernel(KernelTarget target) {
  passes = passesFor(S(), target);
}

template <Scalar S>
void SoftSolver<S>::clear() {
  bodies.assign(1, {});
  drives.assign(1, {});
  momentsPerMass.assign(1, S(0));
  freeBodies.clear();
  freeHeld.clear();
  groups.clear();
  blockCount = 0;
}

namespace {

template <Scalar S, class SoftBody>
void start(SoftBody& to, const Body<S>& body) {
  to.velocity[0] = body.velocity().x;
  to.velocity[1] = body.velocity().y;
  to.velocity[2] = body.angularVelocity();
}

template <class N>
void clearAxis(BlockAxis<N>& axis, int lane) {
  using Coefficient = typename N::Coefficient;
  axis.armA[lane] = axis.armB[lane] = axis.mass[lane] = Coefficient(0);
  axis.sum[lane] = typename N::Sum(0);
  if constexpr (N::kStoresSpins) axis.spinA[lane] = axis.spinB[lane] = Coefficient(0);
}

/// A point that changes nothing.
template <class N>
void clearPoint(ContactBlock<N>& block, BlockRest<N>& rest, int lane, int point) {
  clearAxis(block.point[point].normal, lane);
  clearAxis(block.point[point].tangent, lane);
  block.point[point].separation[lane] = typename N::Coefficient(0);
  rest.normalTotal[point][lane] = rest.tangentTotal[point][lane] = rest.bounce[point][lane] =
      typename N::Sum(0);
}

/// Of a contact's points, from the centres of mass, each in the coordinates of its body.
template <Scalar S>
struct AnchorArms {
  Vector<S> a, b;
};
template <Scalar S>
AnchorArms<S> anchorArms(const Contact<S>& contact, const Body<S>& a, const Body<S>& b) {
  return {contact.anchorA - a.centerOfMass(), contact.anchorB - b.centerOfMass()};
}

/// As respond(), from the bodies' own moments by mass.
template <Scalar S>
PairResponse<S> respondWith(const Body<S>& a, S momentPerMassA, const Body<S>& b, S momentPerMassB) {
  const Scaled<S> none{};
  if (b.inverseMass() == none) return {S(1), S(0), momentPerMassA, S(0)};
  if (a.inverseMass() == none) return {S(0), S(1), S(0), momentPerMassB};
  if (a.inverseMass() == b.inverseMass()) return {S(1), S(1), momentPerMassA, momentPerMassB};
  const bool aIsLighter = a.inverseMass() > b.inverseMass();
  const S heavy = aIsLighter ? toScalar<S>(b.inverseMass() * toScaled(a.mass()))
                             : toScalar<S>(a.inverseMass() * toScaled(b.mass()));
  if (aIsLighter) return {S(1), heavy, momentPerMassA, momentPerMassB * heavy};
  return {heavy, S(1), momentPerMassA * heavy, momentPerMassB};
}

}  // namespace

template <Scalar S>
std::uint32_t SoftSolver<S>::addBody(const Body<S>& body, const SoftDrive<Numbers>& drive) {
  SoftBody<Numbers>& added = bodies.emplace_back();
  start(added, body);
  SoftDrive<Numbers>& kept = drives.emplace_back(drive);
  for (int k = 0; k < 3; ++k) kept.base[k] = added.velocity[k];
  momentsPerMass.push_back(momentPerMass(body));
  return static_cast<std::uint32_t>(bodies.size() - 1);
}

template <Scalar S>
void SoftSolver<S>::addFree(const Body<S>& body, const SoftDrive<Numbers>& drive, int substeps) {
  SoftBody<Numbers> moving{};
  start(moving, body);
  SoftDrive<Numbers> alone = drive;
  for (int i = 0; i < substeps; ++i) {
    for (int k = 0; k < 3; ++k) alone.base[k] = moving.velocity[k];
    integrateVelocity(moving, alone);
    // Nothing asks how a body bends that touches nothing.
    for (int k = 0; k < 3; ++k) {
      moving.moved[k] = mulAdd(moving.velocity[k], constants.substep, moving.moved[k]);
    }
  }
  freeBodies.push_back(moving);
  freeHeld.push_back(alone.held);
}

template <Scalar S>
void SoftSolver<S>::makeRoom() {
  blockCount = groups.empty() ? 0 : groups.back().end;
  if (blocks.size() >= blockCount) return;
  blocks.resize(blockCount);
  rests.resize(blockCount);
}

template <Scalar S>
void SoftSolver<S>::openBlock(std::uint32_t at) {
  Block& block = blocks[at];
  block.points = block.bounces = block.roundA = block.roundB = block.stiff = 0;
  block.fixedA = block.fixedB = 0;
}

template <Scalar S>
void SoftSolver<S>::closeBlock(std::uint32_t at, int lanes) {
  Block& block = blocks[at];
  Rest& rest = rests[at];
  for (int lane = lanes; lane < kBlockLanes; ++lane) {
    const auto bit = static_cast<std::uint8_t>(1 << lane);
    block.fixedA = static_cast<std::uint8_t>(block.fixedA | bit);
    block.fixedB = static_cast<std::uint8_t>(block.fixedB | bit);
    block.bodyA[lane] = block.bodyB[lane] = 0;
    block.count[lane] = 0;
    block.normalX[lane] = block.normalY[lane] = block.shareA[lane] = S(0);
    block.friction[lane] = block.surface[lane] = S(0);
    if constexpr (!Numbers::kStoresSpins) block.moments.momentA[lane] = block.moments.momentB[lane] = S(0);
    rest.pair[lane] = Rest::kNoPair;
    for (int i = 0; i < kMaxContactsPerPair; ++i) clearPoint(block, rest, lane, i);
  }
}

template <Scalar S>
void SoftSolver<S>::addPair(std::uint32_t at, int lane, const Pair<S>& pair, std::uint32_t pairIndex,
                            std::uint32_t indexA, std::uint32_t indexB, const Body<S>& a, const Body<S>& b,
                            bool roundA, bool roundB, S bounceThreshold) {
  Block& block = blocks[at];
  Rest& rest = rests[at];
  const PairResponse<S> response = respondWith(a, momentsPerMass[indexA], b, momentsPerMass[indexB]);
  const S masses = response.massA + response.massB;
  const bool alone = masses == S(1);
  const bool equal = masses == S(2);
  const S perMass = alone ? S(1) : equal ? ratio<S>(1, 2) : reciprocal(masses);
  const auto bit = static_cast<std::uint8_t>(1 << lane);
  const auto mark = [&](std::uint8_t& bits, bool set) {
    if (set) bits = static_cast<std::uint8_t>(bits | bit);
  };
  const Vector<S> n = worldNormal(pair, a);
  block.bodyA[lane] = indexA;
  block.bodyB[lane] = indexB;
  block.count[lane] = pair.count;
  block.points = max(block.points, pair.count);
  mark(block.fixedA, !a.isDynamic());
  mark(block.fixedB, !b.isDynamic());
  mark(block.roundA, roundA);
  mark(block.roundB, roundB);
  mark(block.stiff, !a.isDynamic() || !b.isDynamic());
  block.normalX[lane] = n.x;
  block.normalY[lane] = n.y;
  block.shareA[lane] = response.massA * perMass;
  const S shareB = S(1) - block.shareA[lane];
  block.friction[lane] = pair.friction;
  block.surface[lane] = cross(n, pair.surfaceVelocity);
  rest.pair[lane] = pairIndex;

  // An arm by the normal is the same in the body's coordinates, where points and A's normal are kept.
  const Vector<S> nA = pair.localNormal;
  const Vector<S> nB = unrotate(n, b.rotation());
  const S between = dot(n, b.worldCenter() - a.worldCenter());
  S normalPart = S(0), tangentPart = S(0), turnA = S(0), turnB = S(0);
  Vector<S> reachA, reachB;
  for (int i = 0; i < pair.count; ++i) {
    const auto [toA, toB] = anchorArms(pair.contacts[i], a, b);
    reachA = {max(reachA.x, abs(toA.x)), max(reachA.y, abs(toA.y))};
    reachB = {max(reachB.x, abs(toB.x)), max(reachB.y, abs(toB.y))};
  }
  const PairResponse<S> held = response.at(reachA, reachB);
  const S momentA = held.momentA * perMass;
  const S momentB = held.momentB * perMass;
  if constexpr (!Numbers::kStoresSpins) {
    block.moments.momentA[lane] = momentA;
    block.moments.momentB[lane] = momentB;
  }
  const auto keptSum = [&](S speed) { return alone ? speed : equal ? speed + speed : speed * masses; };
  for (int i = 0; i < pair.count; ++i) {
    const Contact<S>& contact = pair.contacts[i];
    auto& point = block.point[i];
    const auto fill = [&](auto& axis, S inA, S inB, S kept) {
      const S turnPerA = momentA * inA;
      const S turnPerB = momentB * inB;
      axis.armA[lane] = inA;
      axis.armB[lane] = inB;
      axis.mass[lane] = reciprocal(S(1) + dot(turnPerA, inA, turnPerB, inB));
      axis.sum[lane] = kept;
      if constexpr (Numbers::kStoresSpins) {
        axis.spinA[lane] = turnPerA;
        axis.spinB[lane] = turnPerB;
      }
      turnA += turnPerA * kept;
      turnB += turnPerB * kept;
      // Of a body that nothing turns the arm counts for nothing.
      highWater<S>("contact: r x n of a body that turns", held.momentA > S(0) ? inA : S(0));
      highWater<S>("contact: r x n of a body that turns", held.momentB > S(0) ? inB : S(0));
      highWater<S>("contact: spin per unit of u", max(abs(turnPerA), abs(turnPerB)));
      highWater<S>("contact: kept impulse u", kept);
    };
    const auto [toA, toB] = anchorArms(contact, a, b);
    // r x t is r . n.
    const S depthA = dot(toA, nA);
    const S depthB = dot(toB, nB);
    fill(point.normal, cross(toA, nA), cross(toB, nB), clamp(keptSum(contact.normalSpeed), S(0), kMaxSum<S>));
    fill(point.tangent, depthA, depthB, clamp(keptSum(contact.tangentSpeed), -kMaxSum<S>, kMaxSum<S>));
    point.separation[lane] = clamp(between + (depthB - depthA), S(-(1 << 10)), S(1 << 10));
    normalPart += point.normal.sum[lane];
    tangentPart += point.tangent.sum[lane];
    rest.normalTotal[i][lane] = rest.tangentTotal[i][lane] = rest.bounce[i][lane] = S(0);
    if (pair.elasticity == S(0)) continue;
    const Vector<S> dv = b.velocity() - a.velocity();
    const S approach = dot(n.x, dv.x, n.y, dv.y) + cross(point.normal.armB[lane], b.angularVelocity(),
                                                         point.normal.armA[lane], a.angularVelocity());
    if (approach < -bounceThreshold) {
      rest.bounce[i][lane] = -(pair.elasticity * approach);
      block.bounces = 1;
    }
  }
  for (int i = pair.count; i < kMaxContactsPerPair; ++i) clearPoint(block, rest, lane, i);
  const S x = cross(n.x, normalPart, n.y, tangentPart);
  const S y = dot(n.y, normalPart, n.x, tangentPart);
  if (a.isDynamic()) give(drives[indexA].base, block.shareA[lane], x, y, turnA);
  if (b.isDynamic()) give(drives[indexB].base, shareB, -x, -y, -turnB);
}

template <Scalar S>
void SoftSolver<S>::pass(ContactPass<Numbers> kernel, Crew& crew) {
  passOverGroups(kernel, blocks, rests, groups, bodies, constants, crew);
}

template <Scalar S>
void SoftSolver<S>::run(int substeps, Crew& crew) {
  const auto count = static_cast<std::uint32_t>(bodies.size());
  for (int i = 0; i < substeps; ++i) {
    crew.each(count, kBodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t k = begin; k < end; ++k) integrateVelocity(bodies[k], drives[k]);
    });
    pass(passes.solve, crew);
    crew.each(count, kBodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t k = begin; k < end; ++k) integratePosition(bodies[k]);
    });
    pass(passes.relax, crew);
  }
}

/// What contacts gave a velocity in the last substep is its difference from the base, and is given again.
template <Scalar S>
void SoftSolver<S>::integrateVelocity(SoftBody<Numbers>& body, SoftDrive<Numbers>& drive) const {
  constexpr S kLimits[3] = {kMaxSpeed<S>, kMaxSpeed<S>, kMaxAngularSpeed<S>};
  for (int k = 0; k < 3; ++k) {
    const S given = body.velocity[k] - drive.base[k];
    const S free = drive.kept == S(1) ? body.velocity[k] + drive.push[k]
                                      : mulAdd(body.velocity[k], drive.kept, drive.push[k]);
    drive.base[k] = clamp(free, -kLimits[k], kLimits[k]);
    if (drive.base[k] != free) [[unlikely]]
      drive.held =
          static_cast<std::uint8_t>(drive.held | (k == 2 ? Body<S>::kHeldSpin : Body<S>::kHeldSpeed));
    body.velocity[k] = drive.base[k] + given;
  }
}

template <Scalar S>
void SoftSolver<S>::integratePosition(SoftBody<Numbers>& body) const {
  const S half = ratio<S>(1, 2);
  const S most = ratio<S>(1, 8);
  for (int k = 0; k < 3; ++k) body.moved[k] = mulAdd(body.velocity[k], constants.substep, body.moved[k]);
  // Beyond half a radian the bend is no longer a parabola; the contact is found anew next step.
  body.moved[3] = min(body.moved[2] * body.moved[2] * half, most);
}

template <Scalar S>
void SoftSolver<S>::bounce() {
  if (!bounces) return;
  for (std::uint32_t i = 0; i < blockCount; ++i) {
    Block& block = blocks[i];
    if (block.bounces == 0) continue;
    Rest& rest = rests[i];
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      SoftBody<Numbers>& a = bodies[block.bodyA[lane]];
      SoftBody<Numbers>& b = bodies[block.bodyB[lane]];
      for (int k = 0; k < block.count[lane]; ++k) {
        auto& axis = block.point[k].normal;
        if (rest.bounce[k][lane] == S(0) || rest.normalTotal[k][lane] == S(0)) continue;
        const Vector<S> n(block.normalX[lane], block.normalY[lane]);
        const S speed = dot(n.x, b.velocity[0] - a.velocity[0], n.y, b.velocity[1] - a.velocity[1]) +
                        cross(axis.armB[lane], b.velocity[2], axis.armA[lane], a.velocity[2]);
        const S before = axis.sum[lane];
        axis.sum[lane] =
            clamp(before + axis.mass[lane] * (rest.bounce[k][lane] - speed), S(0), constants.mostSum);
        const S change = axis.sum[lane] - before;
        rest.normalTotal[k][lane] += change;
        if ((block.fixedA >> lane & 1) == 0) {
          give(a.velocity, block.shareA[lane], -(n.x * change), -(n.y * change),
               -(spinA(block, axis, lane) * change));
        }
        if ((block.fixedB >> lane & 1) == 0) {
          give(b.velocity, S(1) - block.shareA[lane], n.x * change, n.y * change,
               spinB(block, axis, lane) * change);
        }
      }
    }
  }
}

template <Scalar S>
void SoftSolver<S>::store(std::vector<Pair<S>>& pairs, Crew& crew) const {
  crew.each(blockCount, kBlockGrain, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) storeBlock(i, pairs);
  });
}

template <Scalar S>
void SoftSolver<S>::storeBlock(std::uint32_t at, std::vector<Pair<S>>& pairs) const {
  const Block& block = blocks[at];
  const Rest& rest = rests[at];
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    if (rest.pair[lane] == Rest::kNoPair) continue;
    // The lighter body has the larger share.
    const S lighter = max(block.shareA[lane], S(1) - block.shareA[lane]);
    Pair<S>& pair = pairs[rest.pair[lane]];
    for (int k = 0; k < block.count[lane]; ++k) {
      Contact<S>& contact = pair.contacts[k];
      contact.normalSpeed = block.point[k].normal.sum[lane] * lighter;
      contact.tangentSpeed = block.point[k].tangent.sum[lane] * lighter;
      contact.normalTotal = min(rest.normalTotal[k][lane], kMaxSum<S>) * lighter;
      contact.tangentTotal = clamp(rest.tangentTotal[k][lane], -kMaxSum<S>, kMaxSum<S>) * lighter;
      highWater<S>("soft step: impulse total", rest.normalTotal[k][lane]);
    }
  }
}

#ifndef SAMESTEP_FIXED_ONLY
template Softness<double> makeSoftness(double, double, double);
template struct SoftSolver<double>;
#endif
template Softness<Fixed> makeSoftness(Fixed, Fixed, Fixed);
template struct SoftSolver<Fixed>;
template Softness<CheckedFixed> makeSoftness(CheckedFixed, CheckedFixed, CheckedFixed);
template struct SoftSolver<CheckedFixed>;

}  // namespace samestep
