// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/high_water.h>
#include <samestep/scalar.h>

#include "solver/kernels/contact_block.h"
#include "solver/kernels/soft_units.h"

namespace samestep {

/// Two numbers side by side, in any scalar with its own products: while one waits for a product the processor
/// works on the other.
template <Scalar S>
struct TwoScalars {
  S a, b;

  [[gnu::always_inline]] friend TwoScalars operator+(const TwoScalars& x, const TwoScalars& y) {
    return {x.a + y.a, x.b + y.b};
  }
  [[gnu::always_inline]] friend TwoScalars operator-(const TwoScalars& x, const TwoScalars& y) {
    return {x.a - y.a, x.b - y.b};
  }
  [[gnu::always_inline]] friend TwoScalars operator-(const TwoScalars& x) { return {-x.a, -x.b}; }
};

/// Two at a time, on every machine.
template <Scalar S>
struct ScalarLanes {
  using V = TwoScalars<S>;
  using C = V;
  using Numbers = PlainNumbers<S, true>;
  using Body = SoftBody<Numbers>;
  static constexpr int kWidth = 2;

  [[gnu::always_inline]] static int pointsOf(const ContactBlock<Numbers>& block, int lane) {
    return max(block.count[lane], block.count[lane + 1]);
  }
  [[gnu::always_inline]] static V zero() { return all(S(0)); }
  [[gnu::always_inline]] static V whole() { return all(S(1)); }
  [[gnu::always_inline]] static V all(S x) { return {x, x}; }
  [[gnu::always_inline]] static V load(const S* from) { return {from[0], from[1]}; }
  [[gnu::always_inline]] static C coefficient(const S* from) { return load(from); }
  [[gnu::always_inline]] static void store(S* to, const V& v) {
    to[0] = v.a;
    to[1] = v.b;
  }
  struct Mask {
    bool a, b;
  };
  [[gnu::always_inline]] static Mask above(const V& x, const V& y) { return {x.a > y.a, x.b > y.b}; }
  [[gnu::always_inline]] static V select(Mask mask, const V& x, const V& y) {
    return {mask.a ? x.a : y.a, mask.b ? x.b : y.b};
  }
  [[gnu::always_inline]] static V greater(const V& x, const V& y) { return {max(x.a, y.a), max(x.b, y.b)}; }
  [[gnu::always_inline]] static V within(const V& x, const V& low, const V& high) {
    return {clamp(x.a, low.a, high.a), clamp(x.b, low.b, high.b)};
  }
  [[gnu::always_inline]] static V dot2(const V& a, const V& b, const V& c, const V& d) {
    return {dot(a.a, b.a, c.a, d.a), dot(a.b, b.b, c.b, d.b)};
  }
  [[gnu::always_inline]] static V cross2(const V& a, const V& b, const V& c, const V& d) {
    return {cross(a.a, b.a, c.a, d.a), cross(a.b, b.b, c.b, d.b)};
  }
  [[gnu::always_inline]] static V crosses(const V& a, const V& b, const V& c, const V& d, const V& e,
                                          const V& f, const V& g, const V& h) {
    return {dot4(a.a, b.a, -c.a, d.a, e.a, f.a, -g.a, h.a), dot4(a.b, b.b, -c.b, d.b, e.b, f.b, -g.b, h.b)};
  }
  [[gnu::always_inline]] static V near(const V& separation, const SoftConstants<Numbers>& constants) {
    return within(separation, -all(constants.mostOverlap), all(constants.mostGap));
  }
  [[gnu::always_inline]] static V product(const V& x, const V& y) { return {x.a * y.a, x.b * y.b}; }
  [[gnu::always_inline]] static V frictionLimit(const ContactBlock<Numbers>&, const V& friction,
                                                const V& sum) {
    // Kept impulses may be twice as large.
    const V most = all(S(1 << 20));
    const V limit = product(friction, {min(sum.a, most.a), min(sum.b, most.b)});
    return {min(limit.a, most.a), min(limit.b, most.b)};
  }
  [[gnu::always_inline]] static V pushing(const V& sum, const SoftConstants<Numbers>& constants) {
    return within(sum, zero(), all(constants.mostSum));
  }
  [[gnu::always_inline]] static V rate(const V& way, S rate) { return product(way, all(rate)); }
  [[gnu::always_inline]] static V rate(const V& way, const V& rate) { return product(way, rate); }
  template <class Axis>
  [[gnu::always_inline]] static V spinA(const BlockMoments<Numbers>&, const Axis& axis, int lane, const V&,
                                        const V& change) {
    return spins(load(axis.spinA + lane), change);
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinB(const BlockMoments<Numbers>&, const Axis& axis, int lane, const V&,
                                        const V& change) {
    return spins(load(axis.spinB + lane), change);
  }
  [[gnu::always_inline]] static V arm(const V& v) { return v; }
  [[gnu::always_inline]] static V spin(const V& moment, const V& arm) {
    const V spin = product(moment, arm);
    note("contact: spin per unit of u", spin);
    return spin;
  }
  [[gnu::always_inline]] static V mass(const V& present, const V& spinA, const V& armA, const V& spinB,
                                       const V& armB) {
    const V sum = whole() + dot2(spinA, armA, spinB, armB);
    return {present.a * reciprocal(sum.a), present.b * reciprocal(sum.b)};
  }
  [[gnu::always_inline]] static V soften(const Softness<V>& soft, const V& full, const V& before) {
    return dot2(soft.massScale, full, soft.impulseScale, before);
  }
  [[gnu::always_inline]] static V factor(S x) { return all(x); }
  [[gnu::always_inline]] static V addProduct(const V& x, const V& factor, const V& to) {
    return {mulAdd(x.a, factor.a, to.a), mulAdd(x.b, factor.b, to.b)};
  }
  [[gnu::always_inline]] static bool differ(const V& x, const V& y) { return x.a != y.a || x.b != y.b; }
  /// Beyond half a radian it is no longer a parabola; the contact is found anew next step.
  [[gnu::always_inline]] static S bend(S turn, int) {
    const S angle = clamp(turn, S(-1), S(1));
    return min(angle * angle * ratio<S>(1, 2), ratio<S>(1, 8));
  }
  /// Clamped values keep the rest in range, see docs/ranges.md.
  [[gnu::always_inline]] static V checked(const V& v) { return v; }
  [[gnu::always_inline]] static V checkedTurn(const V& v) {
    return within(v, all(-kMostSpin), all(kMostSpin));
  }
  /// @param first  of the numbers of a body: the third one is its turning
  [[gnu::always_inline]] static V checkedSpeed(const V& v, int first) {
    return first == 0 ? heldSpeed(v) : checkedTurn(v);
  }
  [[gnu::always_inline]] static V checkedChange(const V& v) { return v; }
  [[gnu::always_inline]] static V checkedTotal(const V& v) { return v; }
  [[gnu::always_inline]] static V checkedWay(const V& v) { return v; }
  [[gnu::always_inline]] static std::uint64_t left() { return 0; }
  [[gnu::always_inline]] static void note(const char* name, const V& v) {
    highWater<S>(name, v.a);
    highWater<S>(name, v.b);
  }

  [[gnu::always_inline]] static V unless(int bits, int lane, const V& v) {
    return select({(bits >> lane & 1) != 0, (bits >> lane & 2) != 0}, zero(), v);
  }
  [[gnu::always_inline]] static Softness<V> softness(int stiff, int lane, const Softness<S>* of) {
    const Softness<S>& a = of[stiff >> lane & 1];
    const Softness<S>& b = of[stiff >> lane >> 1 & 1];
    return {{a.biasRate, b.biasRate}, {a.massScale, b.massScale}, {a.impulseScale, b.impulseScale}};
  }

  [[gnu::always_inline]] static void gatherVelocity(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                    V& turn) {
    const Body& a = bodies[at[0]];
    const Body& b = bodies[at[1]];
    x = {a.velocity[0], b.velocity[0]};
    y = {a.velocity[1], b.velocity[1]};
    turn = {a.velocity[2], b.velocity[2]};
  }
  [[gnu::always_inline]] static void gatherMoved(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                 V& turn, V& bend) {
    const Body& a = bodies[at[0]];
    const Body& b = bodies[at[1]];
    x = {a.moved[0], b.moved[0]};
    y = {a.moved[1], b.moved[1]};
    turn = {a.moved[2], b.moved[2]};
    bend = {a.moved[3], b.moved[3]};
  }
  [[gnu::always_inline]] static void scatterVelocity(Body* bodies, const std::uint32_t* at, int fixed,
                                                     const V& x, const V& y, const V& turn) {
    const V heldX = heldSpeed(x), heldY = heldSpeed(y);
    if ((fixed & 1) == 0) put(bodies[at[0]], heldX.a, heldY.a, turn.a);
    if ((fixed & 2) == 0) put(bodies[at[1]], heldX.b, heldY.b, turn.b);
  }

  /// The spin that an impulse gives, held in size: no other has a product that may not fit.
  [[gnu::always_inline]] static S spinOf(S spin, S impulse) {
    if (abs(spin) > S(1 << 8)) [[unlikely]] {
      const S most = S(1 << 29) / abs(spin);
      return spin * clamp(impulse, -most, most);
    }
    return spin * impulse;
  }
  /// Limits of speeds and spins between two contacts, m/s and rad/s.
  static constexpr S kMostSpeed = S(1 << 22), kMostSpin = S(1 << 14);

 private:
  [[gnu::always_inline]] static V spins(const V& spin, const V& change) {
    return {spinOf(spin.a, change.a), spinOf(spin.b, change.b)};
  }
  [[gnu::always_inline]] static V heldSpeed(const V& v) {
    return within(v, all(-kMostSpeed), all(kMostSpeed));
  }
  [[gnu::always_inline]] static void put(Body& body, S x, S y, S turn) {
    body.velocity[0] = x;
    body.velocity[1] = y;
    body.velocity[2] = turn;
  }
};

/// The wide kernel of wide_lanes.h, one number at a time in any fixed-point scalar: one that checks
/// reports what does not fit.
template <FixedNumber S>
struct WideScalarLanes {
  using V = S;
  using C = S;
  using Numbers = WideNumbers;
  using Body = SoftBody<Numbers>;
  static constexpr int kWidth = 1;

