// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "contact_block.h"

namespace samestep {
namespace {

/// What is the same for every number of 64-bit integers side by side. `Vectors` gives the vector, the product
/// of the low 32 bits, and the shift. Every rounding is to nearest, ties away from zero: mirror images stay
/// mirror images.
template <class Vectors, class N>
class IntegerLanes {
 public:
  using Numbers = N;
  using Body = SoftBody<N>;
  using V = typename Vectors::V;
  static constexpr int kWidth = sizeof(V) / sizeof(std::int64_t);

  static int pointsOf(const ContactBlock<N>& block, int) { return block.points; }
  [[gnu::always_inline]] static V zero() { return V{}; }
  [[gnu::always_inline]] static V whole() { return all(1 << N::kUnitBits); }
  [[gnu::always_inline]] static V all(std::int64_t x) { return V{} + x; }
  [[gnu::always_inline]] static V load(const std::int32_t* from) { return Vectors::widen(from); }
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
  [[gnu::always_inline]] static V greater(V a, V b) { return select(a < b, b, a); }
  [[gnu::always_inline]] static V within(V x, V low, V high) {
    return select(x < low, low, select(high < x, high, x));
  }
  [[gnu::always_inline]] static Softness<V> softness(std::uint8_t stiff, int lane,
                                                     const Softness<std::int32_t>* of) {
    return {choose(stiff, lane, of[1].biasRate, of[0].biasRate),
            choose(stiff, lane, of[1].massScale, of[0].massScale),
            choose(stiff, lane, of[1].impulseScale, of[0].impulseScale)};
  }
  [[gnu::always_inline]] static V unless(std::uint8_t bits, int lane, V v) {
    return v & ~Vectors::mask(bits >> lane);
  }
  static void note(const char*, V) {}

  [[gnu::always_inline]] static void gatherVelocity(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                    V& turn) {
    V none;
    Vectors::gather(bodies, &Body::velocity, at, x, y, turn, none);
  }
  [[gnu::always_inline]] static void gatherMoved(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                 V& turn, V& bend) {
    Vectors::gather(bodies, &Body::moved, at, x, y, turn, bend);
  }

 private:
  [[gnu::always_inline]] static V choose(std::uint8_t bits, int lane, std::int64_t in, std::int64_t out) {
    return select(Vectors::mask(bits >> lane) != zero(), all(in), all(out));
  }
};

/// Speeds of 32 bits.
template <class Vectors>
class FastLanes : public IntegerLanes<Vectors, FastNumbers> {
  using Base = IntegerLanes<Vectors, FastNumbers>;

 public:
  using Numbers = FastNumbers;
  using Body = SoftBody<Numbers>;
  using V = typename Vectors::V;
  using Base::all, Base::load, Base::within;

