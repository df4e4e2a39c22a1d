// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdint>

#include "solver/kernels/contact_block.h"

/// Integer kernels, whatever the vectors. Every rounding is to nearest, ties away from zero: mirror images
/// stay mirror images.
namespace samestep {
namespace {

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

}  // namespace
}  // namespace samestep
