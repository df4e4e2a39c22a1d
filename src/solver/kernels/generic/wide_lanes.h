// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

#include "solver/kernels/contact_block.h"

/// Integer kernels, whatever the vectors. Every rounding is to nearest, ties away from zero: mirror images
/// stay mirror images.
namespace samestep {
namespace {

/// Speeds of 64 bits. `Vectors` gives the vector of 64-bit integers, the product of the low 32 bits, and the
/// shifts. A number is split at bit 32, its low half having a sign of its own, so that a product with a
/// coefficient is two of 32 by 32 bits, exact; one rounding ends each sum of products. The mirror image of a
/// number has the mirror images of its halves, but for a low half of -2^31, which has no part to round.
template <class Vectors>
class WideLanes {
 public:
  using Numbers = WideNumbers;
  using Body = SoftBody<Numbers>;
  using V = typename Vectors::V;
  using C = V;
  static constexpr int kWidth = sizeof(V) / sizeof(std::int64_t);

  static int pointsOf(const ContactBlock<Numbers>& block, int) { return block.points; }
  [[gnu::always_inline]] static V zero() { return V{}; }
  [[gnu::always_inline]] static V all(std::int64_t x) { return V{} + x; }
  [[gnu::always_inline]] static C coefficient(const std::int32_t* from) { return Vectors::widen(from); }
  [[gnu::always_inline]] static V load(const std::int64_t* from) {
    return *reinterpret_cast<const typename Vectors::Loose*>(from);
  }
  [[gnu::always_inline]] static void store(std::int64_t* to, V v) {
    *reinterpret_cast<typename Vectors::Loose*>(to) = v;
  }
  template <class Mask>
  [[gnu::always_inline]] static V select(Mask mask, V a, V b) {
    return mask ? a : b;
  }
  [[gnu::always_inline]] static auto above(V a, V b) { return a > b; }
  /// Few processors have these of 64 bits.
  static constexpr bool kHasGreater = requires(V v) { Vectors::greater(v, v); };
  [[gnu::always_inline]] static V greater(V a, V b) {
    if constexpr (kHasGreater) return Vectors::greater(a, b);
    return select(a < b, b, a);
  }
  /// x held within [low, high].
  [[gnu::always_inline]] static V within(V x, V low, V high) {
    if constexpr (kHasGreater) return Vectors::greater(Vectors::less(x, high), low);
    return select(x < low, low, select(high < x, high, x));
  }
  [[gnu::always_inline]] static V pushing(V sum, const SoftConstants<Numbers>& constants) {
    return within(sum, zero(), all(constants.mostSum));
  }
  [[gnu::always_inline]] static Softness<V> softness(int stiff, int lane, const Softness<std::int32_t>* of) {
    const V mask = Vectors::mask(stiff >> lane);
    const auto choose = [&](std::int64_t in, std::int64_t out) __attribute__((always_inline)) {
      return select(mask != zero(), all(in), all(out));
    };
    return {choose(of[1].biasRate, of[0].biasRate), choose(of[1].massScale, of[0].massScale),
            choose(of[1].impulseScale, of[0].impulseScale)};
  }
  [[gnu::always_inline]] static V unless(int bits, int lane, V v) { return v & ~Vectors::mask(bits >> lane); }

