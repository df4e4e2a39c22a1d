// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "solver/kernels/contact_block.h"

/// Integer kernels, whatever the vectors. Every rounding is to nearest, ties away from zero: mirror images
/// stay mirror images.
namespace samestep {
namespace {

/// All in 32 bits. `Vectors` gives the vector of 32-bit integers and Products, its products in 64 bits.
///
/// What no sum may do is leave 32 bits unseen. Of what is checked, speeds and impulses are below 2^28,
/// changes of impulses, ways and bends below 2^27, totals below 2^30; coefficients are at most 1, but for
/// spins and friction below 8. Relative speeds are then below 2^30.5, separations below 2^30, limits below
/// 2^31, and every product is kept whole until it is rounded.
template <class Vectors>
class FastLanes {
 public:
  using Numbers = FastNumbers;
  using Body = SoftBody<Numbers>;
  using V = typename Vectors::V;
  using C = typename Vectors::Coefficients;
  static constexpr int kWidth = sizeof(V) / sizeof(std::int32_t);

  static int pointsOf(const ContactBlock<Numbers>& block, int) { return block.points; }
  [[gnu::always_inline]] static V zero() { return V{}; }
  [[gnu::always_inline]] static V all(std::int32_t x) { return V{} + x; }
  [[gnu::always_inline]] static V load(const std::int32_t* from) {
    return *reinterpret_cast<const typename Vectors::Loose*>(from);
  }
  [[gnu::always_inline]] static C coefficient(const std::int32_t* from) { return C::at(from); }
  [[gnu::always_inline]] static void store(std::int32_t* to, V v) {
    *reinterpret_cast<typename Vectors::Loose*>(to) = v;
  }
  template <class Mask>
  [[gnu::always_inline]] static V select(Mask mask, V a, V b) {
    return mask ? a : b;
  }
  [[gnu::always_inline]] static auto above(V a, V b) { return a > b; }
  [[gnu::always_inline]] static V greater(V a, V b) { return Vectors::greater(a, b); }
  [[gnu::always_inline]] static V within(V x, V low, V high) {
    return Vectors::less(Vectors::greater(x, low), high);
  }
  /// Too large a sum is seen where it is checked.
  [[gnu::always_inline]] static V pushing(V sum, const SoftConstants<Numbers>&) {
    return greater(sum, zero());
  }
  [[gnu::always_inline]] static Softness<C> softness(int stiff, int lane, const Softness<std::int32_t>* of) {
    const V mask = Vectors::mask(stiff >> lane);
    const auto choose = [&](std::int32_t in, std::int32_t out) __attribute__((always_inline)) {
      return C(all(out) ^ (mask & all(in ^ out)));
    };
    return {choose(of[1].biasRate, of[0].biasRate), choose(of[1].massScale, of[0].massScale),
            choose(of[1].impulseScale, of[0].impulseScale)};
  }
  [[gnu::always_inline]] static V unless(int bits, int lane, V v) { return v & ~Vectors::mask(bits >> lane); }

