// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "solver/kernels/contact_block.h"

namespace samestep {
namespace {

/// The operations that choose, by vectors of the compiler. `Types` names them.
template <class Types>
struct ChosenDoubles : Types {
  using Numbers = typename Types::Numbers;
  using Masks = typename Types::Masks;

  /// All ones in the lanes whose bit is set.
  [[gnu::always_inline]] static Masks mask(int bits) {
    return *reinterpret_cast<const Masks*>(kMasks.of[bits & ((1 << kWidth) - 1)]);
  }
  [[gnu::always_inline]] static Numbers select(Masks mask, Numbers a, Numbers b) { return mask ? a : b; }
  [[gnu::always_inline]] static Masks above(Numbers a, Numbers b) { return a > b; }
  [[gnu::always_inline]] static Numbers greater(Numbers a, Numbers b) { return a < b ? b : a; }
  [[gnu::always_inline]] static Numbers within(Numbers x, Numbers low, Numbers high) {
    return select(x < low, low, select(high < x, high, x));
  }
  [[gnu::always_inline]] static bool differ(Numbers a, Numbers b) {
    const Masks which = a != b;
    std::int64_t any = 0;
    for (int i = 0; i < kWidth; ++i) any |= which[i];
    return any != 0;
  }

 private:
  static constexpr int kWidth = sizeof(Numbers) / sizeof(double);
  struct Table {
    alignas(32) std::int64_t of[1 << kWidth][kWidth];
  };
  static constexpr Table kMasks = [] {
    Table table{};
    for (int bits = 0; bits < 1 << kWidth; ++bits) {
      for (int lane = 0; lane < kWidth; ++lane) table.of[bits][lane] = -(bits >> lane & 1);
    }
    return table;
  }();
};

/// Arithmetic that is the same for every number of doubles side by side: element by element that of double.
template <class Vectors>
struct DoubleLanes {
  using Numbers = PlainNumbers<double, false>;
  using Body = SoftBody<Numbers>;
  using V = typename Vectors::Numbers;
  using C = V;
  using M = typename Vectors::Masks;
  static constexpr int kWidth = sizeof(V) / sizeof(double);

  /// Points of the whole block, whatever the width: a point that does nothing still turns -0 into 0.
  static int pointsOf(const ContactBlock<Numbers>& block, int) { return block.points; }
  [[gnu::always_inline]] static V zero() { return V{}; }
  [[gnu::always_inline]] static V whole() { return all(1.0); }
  [[gnu::always_inline]] static V all(double x) { return x - V{}; }
  [[gnu::always_inline]] static V load(const double* from) { return *reinterpret_cast<const V*>(from); }
  [[gnu::always_inline]] static C coefficient(const double* from) { return load(from); }
  [[gnu::always_inline]] static void store(double* to, V v) { *reinterpret_cast<V*>(to) = v; }
  [[gnu::always_inline]] static V select(M mask, V a, V b) { return Vectors::select(mask, a, b); }
  [[gnu::always_inline]] static M above(V a, V b) { return Vectors::above(a, b); }
  [[gnu::always_inline]] static V greater(V a, V b) { return Vectors::greater(a, b); }
  [[gnu::always_inline]] static V within(V x, V low, V high) { return Vectors::within(x, low, high); }
  [[gnu::always_inline]] static V dot2(V a, V b, V c, V d) { return a * b + c * d; }
  [[gnu::always_inline]] static V cross2(V a, V b, V c, V d) { return a * b - c * d; }
  [[gnu::always_inline]] static V crosses(V a, V b, V c, V d, V e, V f, V g, V h) {
    return (a * b - c * d) + (e * f - g * h);
  }
  [[gnu::always_inline]] static V near(V separation, const SoftConstants<Numbers>&) { return separation; }
  [[gnu::always_inline]] static V product(V a, V b) { return a * b; }
  [[gnu::always_inline]] static V frictionLimit(const ContactBlock<Numbers>&, V friction, V sum) {
    return friction * sum;
  }
  [[gnu::always_inline]] static V pushing(V sum, const SoftConstants<Numbers>& constants) {
    return within(sum, zero(), all(constants.mostSum));
  }
  [[gnu::always_inline]] static V rate(V way, double rate) { return way * all(rate); }
  [[gnu::always_inline]] static V rate(V way, V rate) { return way * rate; }
  template <class Axis>
  [[gnu::always_inline]] static V spinA(const BlockMoments<Numbers>& of, const Axis&, int lane, V arm,
                                        V change) {
    return load(of.momentA + lane) * (arm * change);
  }
  template <class Axis>
  [[gnu::always_inline]] static V spinB(const BlockMoments<Numbers>& of, const Axis&, int lane, V arm,
                                        V change) {
    return load(of.momentB + lane) * (arm * change);
  }
  [[gnu::always_inline]] static V arm(V v) { return v; }
  [[gnu::always_inline]] static V spin(V moment, V arm) { return moment * arm; }
  [[gnu::always_inline]] static V mass(V present, V spinA, V armA, V spinB, V armB) {
    return present / (whole() + (spinA * armA + spinB * armB));
  }
  static void note(const char*, V) {}
  [[gnu::always_inline]] static V factor(double x) { return all(x); }
  [[gnu::always_inline]] static V addProduct(V x, V factor, V to) { return x * factor + to; }
  [[gnu::always_inline]] static bool differ(V a, V b) { return Vectors::differ(a, b); }
  /// Beyond half a radian it is no longer a parabola; the contact is found anew next step.
  [[gnu::always_inline]] static double bend(double turn, int) {
    const double angle = turn < -1.0 ? -1.0 : 1.0 < turn ? 1.0 : turn;
    const double bend = angle * angle * 0.5;
    return 0.125 < bend ? 0.125 : bend;
  }
  /// A double leaves no range.
  [[gnu::always_inline]] static V checked(V v) { return v; }
  [[gnu::always_inline]] static V checkedTurn(V v) { return v; }
  [[gnu::always_inline]] static V checkedSpeed(V v, int) { return v; }
  [[gnu::always_inline]] static V checkedChange(V v) { return v; }
  [[gnu::always_inline]] static V checkedTotal(V v) { return v; }
  [[gnu::always_inline]] static V checkedWay(V v) { return v; }
  static std::uint64_t left() { return 0; }

  [[gnu::always_inline]] static V unless(int bits, int lane, V v) {
    return Vectors::select(Vectors::mask(bits >> lane), zero(), v);
  }
  [[gnu::always_inline]] static V soften(const Softness<V>& soft, V full, V before) {
    return soft.massScale * full + soft.impulseScale * before;
  }
  [[gnu::always_inline]] static Softness<V> softness(int stiff, int lane, const Softness<double>* of) {
    const M mask = Vectors::mask(stiff >> lane);
    return {select(mask, all(of[1].biasRate), all(of[0].biasRate)),
            select(mask, all(of[1].massScale), all(of[0].massScale)),
            select(mask, all(of[1].impulseScale), all(of[0].impulseScale))};
  }
};

}  // namespace
}  // namespace samestep
