// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "solver/kernels/contact_block.h"

namespace samestep {
namespace {

/// Twice the lanes of L: while one half waits for a product the processor works on the other. A contact is
/// one long chain of products, so that this is nearly twice as fast.
template <class L>
class TwoLanes {
 public:
  using Numbers = typename L::Numbers;
  using Body = SoftBody<Numbers>;
  using Speed = typename Numbers::Speed;
  using Coefficient = typename Numbers::Coefficient;
  static constexpr int kHalf = L::kWidth;
  static constexpr int kWidth = 2 * kHalf;
  struct V {
    typename L::V a, b;
    [[gnu::always_inline]] friend V operator+(const V& x, const V& y) { return {x.a + y.a, x.b + y.b}; }
    [[gnu::always_inline]] friend V operator-(const V& x, const V& y) { return {x.a - y.a, x.b - y.b}; }
    [[gnu::always_inline]] friend V operator-(const V& x) { return {-x.a, -x.b}; }
  };
  struct C {
    typename L::C a, b;
    [[gnu::always_inline]] friend C operator-(const C& x, const C& y) { return {x.a - y.a, x.b - y.b}; }
  };
  struct Mask {
    decltype(L::above(L::zero(), L::zero())) a, b;
  };

  static int pointsOf(const ContactBlock<Numbers>& block, int lane) { return L::pointsOf(block, lane); }
  [[gnu::always_inline]] static V zero() { return {L::zero(), L::zero()}; }
  [[gnu::always_inline]] static V all(Speed x) { return {L::all(x), L::all(x)}; }
  template <class Number>
  [[gnu::always_inline]] static V load(const Number* from) {
    return {L::load(from), L::load(from + kHalf)};
  }
  [[gnu::always_inline]] static C coefficient(const Coefficient* from) {
    return {L::coefficient(from), L::coefficient(from + kHalf)};
  }
  template <class Number>
  [[gnu::always_inline]] static void store(Number* to, const V& v) {
    L::store(to, v.a);
    L::store(to + kHalf, v.b);
  }
  [[gnu::always_inline]] static Mask above(const V& x, const V& y) {
    return {L::above(x.a, y.a), L::above(x.b, y.b)};
  }
  [[gnu::always_inline]] static V select(const Mask& mask, const V& x, const V& y) {
    return {L::select(mask.a, x.a, y.a), L::select(mask.b, x.b, y.b)};
  }
  [[gnu::always_inline]] static V greater(const V& x, const V& y) {
    return {L::greater(x.a, y.a), L::greater(x.b, y.b)};
  }
  [[gnu::always_inline]] static V within(const V& x, const V& low, const V& high) {
    return {L::within(x.a, low.a, high.a), L::within(x.b, low.b, high.b)};
  }
  [[gnu::always_inline]] static V pushing(const V& sum, const SoftConstants<Numbers>& constants) {
    return {L::pushing(sum.a, constants), L::pushing(sum.b, constants)};
  }
  [[gnu::always_inline]] static Softness<C> softness(int stiff, int lane, const Softness<Coefficient>* of) {
    const auto x = L::softness(stiff, lane, of);
    const auto y = L::softness(stiff, lane + kHalf, of);
    return {{x.biasRate, y.biasRate}, {x.massScale, y.massScale}, {x.impulseScale, y.impulseScale}};
  }
  [[gnu::always_inline]] static V unless(int bits, int lane, const V& v) {
    return {L::unless(bits, lane, v.a), L::unless(bits, lane + kHalf, v.b)};
  }