  [[gnu::always_inline]] static V dot2(V a, V b, V c, V d) {
    return rounded<Numbers::kUnitBits>(multiply(a, b) + multiply(c, d));
  }
  [[gnu::always_inline]] static V cross2(V a, V b, V c, V d) {
    return rounded<Numbers::kUnitBits>(multiply(a, b) - multiply(c, d));
  }
  [[gnu::always_inline]] static V dotOf4(V a0, V b0, V a1, V b1, V a2, V b2, V a3, V b3) {
    return rounded<Numbers::kUnitBits>(multiply(a0, b0) + multiply(a1, b1) + multiply(a2, b2) +
                                       multiply(a3, b3));
  }
  [[gnu::always_inline]] static V product(V unit, V x) {
    return rounded<Numbers::kUnitBits>(multiply(unit, x));
  }
  [[gnu::always_inline]] static V frictionLimit(V friction, V sum) {
    return longProduct<Numbers::kFrictionBits>(friction, sum);
  }
  [[gnu::always_inline]] static V near(V separation, const SoftConstants<Numbers>& constants) {
    return within(separation, all(1 - Numbers::kRange), all(constants.mostGap));
  }
  [[gnu::always_inline]] static V rate(V way, std::int32_t rate) { return FastLanes::rate(way, all(rate)); }
  [[gnu::always_inline]] static V rate(V way, V rate) {
    return rounded<Numbers::kRateBits>(multiply(way, rate));
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinA(const BlockMoments<Numbers>&, const Axis& axis, int lane, V,
                                        V change) {
    return rounded<Numbers::kSpinBits>(multiply(load(axis.spinA + lane), change));
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinB(const BlockMoments<Numbers>&, const Axis& axis, int lane, V,
                                        V change) {
    return rounded<Numbers::kSpinBits>(multiply(load(axis.spinB + lane), change));
  }
  [[gnu::always_inline]] static V soften(const Softness<V>& soft, V full, V before) {
    return product(soft.massScale, full) + longProduct<Numbers::kUnitBits>(soft.impulseScale, before);
  }

  /// Notes where a number leaves the range.
  [[gnu::always_inline]] V checked(V v) {
    left_ = left_ | (v + Numbers::kRange);
    return v;
  }
  std::uint64_t left() const {
    std::uint64_t any = 0;
    for (int i = 0; i < Base::kWidth; ++i) any |= Vectors::at(left_, i) >> 31;
    return any;
  }
  [[gnu::always_inline]] void scatterVelocity(Body* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                              V turn) {
    Vectors::scatter(bodies, at, fixed, checked(x), checked(y), checked(turn));
  }

 private:
  [[gnu::always_inline]] static V multiply(V a, V b) { return Vectors::multiply(a, b); }
  /// x / 2^bits.
  template <int kBits>
  [[gnu::always_inline]] static V rounded(V x) {
    return Vectors::template rounded<kBits>(x);
  }
  /// factor * sum / 2^bits for a sum of up to 2^61 that is not negative, and a factor that is not.
  template <int kBits>
  [[gnu::always_inline]] static V longProduct(V factor, V sum) {
    const V low = sum & all((std::int64_t{1} << 31) - 1);
    const V high = Vectors::template down<31>(sum);
    const V half = all(std::int64_t{1} << (kBits - 1));
    return Vectors::template down<kBits>(multiply(factor, low) + half) +
           (multiply(factor, high) << (31 - kBits));
  }

  V left_{};
};

/// Speeds of 64 bits. A number is split at bit 32, its low half having a sign of its own, so that a product
/// with a coefficient is two of 32 by 32 bits, exact; one rounding ends each sum of products. The mirror image
/// of a number has the mirror images of its halves, but for a low half of -2^31, which has no part to round.
template <class Vectors>
class WideLanes : public IntegerLanes<Vectors, WideNumbers> {
  using Base = IntegerLanes<Vectors, WideNumbers>;

 public:
  using Numbers = WideNumbers;
  using Body = SoftBody<Numbers>;
  using V = typename Vectors::V;
  using Base::all, Base::load;

  [[gnu::always_inline]] static V dot2(V a, V b, V c, V d) {
    return (times(a, b) + times(c, d)).template over<Numbers::kUnitBits>();
  }
  [[gnu::always_inline]] static V cross2(V a, V b, V c, V d) {
    return (times(a, b) - times(c, d)).template over<Numbers::kUnitBits>();
  }
  [[gnu::always_inline]] static V dotOf4(V a0, V b0, V a1, V b1, V a2, V b2, V a3, V b3) {
    return (times(a0, b0) + times(a1, b1) + times(a2, b2) + times(a3, b3))
        .template over<Numbers::kUnitBits>();
  }
  [[gnu::always_inline]] static V product(V unit, V x) {
    return times(unit, x).template over<Numbers::kUnitBits>();
  }
  [[gnu::always_inline]] static V frictionLimit(V friction, V sum) {
    return times(friction, sum).template over<Numbers::kFrictionBits>();
  }
  [[gnu::always_inline]] static V near(V separation, const SoftConstants<Numbers>&) { return separation; }
  [[gnu::always_inline]] static V rate(V way, std::int32_t rate) { return WideLanes::rate(way, all(rate)); }
  [[gnu::always_inline]] static V rate(V way, V rate) {
    return times(rate, way).template over<Numbers::kRateBits>();
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinA(const BlockMoments<Numbers>&, const Axis& axis, int lane, V,
                                        V change) {
    return times(load(axis.spinA + lane), change).template over<Numbers::kSpinBits>();
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinB(const BlockMoments<Numbers>&, const Axis& axis, int lane, V,
                                        V change) {
    return times(load(axis.spinB + lane), change).template over<Numbers::kSpinBits>();
  }
  [[gnu::always_inline]] static V soften(const Softness<V>& soft, V full, V before) {
    return dot2(soft.massScale, full, soft.impulseScale, before);
  }
  /// Its ranges are kept by contract, see docs/ranges.md.
  [[gnu::always_inline]] static V checked(V v) { return v; }
  static std::uint64_t left() { return 0; }
  [[gnu::always_inline]] static void scatterVelocity(Body* bodies, const std::uint32_t* at, int fixed, V x,
                                                     V y, V turn) {
    Vectors::scatter(bodies, at, fixed, x, y, turn);
  }

 private:
  /// high * 2^32 + low.
  struct Products {
    V high, low;

    [[gnu::always_inline]] friend Products operator+(const Products& a, const Products& b) {
      return {a.high + b.high, a.low + b.low};
    }
    [[gnu::always_inline]] friend Products operator-(const Products& a, const Products& b) {
      return {a.high - b.high, a.low - b.low};
    }
    /// By 2^bits.
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

/// What vectors have in common whose processor shifts unsigned 64-bit numbers only. `Types` names the
/// vectors.
template <class Types>
struct UnsignedShifts : Types {
  using V = typename Types::V;
  using U = typename Types::U;

  template <int kBits>
  [[gnu::always_inline]] static V rounded(V x) {
    constexpr std::uint64_t kBias = std::uint64_t{1} << 63;
    const U raised = reinterpret_cast<U>(x) + (kBias + (std::uint64_t{1} << (kBits - 1)));
    return reinterpret_cast<V>(((raised - (reinterpret_cast<U>(x) >> 63)) >> kBits) - (kBias >> kBits));
  }
  template <int kBits>
  [[gnu::always_inline]] static V down(V x) {
    return reinterpret_cast<V>(reinterpret_cast<U>(x) >> kBits);
  }
};

/// One at a time, on every machine: for the fast kernel.
struct OneInteger {
  using V = std::int64_t;
  using Loose = V;

  static V widen(const std::int32_t* from) { return *from; }
  static V multiply(V a, V b) {
    return std::int64_t{static_cast<std::int32_t>(a)} * static_cast<std::int32_t>(b);
  }
  template <int kBits>
  static V rounded(V x) {
    return (x + (std::int64_t{1} << (kBits - 1)) - (x < 0)) >> kBits;
  }
  /// x / 2^bits, of an x that is not negative.
  template <int kBits>
  static V down(V x) {
    return x >> kBits;
  }
  static V mask(int bits) { return -V{bits & 1}; }
  static std::uint64_t at(V v, int) { return static_cast<std::uint64_t>(v); }
  using Body = SoftBody<FastNumbers>;
  static void gather(const Body* bodies, std::int32_t (Body::*part)[4], const std::uint32_t* at, V& x, V& y,
                     V& z, V& w) {
    const std::int32_t* from = bodies[*at].*part;
    x = from[0];
    y = from[1];
    z = from[2];
    w = from[3];
  }
  static void scatter(Body* bodies, const std::uint32_t* at, int fixed, V x, V y, V turn) {
    if ((fixed & 1) != 0) return;
    std::int32_t* to = bodies[*at].velocity;
    to[0] = static_cast<std::int32_t>(x);
    to[1] = static_cast<std::int32_t>(y);
    to[2] = static_cast<std::int32_t>(turn);
  }
};

}  // namespace
}  // namespace samestep
