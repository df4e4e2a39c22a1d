// SPDX-License-Identifier: MIT
#pragma once

#include <wasm_simd128.h>

#include "solver/kernels/generic/integer_vectors.h"

namespace samestep {
namespace {

/// Two of 64 bits.
struct WideSimd128 {
  using V [[gnu::vector_size(16), gnu::may_alias]] = std::int64_t;
  using U [[gnu::vector_size(16), gnu::may_alias]] = std::uint64_t;
  using Loose [[gnu::vector_size(16), gnu::may_alias, gnu::aligned(8)]] = std::int64_t;
  using Body = SoftBody<WideNumbers>;

  [[gnu::always_inline]] static V widen(const std::int32_t* from) { return V{from[0], from[1]}; }
  [[gnu::always_inline]] static V multiply(V a, V b) {
    return reinterpret_cast<V>(wasm_i64x2_extmul_low_i32x4(low(a), low(b)));
  }
  template <int kBits>
  [[gnu::always_inline]] static V rounded(V x) {
    return (x + (std::int64_t{1} << (kBits - 1)) + (x >> 63)) >> kBits;
  }
  template <int kBits>
  [[gnu::always_inline]] static V down(V x) {
    return reinterpret_cast<V>(reinterpret_cast<U>(x) >> kBits);
  }
  [[gnu::always_inline]] static bool any(V v) { return wasm_v128_any_true(reinterpret_cast<v128_t>(v)); }
  [[gnu::always_inline]] static V mask(int bits) { return V{-(bits & 1), -(bits >> 1 & 1)}; }
  [[gnu::always_inline]] static void gather(const Body* bodies, std::int64_t (Body::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    const V* a = reinterpret_cast<const V*>(bodies[at[0]].*part);
    const V* b = reinterpret_cast<const V*>(bodies[at[1]].*part);
    x = __builtin_shufflevector(a[0], b[0], 0, 2);
    y = __builtin_shufflevector(a[0], b[0], 1, 3);
    z = __builtin_shufflevector(a[1], b[1], 0, 2);
    w = __builtin_shufflevector(a[1], b[1], 1, 3);
  }
  [[gnu::always_inline]] static void scatter(Body* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                             V turn) {
    for (int i = 0; i < 2; ++i) {
      if ((fixed >> i & 1) != 0) continue;
      std::int64_t* to = bodies[at[i]].velocity;
      to[0] = x[i];
      to[1] = y[i];
      to[2] = turn[i];
    }
  }

 private:
  /// The low halves, first.
  [[gnu::always_inline]] static v128_t low(V v) {
    return wasm_i32x4_shuffle(reinterpret_cast<v128_t>(v), reinterpret_cast<v128_t>(v), 0, 2, 0, 2);
  }
};

/// Four of 32 bits.
struct FastSimd128 {
  using V [[gnu::vector_size(16), gnu::may_alias]] = std::int32_t;
  using Loose [[gnu::vector_size(16), gnu::may_alias, gnu::aligned(4)]] = std::int32_t;
  using Body = SoftBody<FastNumbers>;
  /// Coefficients as they are.
  struct Coefficients {
    V value;

    [[gnu::always_inline]] explicit Coefficients(V v) : value(v) {}
    [[gnu::always_inline]] static Coefficients at(const std::int32_t* from) {
      return Coefficients(*reinterpret_cast<const Loose*>(from));
    }
    [[gnu::always_inline]] friend Coefficients operator-(const Coefficients& a, const Coefficients& b) {
      return Coefficients(a.value - b.value);
    }
  };
  struct Products {
    v128_t low, high;

    [[gnu::always_inline]] friend Products operator+(const Products& a, const Products& b) {
      return {wasm_i64x2_add(a.low, b.low), wasm_i64x2_add(a.high, b.high)};
    }
    [[gnu::always_inline]] friend Products operator-(const Products& a, const Products& b) {
      return {wasm_i64x2_sub(a.low, b.low), wasm_i64x2_sub(a.high, b.high)};
    }
  };

  [[gnu::always_inline]] static V greater(V a, V b) { return vector(wasm_i32x4_max(bits(a), bits(b))); }
  [[gnu::always_inline]] static V less(V a, V b) { return vector(wasm_i32x4_min(bits(a), bits(b))); }
  [[gnu::always_inline]] static bool any(V v) { return wasm_v128_any_true(bits(v)); }
  [[gnu::always_inline]] static V mask(int bits) {
    return V{-(bits & 1), -(bits >> 1 & 1), -(bits >> 2 & 1), -(bits >> 3 & 1)};
  }
  [[gnu::always_inline]] static std::uint64_t at(V v, int i) { return static_cast<std::uint32_t>(v[i]); }
  [[gnu::always_inline]] static Products times(const Coefficients& a, V b) {
    return {wasm_i64x2_extmul_low_i32x4(bits(a.value), bits(b)),
            wasm_i64x2_extmul_high_i32x4(bits(a.value), bits(b))};
  }
  template <int kBits>
  [[gnu::always_inline]] static V over(const Products& x) {
    const auto rounded = [](v128_t v) __attribute__((always_inline)) {
      const v128_t half = wasm_i64x2_const_splat(std::int64_t{1} << (kBits - 1));
      return wasm_i64x2_shr(wasm_i64x2_add(wasm_i64x2_add(v, half), wasm_i64x2_shr(v, 63)), kBits);
    };
    return vector(wasm_i32x4_shuffle(rounded(x.low), rounded(x.high), 0, 2, 4, 6));
  }
  [[gnu::always_inline]] static void gather(const Body* bodies, std::int32_t (Body::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    V row[4];
    for (int i = 0; i < 4; ++i) row[i] = *reinterpret_cast<const V*>(bodies[at[i]].*part);
    transpose(row);
    x = row[0];
    y = row[1];
    z = row[2];
    w = row[3];
  }
  [[gnu::always_inline]] static void scatter(Body* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                             V turn) {
    V row[4] = {x, y, turn, V{}};
    transpose(row);
    for (int i = 0; i < 4; ++i) {
      if ((fixed >> i & 1) == 0) *reinterpret_cast<V*>(bodies[at[i]].velocity) = row[i];
    }
  }

 private:
  [[gnu::always_inline]] static v128_t bits(V v) { return reinterpret_cast<v128_t>(v); }
  [[gnu::always_inline]] static V vector(v128_t v) { return reinterpret_cast<V>(v); }
  [[gnu::always_inline]] static void transpose(V row[4]) {
    const V a = __builtin_shufflevector(row[0], row[1], 0, 4, 1, 5);
    const V b = __builtin_shufflevector(row[0], row[1], 2, 6, 3, 7);
    const V c = __builtin_shufflevector(row[2], row[3], 0, 4, 1, 5);
    const V d = __builtin_shufflevector(row[2], row[3], 2, 6, 3, 7);
    row[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    row[1] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    row[2] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    row[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
  }
};

}  // namespace
}  // namespace samestep
