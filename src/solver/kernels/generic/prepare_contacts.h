// SPDX-License-Identifier: MIT
#pragma once

#include "solver/kernels/contact_block.h"

/// Preparation of a contact block for the passes over it, written once for every kernel, as solve_contacts.h
/// is.
namespace samestep {
namespace {

/// An arm by the normal is the same in the body's coordinates, where points and A's normal are kept.
template <class L, class N = typename L::Numbers>
[[gnu::always_inline]] inline void prepareLanes(const BlockInput<N>& in, ContactBlock<N>& block, int lane,
                                                L& lanes) {
  using V = typename L::V;
  using C = typename L::C;
  const V normalAX = L::load(in.normalX + lane);
  const V normalAY = L::load(in.normalY + lane);
  const C cosA = L::coefficient(in.cosA + lane);
  const C sinA = L::coefficient(in.sinA + lane);
  const V nx = L::cross2(cosA, normalAX, sinA, normalAY);
  const V ny = L::dot2(sinA, normalAX, cosA, normalAY);
  L::store(block.normalX + lane, nx);
  L::store(block.normalY + lane, ny);
  const C shareA = L::coefficient(block.shareA + lane);
  L::store(block.pushAX + lane, L::product(shareA, nx));
  L::store(block.pushAY + lane, L::product(shareA, ny));
  const C cosB = L::coefficient(in.cosB + lane);
  const C sinB = L::coefficient(in.sinB + lane);
  const V normalBX = L::dot2(cosB, nx, sinB, ny);
  const V normalBY = L::cross2(cosB, ny, sinB, nx);
  const C momentA = L::coefficient(in.momentA + lane);
  const C momentB = L::coefficient(in.momentB + lane);
  for (int i = 0; i < block.points; ++i) {
    const auto& from = in.point[i];
    const V present = L::load(from.present + lane);
    const auto fill = [&](auto& axis, V armA, V armB) __attribute__((always_inline)) {
      const V spinA = lanes.spin(momentA, armA);
      const V spinB = lanes.spin(momentB, armB);
      L::store(axis.armA + lane, armA);
      L::store(axis.armB + lane, armB);
      L::store(axis.mass + lane, L::mass(present, spinA, armA, spinB, armB));
      if constexpr (N::kStoresSpins) {
        L::store(axis.spinA + lane, spinA);
        L::store(axis.spinB + lane, spinB);
      }
    };
    const C armAX = L::coefficient(from.armAX + lane);
    const C armAY = L::coefficient(from.armAY + lane);
    const C armBX = L::coefficient(from.armBX + lane);
    const C armBY = L::coefficient(from.armBY + lane);
    fill(block.point[i].normal, L::arm(L::cross2(armAX, normalAY, armAY, normalAX)),
         L::arm(L::cross2(armBX, normalBY, armBY, normalBX)));
    // r x t is r . n.
    fill(block.point[i].tangent, L::arm(L::dot2(armAX, normalAX, armAY, normalAY)),
         L::arm(L::dot2(armBX, normalBX, armBY, normalBY)));
  }
}

/// Gives what the points hold to the bodies.
template <class L, class N = typename L::Numbers>
[[gnu::always_inline]] inline void giveLanes(const ContactBlock<N>& block, int lane, SoftBody<N>* bodies,
                                             L& lanes) {
  using V = typename L::V;
  using C = typename L::C;
  V xA, yA, turnA, xB, yB, turnB;
  L::gatherVelocity(bodies, block.bodyA + lane, xA, yA, turnA);
  L::gatherVelocity(bodies, block.bodyB + lane, xB, yB, turnB);
  V normalPart = L::zero();
  V tangentPart = L::zero();
  for (int i = 0; i < block.points; ++i) {
    const auto turn = [&](const auto& axis, V kept) __attribute__((always_inline)) {
      turnA = lanes.checkedTurn(turnA -
                                L::spinA(block.moments, axis, lane, L::coefficient(axis.armA + lane), kept));
      turnB = lanes.checkedTurn(turnB +
                                L::spinB(block.moments, axis, lane, L::coefficient(axis.armB + lane), kept));
      L::note("contact: kept impulse u", kept);
    };
    const V normal = L::load(block.point[i].normal.sum + lane);
    const V tangent = L::load(block.point[i].tangent.sum + lane);
    turn(block.point[i].normal, normal);
    turn(block.point[i].tangent, tangent);
    normalPart = normalPart + normal;
    tangentPart = tangentPart + tangent;
  }
  const C ax = L::coefficient(block.pushAX + lane);
  const C ay = L::coefficient(block.pushAY + lane);
  const C bx = L::coefficient(block.normalX + lane) - ax;
  const C by = L::coefficient(block.normalY + lane) - ay;
  lanes.scatterVelocity(bodies, block.bodyA + lane, block.fixedA >> lane,
                        xA - L::cross2(ax, normalPart, ay, tangentPart),
                        yA - L::dot2(ay, normalPart, ax, tangentPart), turnA);
  lanes.scatterVelocity(bodies, block.bodyB + lane, block.fixedB >> lane,
                        xB + L::cross2(bx, normalPart, by, tangentPart),
                        yB + L::dot2(by, normalPart, bx, tangentPart), turnB);
}

/// @tparam P  the lanes that coefficients are prepared by
template <class P, class L, class N = typename L::Numbers>
std::uint64_t prepareBlock(const BlockInput<N>& input, ContactBlock<N>& block, SoftBody<N>* bodies) {
  P preparing;
  for (int lane = 0; lane < N::kLanes; lane += P::kWidth) {
    if (P::kWidth < N::kLanes && block.count[lane] == 0) break;
    prepareLanes(input, block, lane, preparing);
  }
  L lanes;
  for (int lane = 0; lane < N::kLanes; lane += L::kWidth) {
    if (L::kWidth < N::kLanes && block.count[lane] == 0) break;
    giveLanes(block, lane, bodies, lanes);
  }
  return preparing.left() | lanes.left();
}

}  // namespace
}  // namespace samestep