  static int pointsOf(const ContactBlock<Numbers>& block, int) { return block.points; }
  static V zero() { return V(); }
  static V all(std::int64_t x) { return S::fromRaw(x); }
  static V load(const std::int64_t* from) { return all(*from); }
  static C coefficient(const std::int32_t* from) { return all(*from); }
  static void store(std::int64_t* to, V v) { *to = v.raw(); }
  static bool above(V x, V y) { return x > y; }
  static V select(bool mask, V x, V y) { return mask ? x : y; }
  static V greater(V x, V y) { return max(x, y); }
  static V within(V x, V low, V high) { return clamp(x, low, high); }
  static V dot2(V a, V b, V c, V d) { return over<Numbers::kUnitBits>(times(a, b) + times(c, d)); }
  static V cross2(V a, V b, V c, V d) { return over<Numbers::kUnitBits>(times(a, b) - times(c, d)); }
  static V crosses(C a, V b, C c, V d, C e, V f, C g, V h) {
    return over<Numbers::kUnitBits>((times(a, b) - times(c, d)) + (times(e, f) - times(g, h)));
  }
  static V product(V unit, V x) { return over<Numbers::kUnitBits>(times(unit, x)); }
  static V frictionLimit(const ContactBlock<Numbers>&, V friction, V sum) {
    return min(over<Numbers::kFrictionBits>(times(friction, sum)), all(Numbers::kMostLimit));
  }
  static V pushing(V sum, const SoftConstants<Numbers>& constants) {
    return within(sum, zero(), all(constants.mostSum));
  }
  static V near(V separation, const SoftConstants<Numbers>& constants) {
    return within(separation, all(-constants.mostOverlap), all(constants.mostGap));
  }
  static V rate(V way, std::int32_t rate) { return WideScalarLanes::rate(way, all(rate)); }
  static V rate(V way, V rate) { return over<Numbers::kRateBits>(times(rate, way)); }
  template <class Axis>
  static V spinA(const BlockMoments<Numbers>&, const Axis& axis, int lane, V, V change) {
    return over<Numbers::kSpinBits>(times(coefficient(axis.spinA + lane), change));
  }
  template <class Axis>
  static V spinB(const BlockMoments<Numbers>&, const Axis& axis, int lane, V, V change) {
    return over<Numbers::kSpinBits>(times(coefficient(axis.spinB + lane), change));
  }
  static V soften(const Softness<V>& soft, V full, V before) {
    return dot2(soft.massScale, full, soft.impulseScale, before);
  }
  static V factor(std::int64_t x) { return all(x); }
  static V addProduct(V x, V factor, V to) { return factor == S(1) ? x + to : mulAdd(x, factor, to); }
  static bool differ(V x, V y) { return x != y; }
  /// Bend as that of ScalarLanes, of a turning by the radius.
  static std::int64_t bend(std::int64_t turn, int bits) {
    const S bend = ScalarLanes<S>::bend(all(units::shifted(turn, bits)), 0);
    return bend.raw() << bits;
  }
  static V checked(V v) { return v; }
  static V checkedTurn(V v) { return v; }
  static V checkedSpeed(V v, int) { return within(v, all(-Numbers::kMostSpeed), all(Numbers::kMostSpeed)); }
  static V checkedChange(V v) { return v; }
  static V checkedTotal(V v) { return v; }
  static V checkedWay(V v) { return v; }
  static std::uint64_t left() { return 0; }
  static void note(const char* name, V v) { highWater<S>(name, v); }
  static V unless(int bits, int lane, V v) { return (bits >> lane & 1) != 0 ? zero() : v; }
  static Softness<V> softness(int stiff, int lane, const Softness<std::int32_t>* of) {
    const Softness<std::int32_t>& chosen = of[stiff >> lane & 1];
    return {all(chosen.biasRate), all(chosen.massScale), all(chosen.impulseScale)};
  }