  [[gnu::always_inline]] static V dot2(const C& a, const V& b, const C& c, const V& d) {
    return {L::dot2(a.a, b.a, c.a, d.a), L::dot2(a.b, b.b, c.b, d.b)};
  }
  [[gnu::always_inline]] static V cross2(const C& a, const V& b, const C& c, const V& d) {
    return {L::cross2(a.a, b.a, c.a, d.a), L::cross2(a.b, b.b, c.b, d.b)};
  }
  [[gnu::always_inline]] static V crosses(const C& a, const V& b, const C& c, const V& d, const C& e,
                                          const V& f, const C& g, const V& h) {
    return {L::crosses(a.a, b.a, c.a, d.a, e.a, f.a, g.a, h.a),
            L::crosses(a.b, b.b, c.b, d.b, e.b, f.b, g.b, h.b)};
  }
  [[gnu::always_inline]] static V product(const C& unit, const V& x) {
    return {L::product(unit.a, x.a), L::product(unit.b, x.b)};
  }
  [[gnu::always_inline]] static V frictionLimit(const ContactBlock<Numbers>& block, const C& friction,
                                                const V& sum) {
    return {L::frictionLimit(block, friction.a, sum.a), L::frictionLimit(block, friction.b, sum.b)};
  }
  [[gnu::always_inline]] static V near(const V& separation, const SoftConstants<Numbers>& constants) {
    return {L::near(separation.a, constants), L::near(separation.b, constants)};
  }
  [[gnu::always_inline]] static V rate(const V& way, Coefficient rate) {
    return {L::rate(way.a, rate), L::rate(way.b, rate)};
  }
  [[gnu::always_inline]] static V rate(const V& way, const C& rate) {
    return {L::rate(way.a, rate.a), L::rate(way.b, rate.b)};
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinA(const BlockMoments<Numbers>& of, const Axis& axis, int lane,
                                        const C& arm, const V& change) {
    return {L::spinA(of, axis, lane, arm.a, change.a), L::spinA(of, axis, lane + kHalf, arm.b, change.b)};
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinB(const BlockMoments<Numbers>& of, const Axis& axis, int lane,
                                        const C& arm, const V& change) {
    return {L::spinB(of, axis, lane, arm.a, change.a), L::spinB(of, axis, lane + kHalf, arm.b, change.b)};
  }
  [[gnu::always_inline]] static V soften(const Softness<C>& soft, const V& full, const V& before) {
    return dot2(soft.massScale, full, soft.impulseScale, before);
  }
  [[gnu::always_inline]] static V arm(const V& v) { return {L::arm(v.a), L::arm(v.b)}; }
  [[gnu::always_inline]] V spin(const C& moment, const V& arm) {
    return {lanes_.spin(moment.a, arm.a), lanes_.spin(moment.b, arm.b)};
  }
  [[gnu::always_inline]] static V mass(const V& present, const V& spinA, const V& armA, const V& spinB,
                                       const V& armB) {
    return {L::mass(present.a, spinA.a, armA.a, spinB.a, armB.a),
            L::mass(present.b, spinA.b, armA.b, spinB.b, armB.b)};
  }
  static void note(const char*, const V&) {}
  [[gnu::always_inline]] V checked(const V& v) { return {lanes_.checked(v.a), lanes_.checked(v.b)}; }
  [[gnu::always_inline]] V checkedTurn(const V& v) {
    return {lanes_.checkedTurn(v.a), lanes_.checkedTurn(v.b)};
  }
  [[gnu::always_inline]] V checkedChange(const V& v) {
    return {lanes_.checkedChange(v.a), lanes_.checkedChange(v.b)};
  }
  [[gnu::always_inline]] V checkedTotal(const V& v) {
    return {lanes_.checkedTotal(v.a), lanes_.checkedTotal(v.b)};
  }
  std::uint64_t left() const { return lanes_.left(); }

  [[gnu::always_inline]] static void gatherVelocity(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                    V& turn) {
    L::gatherVelocity(bodies, at, x.a, y.a, turn.a);
    L::gatherVelocity(bodies, at + kHalf, x.b, y.b, turn.b);
  }
  [[gnu::always_inline]] static void gatherMoved(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                 V& turn, V& bend) {
    L::gatherMoved(bodies, at, x.a, y.a, turn.a, bend.a);
    L::gatherMoved(bodies, at + kHalf, x.b, y.b, turn.b, bend.b);
  }
  [[gnu::always_inline]] void scatterVelocity(Body* bodies, const std::uint32_t* at, int fixed, const V& x,
                                              const V& y, const V& turn) {
    lanes_.scatterVelocity(bodies, at, fixed, x.a, y.a, turn.a);
    lanes_.scatterVelocity(bodies, at + kHalf, fixed >> kHalf, x.b, y.b, turn.b);
  }

 private:
  L lanes_;
};

}  // namespace
}  // namespace samestep
