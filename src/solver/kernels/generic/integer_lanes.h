// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>

#include "solver/kernels/contact_block.h"

/// The integer kernels, whatever the vectors. Every rounding is to nearest, ties away from zero: mirror
/// images stay mirror images.
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

/// The coefficients of a block, all of 32 bits, with the vectors of FastLanes.
template <class Vectors, class N>
class CoefficientLanes {
 public:
  using Numbers = N;
  using V = typename Vectors::V;
  using C = typename Vectors::Coefficients;
  static constexpr int kWidth = sizeof(V) / sizeof(std::int32_t);

  [[gnu::always_inline]] static V load(const std::int32_t* from) {
    return *reinterpret_cast<const typename Vectors::Loose*>(from);
  }
  [[gnu::always_inline]] static C coefficient(const std::int32_t* from) { return C::at(from); }
  [[gnu::always_inline]] static void store(std::int32_t* to, V v) {
    *reinterpret_cast<typename Vectors::Loose*>(to) = v;
  }
  [[gnu::always_inline]] static V dot2(const C& a, V b, const C& c, V d) {
    return over<N::kUnitBits>(Vectors::times(a, b) + Vectors::times(c, d));
  }
  [[gnu::always_inline]] static V cross2(const C& a, V b, const C& c, V d) {
    return over<N::kUnitBits>(Vectors::times(a, b) - Vectors::times(c, d));
  }
  [[gnu::always_inline]] static V product(const C& unit, V x) {
    return over<N::kUnitBits>(Vectors::times(unit, x));
  }
  /// Rounding may have made it larger than 1.
  [[gnu::always_inline]] static V arm(V v) {
    return Vectors::less(Vectors::greater(v, all(-kOne)), all(kOne));
  }
  /// Spin by an impulse: moments of less than 16 are promised to FastLanes; those below 32, the most that 32
  /// bits hold, do for WideLanes.
  [[gnu::always_inline]] V spin(const C& moment, V arm) {
    const V spin = over<N::kUnitBits>(Vectors::times(moment, arm));
    left_ = left_ | (spin + (1 << 30));
    return spin;
  }
  /// 1 / (1 + spinA armA + spinB armB), to 2^-27 of it: Newton's way to the inverse of x in [1/2, 1).
  [[gnu::always_inline]] static V mass(V present, V spinA, V armA, V spinB, V armB) {
    // At most 65, so that x has the 31 bits of a positive number.
    const V sum = over<N::kSpinBits + N::kUnitBits - 24>(Vectors::times(C(spinA), armA) +
                                                         Vectors::times(C(spinB), armB)) +
                  (1 << 24);
    const auto below = [](V v, std::int32_t limit) __attribute__((always_inline)) { return all(limit) > v; };
    V x = sum;
    const auto by16 = below(x, 1 << 27);
    x = by16 ? x << 4 : x;
    const auto by4 = below(x, 1 << 29);
    x = by4 ? x << 2 : x;
    const auto by2 = below(x, 1 << 30);
    x = by2 ? x << 1 : x;
    // Within 1/17 by a line; each step squares what is missing. Of 29 bits, for it goes up to 2.
    const C byX(x);
    V inverse = all(1515870810) - over<31>(Vectors::times(byX, all(1010580541)));
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      const V rest = all(kOne) - over<31>(Vectors::times(byX, inverse));
      inverse = over<29>(Vectors::times(C(inverse), rest));
    }
    V mass = by16 ? inverse : inverse >> 4;
    mass = by4 ? mass : mass >> 2;
    mass = by2 ? mass << 1 : mass;
    // Exact where nothing turns: head on, speeds are then, too.
    mass = below(sum, (1 << 24) + 1) ? all(kOne) : Vectors::less(mass, all(kOne));
    return mass & present;
  }
  std::uint64_t left() const {
    if constexpr (std::same_as<N, FastNumbers>) {
      std::uint64_t any = 0;
      for (int i = 0; i < kWidth; ++i) any |= Vectors::at(left_, i) >> 31;
      return any;
    }
    return 0;
  }

 private:
  static constexpr std::int32_t kOne = 1 << N::kUnitBits;

  [[gnu::always_inline]] static V all(std::int32_t x) { return V{} + x; }
  template <int kBits>
  [[gnu::always_inline]] static V over(const typename Vectors::Products& x) {
    return Vectors::template over<kBits>(x);
  }

  V left_{};
};

/// Shifts that vectors of 64-bit integers have in common whose processor shifts unsigned ones only. `Types`
/// names the vectors.
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

/// Products of 32-bit integers side by side in 64 bits: those of the even places and those of the odd ones,
/// from the low halves. `Types` names the vectors and multiplies.
template <class Types>
struct EvenAndOdd {
  using V = typename Types::Half;
  using U = typename Types::U;
  struct Products {
    U even, odd;

    [[gnu::always_inline]] friend Products operator+(const Products& a, const Products& b) {
      return {a.even + b.even, a.odd + b.odd};
    }
    [[gnu::always_inline]] friend Products operator-(const Products& a, const Products& b) {
      return {a.even - b.even, a.odd - b.odd};
    }
  };

  /// In the low halves, what is in the even places and in the odd ones.
  struct Coefficients {
    U even, odd;