  [[gnu::always_inline]] static V dot2(const C& a, V b, const C& c, V d) {
    return over<Numbers::kUnitBits>(times(a, b) + times(c, d));
  }
  [[gnu::always_inline]] static V cross2(const C& a, V b, const C& c, V d) {
    return over<Numbers::kUnitBits>(times(a, b) - times(c, d));
  }
  [[gnu::always_inline]] static V crosses(const C& a, V b, const C& c, V d, const C& e, V f, const C& g,
                                          V h) {
    return over<Numbers::kUnitBits>((times(a, b) - times(c, d)) + (times(e, f) - times(g, h)));
  }
  [[gnu::always_inline]] static V product(const C& unit, V x) {
    return over<Numbers::kUnitBits>(times(unit, x));
  }
  [[gnu::always_inline]] static V frictionLimit(const ContactBlock<Numbers>& block, const C& friction,
                                                V sum) {
    const V limit = over<Numbers::kFrictionBits>(times(friction, sum));
    return Vectors::less(limit, all((1 << 30) >> block.frictionShift)) << block.frictionShift;
  }
  [[gnu::always_inline]] static V near(V separation, const SoftConstants<Numbers>& constants) {
    return within(separation, all(-constants.mostOverlap), all(constants.mostGap));
  }
  [[gnu::always_inline]] static V rate(V way, std::int32_t rate) {
    return FastLanes::rate(way, C(all(rate)));
  }
  [[gnu::always_inline]] static V rate(V way, const C& rate) {
    return over<Numbers::kRateBits>(times(rate, way));
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinA(const BlockMoments<Numbers>&, const Axis& axis, int lane, const C&,
                                        V change) {
    return over<Numbers::kSpinBits>(times(coefficient(axis.spinA + lane), change));
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinB(const BlockMoments<Numbers>&, const Axis& axis, int lane, const C&,
                                        V change) {
    return over<Numbers::kSpinBits>(times(coefficient(axis.spinB + lane), change));
  }
  [[gnu::always_inline]] static V soften(const Softness<C>& soft, V full, V before) {
    return dot2(soft.massScale, full, soft.impulseScale, before);
  }
  static void note(const char*, V) {}

  [[gnu::always_inline]] static C factor(std::int32_t x) { return C(all(x)); }
  [[gnu::always_inline]] static V addProduct(V x, const C& factor, V to) { return product(factor, x) + to; }
  [[gnu::always_inline]] static bool differ(V a, V b) { return Vectors::any(a ^ b); }
  /// @param bits  of the square of a turning, over twice a bend; from 1 to 63
  [[gnu::always_inline]] static std::int32_t bend(std::int32_t turn, int bits) {
    const std::uint64_t one = std::uint64_t{1} << bits;
    const std::uint64_t square = static_cast<std::uint64_t>(std::int64_t{turn} * turn);
    const std::uint64_t bend = (square + (one >> 1)) >> bits;
    // Beyond half a radian it is no longer a parabola; the contact is found anew next step.
    const std::uint64_t eighth = (one + 8) >> 4;
    constexpr std::uint64_t kMost = Numbers::kRange / 2 - 1;
    const std::uint64_t most = eighth < kMost ? eighth : kMost;
    return static_cast<std::int32_t>(bend < most ? bend : most);
  }

  /// Notes where a speed or an impulse leaves the range.
  [[gnu::always_inline]] V checked(V v) {
    left_ = left_ | (v + Numbers::kRange);
    return v;
  }
  [[gnu::always_inline]] V checkedTurn(V v) { return checked(v); }
  [[gnu::always_inline]] V checkedSpeed(V v, int) { return checked(v); }
  [[gnu::always_inline]] V checkedChange(V v) {
    left_ = left_ | ((v << 2) + Numbers::kRange);
    return v;
  }
  [[gnu::always_inline]] V checkedTotal(V v) {
    left_ = left_ | ((v >> 2) + Numbers::kRange);
    return v;
  }
  [[gnu::always_inline]] V checkedWay(V v) {
    left_ = left_ | ((v << 1) + Numbers::kRange);
    return v;
  }
  std::uint64_t left() const {
    std::uint64_t any = 0;
    for (int i = 0; i < kWidth; ++i) any |= Vectors::at(left_, i) >> 29;
    return any;
  }

  [[gnu::always_inline]] static void gatherVelocity(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                    V& turn) {
    V none;
    Vectors::gather(bodies, &Body::velocity, at, x, y, turn, none);
  }
  [[gnu::always_inline]] static void gatherMoved(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                 V& turn, V& bend) {
    Vectors::gather(bodies, &Body::moved, at, x, y, turn, bend);
  }
  [[gnu::always_inline]] void scatterVelocity(Body* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                              V turn) {
    Vectors::scatter(bodies, at, fixed, checked(x), checked(y), checked(turn));
  }

 private:
  using Products = typename Vectors::Products;

  [[gnu::always_inline]] static Products times(const C& a, V b) { return Vectors::times(a, b); }
  template <int kBits>
  [[gnu::always_inline]] static V over(const Products& x) {
    return Vectors::template over<kBits>(x);
  }

  V left_{};
};

}  // namespace
}  // namespace samestep
