// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/high_water.h>
#include <samestep/scalar.h>

#include "contact_block.h"

namespace samestep {

/// One at a time, in any scalar, with its own products.
template <Scalar S>
struct ScalarLanes {
  using V = S;
  using Numbers = PlainNumbers<S, true>;
  using Body = SoftBody<Numbers>;
  static constexpr int kWidth = 1;

  static V zero() { return S(0); }
  static V whole() { return S(1); }
  static V all(S x) { return x; }
  static V allSum(S x) { return x; }
  static V load(const S* from) { return *from; }
  static void store(S* to, V v) { *to = v; }
  static V select(bool mask, V a, V b) { return mask ? a : b; }
  static V greater(V a, V b) { return samestep::max(a, b); }
  static V within(V x, V low, V high) { return samestep::clamp(x, low, high); }
  static V dot2(V a, V b, V c, V d) { return dot(a, b, c, d); }
  static V cross2(V a, V b, V c, V d) { return cross(a, b, c, d); }
  static V dotOf4(V a0, V b0, V a1, V b1, V a2, V b2, V a3, V b3) {
    return dot4(a0, b0, a1, b1, a2, b2, a3, b3);
  }
  static V near(V separation, const SoftConstants<Numbers>&) { return separation; }
  static V product(V a, V b) { return a * b; }
  static V frictionLimit(V friction, V sum) { return friction * sum; }
  static V rate(V way, V rate) { return way * rate; }
  template <class Axis>
  static V spinA(const BlockMoments<Numbers>&, const Axis& axis, int lane, V, V change) {
    return axis.spinA[lane] * change;
  }
  template <class Axis>
  static V spinB(const BlockMoments<Numbers>&, const Axis& axis, int lane, V, V change) {
    return axis.spinB[lane] * change;
  }
  static V soften(const Softness<S>& soft, V full, V before) {
    return dot(soft.massScale, full, soft.impulseScale, before);
  }
  /// Its ranges are kept by contract, see docs/ranges.md.
  static V checked(V v) { return v; }
  static std::uint64_t left() { return 0; }
  static void note(const char* name, V v) { highWater<S>(name, v); }

  static V unless(std::uint8_t bits, int lane, V v) { return (bits >> lane & 1) != 0 ? S(0) : v; }
  static const Softness<S>& softness(std::uint8_t stiff, int lane, const Softness<S>* of) {
    return of[stiff >> lane & 1];
  }

  static void gatherVelocity(const Body* bodies, const std::uint32_t* at, V& x, V& y, V& turn) {
    const Body& body = bodies[*at];
    x = body.velocity[0];
    y = body.velocity[1];
    turn = body.velocity[2];
  }
  static void gatherMoved(const Body* bodies, const std::uint32_t* at, V& x, V& y, V& turn, V& bend) {
    const Body& body = bodies[*at];
    x = body.moved[0];
    y = body.moved[1];
    turn = body.moved[2];
    bend = body.moved[3];
  }
  static void scatterVelocity(Body* bodies, const std::uint32_t* at, int fixed, V x, V y, V turn) {
    if ((fixed & 1) != 0) return;
    Body& body = bodies[*at];
    body.velocity[0] = x;
    body.velocity[1] = y;
    body.velocity[2] = turn;
  }
};

}  // namespace samestep