  static void gatherVelocity(const Body* bodies, const std::uint32_t* at, V& x, V& y, V& turn) {
    const Body& body = bodies[*at];
    x = all(body.velocity[0]);
    y = all(body.velocity[1]);
    turn = all(body.velocity[2]);
  }
  static void gatherMoved(const Body* bodies, const std::uint32_t* at, V& x, V& y, V& turn, V& bend) {
    const Body& body = bodies[*at];
    x = all(body.moved[0]);
    y = all(body.moved[1]);
    turn = all(body.moved[2]);
    bend = all(body.moved[3]);
  }
  static void scatterVelocity(Body* bodies, const std::uint32_t* at, int fixed, V x, V y, V turn) {
    if ((fixed & 1) != 0) return;
    std::int64_t* to = bodies[*at].velocity;
    to[0] = checkedSpeed(x, 0).raw();
    to[1] = checkedSpeed(y, 1).raw();
    to[2] = checkedSpeed(turn, 2).raw();
  }

 private:
  /// high * 2^32 + low, both integers as S.
  struct Products {
    S high, low;
    friend Products operator+(Products a, Products b) { return {a.high + b.high, a.low + b.low}; }
    friend Products operator-(Products a, Products b) { return {a.high - b.high, a.low - b.low}; }
  };
  static Products times(S coefficient, S x) {
    const std::int64_t c = static_cast<std::int32_t>(coefficient.raw());
    const std::int64_t high = (x + all(std::int64_t{1} << 31)).raw() >> 32;
    return {all(c * high), all(c * static_cast<std::int32_t>(x.raw()))};
  }
  template <int kBits>
  static S over(Products x) {
    const S high = all(static_cast<std::int64_t>(static_cast<std::uint64_t>(x.high.raw()) << (32 - kBits)));
    if constexpr (S::kChecks) {
      if (high.raw() >> (32 - kBits) != x.high.raw()) raw::report("contact", 32, {x.high.raw(), x.low.raw()});
    }
    const S toNearest = x.low + all((std::int64_t{1} << (kBits - 1)) - (x.low < S() ? 1 : 0));
    return high + all(toNearest.raw() >> kBits);
  }
};

}  // namespace samestep
