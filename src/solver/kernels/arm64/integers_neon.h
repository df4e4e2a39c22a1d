// SPDX-License-Identifier: MIT
#pragma once

#include <arm_neon.h>

#include "solver/kernels/generic/integer_vectors.h"

namespace samestep {
namespace {

/// Two of 64 bits.
struct WideNeon {
  using V [[gnu::vector_size(16), gnu::may_alias]] = std::int64_t;
  using U [[gnu::vector_size(16), gnu::may_alias]] = std::uint64_t;
  using Loose [[gnu::vector_size(16), gnu::may_alias, gnu::aligned(8)]] = std::int64_t;
  using Body = SoftBody<WideNumbers>;

  [[gnu::always_inline]] static V widen(const std::int32_t* from) {
    return reinterpret_cast<V>(vmovl_s32(vld1_s32(from)));
  }
  [[gnu::always_inline]] static V multiply(V a, V b) {
    return reinterpret_cast<V>(
        vmull_s32(vmovn_s64(reinterpret_cast<int64x2_t>(a)), vmovn_s64(reinterpret_cast<int64x2_t>(b))));
  }
  template <int kBits>
  [[gnu::always_inline]] static V rounded(V x) {
    return (x + (std::int64_t{1} << (kBits - 1)) + (x >> 63)) >> kBits;
  }
  template <int kBits>
  [[gnu::always_inline]] static V down(V x) {
    return reinterpret_cast<V>(reinterpret_cast<U>(x) >> kBits);
  }
  [[gnu::always_inline]] static bool any(V v) { return vmaxvq_u32(reinterpret_cast<uint32x4_t>(v)) != 0; }
  [[gnu::always_inline]] static V mask(int bits) { return V{-(bits & 1), -(bits >> 1 & 1)}; }
  [[gnu::always_inline]] static void gather(const Body* bodies, std::int64_t (Body::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    const int64x2x2_t a = vld1q_s64_x2(bodies[at[0]].*part);
    const int64x2x2_t b = vld1q_s64_x2(bodies[at[1]].*part);
    x = reinterpret_cast<V>(vzip1q_s64(a.val[0], b.val[0]));
    y = reinterpret_cast<V>(vzip2q_s64(a.val[0], b.val[0]));
    z = reinterpret_cast<V>(vzip1q_s64(a.val[1], b.val[1]));
    w = reinterpret_cast<V>(vzip2q_s64(a.val[1], b.val[1]));
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
};

/// Four of 32 bits.
struct FastNeon {
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
    int64x2_t low, high;

    [[gnu::always_inline]] friend Products operator+(const Products& a, const Products& b) {
      return {vaddq_s64(a.low, b.low), vaddq_s64(a.high, b.high)};
    }
    [[gnu::always_inline]] friend Products operator-(const Products& a, const Products& b) {
      return {vsubq_s64(a.low, b.low), vsubq_s64(a.high, b.high)};
    }
  };

  [[gnu::always_inline]] static V greater(V a, V b) { return vector(vmaxq_s32(bits(a), bits(b))); }
  [[gnu::always_inline]] static V less(V a, V b) { return vector(vminq_s32(bits(a), bits(b))); }
  [[gnu::always_inline]] static bool any(V v) { return vmaxvq_u32(reinterpret_cast<uint32x4_t>(v)) != 0; }
  [[gnu::always_inline]] static V mask(int bits) {
    return V{-(bits & 1), -(bits >> 1 & 1), -(bits >> 2 & 1), -(bits >> 3 & 1)};
  }
  [[gnu::always_inline]] static std::uint64_t at(V v, int i) { return static_cast<std::uint32_t>(v[i]); }
  [[gnu::always_inline]] static Products times(const Coefficients& a, V b) {
    return {vmull_s32(vget_low_s32(bits(a.value)), vget_low_s32(bits(b))),
            vmull_high_s32(bits(a.value), bits(b))};
  }
  template <int kBits>
  [[gnu::always_inline]] static V over(const Products& x) {
    const auto rounded = [](int64x2_t v) __attribute__((always_inline)) {
      const int64x2_t half = vdupq_n_s64(std::int64_t{1} << (kBits - 1));
      return vshrn_n_s64(vaddq_s64(vaddq_s64(v, half), vshrq_n_s64(v, 63)), kBits);
    };
    return vector(vcombine_s32(rounded(x.low), rounded(x.high)));
  }
  [[gnu::always_inline]] static void gather(const Body* bodies, std::int32_t (Body::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    int32x4_t row[4];
    for (int i = 0; i < 4; ++i) row[i] = vld1q_s32(bodies[at[i]].*part);
    transpose(row);
    x = vector(row[0]);
    y = vector(row[1]);
    z = vector(row[2]);
    w = vector(row[3]);
  }
  [[gnu::always_inline]] static void scatter(Body* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                             V turn) {
    int32x4_t row[4] = {bits(x), bits(y), bits(turn), vdupq_n_s32(0)};
    transpose(row);
    for (int i = 0; i < 4; ++i) {
      if ((fixed >> i & 1) == 0) vst1q_s32(bodies[at[i]].velocity, row[i]);
    }
  }

 private:
  [[gnu::always_inline]] static int32x4_t bits(V v) { return reinterpret_cast<int32x4_t>(v); }
  [[gnu::always_inline]] static V vector(int32x4_t v) { return reinterpret_cast<V>(v); }
  [[gnu::always_inline]] static void transpose(int32x4_t row[4]) {
    const int64x2_t a = vreinterpretq_s64_s32(vzip1q_s32(row[0], row[1]));
    const int64x2_t b = vreinterpretq_s64_s32(vzip2q_s32(row[0], row[1]));
    const int64x2_t c = vreinterpretq_s64_s32(vzip1q_s32(row[2], row[3]));
    const int64x2_t d = vreinterpretq_s64_s32(vzip2q_s32(row[2], row[3]));
    row[0] = vreinterpretq_s32_s64(vzip1q_s64(a, c));
    row[1] = vreinterpretq_s32_s64(vzip2q_s64(a, c));
    row[2] = vreinterpretq_s32_s64(vzip1q_s64(b, d));
    row[3] = vreinterpretq_s32_s64(vzip2q_s64(b, d));
  }
};

}  // namespace
}  // namespace samestep
