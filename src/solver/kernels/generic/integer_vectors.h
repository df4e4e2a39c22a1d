// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "solver/kernels/contact_block.h"

/// Vectors of integers for the kernels: what those of several processors have in common, and one number.
namespace samestep {
namespace {

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