  [[gnu::always_inline]] static V dot2(V a, V b, V c, V d) {
    return (times(a, b) + times(c, d)).template over<Numbers::kUnitBits>();
  }
  [[gnu::always_inline]] static V cross2(V a, V b, V c, V d) {
    return (times(a, b) - times(c, d)).template over<Numbers::kUnitBits>();
  }
  [[gnu::always_inline]] static V crosses(V a, V b, V c, V d, V e, V f, V g, V h) {
    return ((times(a, b) - times(c, d)) + (times(e, f) - times(g, h))).template over<Numbers::kUnitBits>();
  }
  [[gnu::always_inline]] static V product(V unit, V x) {
    return times(unit, x).template over<Numbers::kUnitBits>();
  }
  [[gnu::always_inline]] static V frictionLimit(const ContactBlock<Numbers>&, V friction, V sum) {
    const V limit = times(friction, sum).template over<Numbers::kFrictionBits>();
    return select(limit > all(Numbers::kMostLimit), all(Numbers::kMostLimit), limit);
  }
  [[gnu::always_inline]] static V near(V separation, const SoftConstants<Numbers>& constants) {
    return within(separation, all(-constants.mostOverlap), all(constants.mostGap));
  }
  [[gnu::always_inline]] static V rate(V way, std::int32_t rate) { return WideLanes::rate(way, all(rate)); }
  [[gnu::always_inline]] static V rate(V way, V rate) {
    return times(rate, way).template over<Numbers::kRateBits>();
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinA(const BlockMoments<Numbers>&, const Axis& axis, int lane, V,
                                        V change) {
    return times(coefficient(axis.spinA + lane), change).template over<Numbers::kSpinBits>();
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinB(const BlockMoments<Numbers>&, const Axis& axis, int lane, V,
                                        V change) {
    return times(coefficient(axis.spinB + lane), change).template over<Numbers::kSpinBits>();
  }
  [[gnu::always_inline]] static V soften(const Softness<V>& soft, V full, V before) {
    return dot2(soft.massScale, full, soft.impulseScale, before);
  }
  static void note(const char*, V) {}

  /// Factor in [0, 1], in units of 2^-32: 0 or 1, and a part of 32 bits with a sign.
  struct Factor {
    V whole, part;
  };
  [[gnu::always_inline]] static Factor factor(std::int64_t x) {
    return {all(-((x + (std::int64_t{1} << 31)) >> 32)), all(x)};
  }
  /// x * factor + to, rounded once as mulAdd of Fixed is, to nearest, ties to even.
  [[gnu::always_inline]] static V addProduct(V x, const Factor& factor, V to) {
    constexpr std::int64_t kHalf = std::int64_t{1} << 31;
    const Products product = times(factor.part, x);
    // Shifted with its sign: shifts of unsigned numbers are what every processor has.
    const V high = Vectors::template down<32>(product.low + std::numeric_limits<std::int64_t>::min()) - kHalf;
    const V floor = to + (x & factor.whole) + product.high + high;
    const V rest = (product.low & 0xffffffff) + (kHalf - 1) + (floor & 1);
    return floor + Vectors::template down<32>(rest);
  }
  [[gnu::always_inline]] static bool differ(V a, V b) { return Vectors::any(a ^ b); }
  /// @param bits  of a turning by the radius, over one in radians
  [[gnu::always_inline]] static std::int64_t bend(std::int64_t turn, int bits) {
    const std::uint64_t half = (std::uint64_t{1} << bits) >> 1;
    const std::uint64_t size = static_cast<std::uint64_t>(turn < 0 ? -turn : turn);
    // Beyond half a radian it is no longer a parabola; the contact is found anew next step.
    constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
    const std::uint64_t angle = (size + half) >> bits < kMost ? (size + half) >> bits : kMost;
    const std::uint64_t square = angle * angle;
    const std::uint64_t rounded = (square + (kMost - 1) + (square >> 32 & 1)) >> 32;
    return static_cast<std::int64_t>((rounded + (rounded >> 1 & 1)) >> 1 << bits);
  }

  /// Clamped values keep the rest in range, see docs/ranges.md.
  [[gnu::always_inline]] static V checked(V v) { return v; }
  [[gnu::always_inline]] static V checkedTurn(V v) { return v; }
  [[gnu::always_inline]] static V checkedSpeed(V v, int) {
    if (Vectors::any(beyond(v))) [[unlikely]]
      v = held(v);
    return v;
  }
  [[gnu::always_inline]] static V checkedChange(V v) { return v; }
  [[gnu::always_inline]] static V checkedTotal(V v) { return v; }
  [[gnu::always_inline]] static V checkedWay(V v) { return v; }
  static std::uint64_t left() { return 0; }

  [[gnu::always_inline]] static void gatherVelocity(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                    V& turn) {
    V none;
    Vectors::gather(bodies, &Body::velocity, at, x, y, turn, none);
  }
  [[gnu::always_inline]] static void gatherMoved(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                 V& turn, V& bend) {
    Vectors::gather(bodies, &Body::moved, at, x, y, turn, bend);
  }
  [[gnu::always_inline]] static void scatterVelocity(Body* bodies, const std::uint32_t* at, int fixed, V x,
                                                     V y, V turn) {
    if (Vectors::any(beyond(x) | beyond(y) | beyond(turn))) [[unlikely]] {
      x = held(x);
      y = held(y);
      turn = held(turn);
    }
    Vectors::scatter(bodies, at, fixed, x, y, turn);
  }

 private:
  [[gnu::always_inline]] static V held(V speed) {
    return within(speed, all(-Numbers::kMostSpeed), all(Numbers::kMostSpeed));
  }
  /// Not 0 where a speed is to be held; also where it is the limit itself.
  [[gnu::always_inline]] static V beyond(V speed) {
    return (speed + Numbers::kMostSpeed) & ~(2 * Numbers::kMostSpeed - 1);
  }
  /// high * 2^32 + low.
  struct Products {
    V high, low;

    [[gnu::always_inline]] friend Products operator+(const Products& a, const Products& b) {
      return {a.high + b.high, a.low + b.low};
    }
    [[gnu::always_inline]] friend Products operator-(const Products& a, const Products& b) {
      return {a.high - b.high, a.low - b.low};
    }
    /// Divides by 2^bits.
    template <int kBits>
    [[gnu::always_inline]] V over() const {
      return (high << (32 - kBits)) + Vectors::template rounded<kBits>(low);
    }
  };
  [[gnu::always_inline]] static Products times(V coefficient, V x) {
    return {Vectors::multiply(coefficient, Vectors::template down<32>(x + (std::int64_t{1} << 31))),
            Vectors::multiply(coefficient, x)};
  }
};

}  // namespace
}  // namespace samestep