    Coefficients() = default;
    [[gnu::always_inline]] explicit Coefficients(V v) : even(reinterpret_cast<U>(v)), odd(even >> 32) {}
    /// The odd ones by a load that begins one place later: the array is not the last of its block.
    [[gnu::always_inline]] static Coefficients at(const std::int32_t* from) {
      Coefficients c;
      c.even = reinterpret_cast<U>(*reinterpret_cast<const typename Types::LooseHalf*>(from));
      c.odd = reinterpret_cast<U>(*reinterpret_cast<const typename Types::LooseHalf*>(from + 1));
      return c;
    }
    [[gnu::always_inline]] friend Coefficients operator-(const Coefficients& a, const Coefficients& b) {
      Coefficients c;
      c.even = a.even - b.even;
      c.odd = a.odd - b.odd;
      return c;
    }
  };

  [[gnu::always_inline]] static Products times(const Coefficients& a, V b) {
    return {Types::multiply(a.even, reinterpret_cast<U>(b)),
            Types::multiply(a.odd, reinterpret_cast<U>(b) >> 32)};
  }
  /// The low 32 bits of each, by 2^bits.
  template <int kBits>
  [[gnu::always_inline]] static V over(const Products& x) {
    constexpr std::uint64_t kHalf = std::uint64_t{1} << (kBits - 1);
    const U even = (x.even + kHalf - (x.even >> 63)) >> kBits;
    const U odd = (x.odd + kHalf - (x.odd >> 63)) << (32 - kBits);
    return reinterpret_cast<V>(Types::oddOf(even, odd));
  }
};

/// A 32-bit integer that wraps.
struct OneInteger {
  std::int32_t value = 0;

  friend OneInteger operator+(OneInteger a, OneInteger b) { return wrap(a.bits() + b.bits()); }
  friend OneInteger operator-(OneInteger a, OneInteger b) { return wrap(a.bits() - b.bits()); }
  friend OneInteger operator-(OneInteger a) { return wrap(0 - a.bits()); }
  friend OneInteger operator+(OneInteger a, std::int32_t b) { return a + OneInteger{b}; }
  friend OneInteger operator&(OneInteger a, OneInteger b) { return {a.value & b.value}; }
  friend OneInteger operator|(OneInteger a, OneInteger b) { return {a.value | b.value}; }
  friend OneInteger operator^(OneInteger a, OneInteger b) { return {a.value ^ b.value}; }
  friend OneInteger operator~(OneInteger a) { return {~a.value}; }
  friend OneInteger operator>>(OneInteger a, int bits) { return {a.value >> bits}; }
  friend OneInteger operator<<(OneInteger a, int bits) { return wrap(a.bits() << bits); }
  friend bool operator>(OneInteger a, OneInteger b) { return a.value > b.value; }

 private:
  std::uint32_t bits() const { return static_cast<std::uint32_t>(value); }
  static OneInteger wrap(std::uint32_t bits) { return {static_cast<std::int32_t>(bits)}; }
};

/// One at a time, on every machine: for the fast kernel.
struct OneAtATime {
  using V = OneInteger;
  using Loose = V;
  struct Coefficients : OneInteger {
    explicit Coefficients(OneInteger x) : OneInteger(x) {}
    static Coefficients at(const std::int32_t* from) { return Coefficients({*from}); }
    friend Coefficients operator-(Coefficients a, Coefficients b) {
      return Coefficients(OneInteger(a) - OneInteger(b));
    }
  };
  struct Products {
    std::int64_t value;
    friend Products operator+(Products a, Products b) { return wrap(a.bits() + b.bits()); }
    friend Products operator-(Products a, Products b) { return wrap(a.bits() - b.bits()); }
    std::uint64_t bits() const { return static_cast<std::uint64_t>(value); }
    static Products wrap(std::uint64_t bits) { return {static_cast<std::int64_t>(bits)}; }
  };
  using Body = SoftBody<FastNumbers>;

  static V greater(V a, V b) { return b > a ? b : a; }
  static V less(V a, V b) { return a > b ? b : a; }
  static V mask(int bits) { return {-(bits & 1)}; }
  static bool any(V v) { return v.value != 0; }
  static std::uint64_t at(V v, int) { return static_cast<std::uint32_t>(v.value); }
  static Products times(Coefficients a, V b) { return {std::int64_t{a.value} * b.value}; }
  template <int kBits>
  static V over(Products x) {
    const std::uint64_t raised = x.bits() + (std::uint64_t{1} << (kBits - 1)) - (x.bits() >> 63);
    return {static_cast<std::int32_t>(static_cast<std::uint32_t>(raised >> kBits))};
  }
  static void gather(const Body* bodies, std::int32_t (Body::*part)[4], const std::uint32_t* at, V& x, V& y,
                     V& z, V& w) {
    const std::int32_t* from = bodies[*at].*part;
    x = {from[0]};
    y = {from[1]};
    z = {from[2]};
    w = {from[3]};
  }
  static void scatter(Body* bodies, const std::uint32_t* at, int fixed, V x, V y, V turn) {
    if ((fixed & 1) != 0) return;
    std::int32_t* to = bodies[*at].velocity;
    to[0] = x.value;
    to[1] = y.value;
    to[2] = turn.value;
  }
};

}  // namespace
}  // namespace samestep
