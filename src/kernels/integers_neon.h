// SPDX-License-Identifier: MIT
#pragma once

#include <arm_neon.h>

#include "integer_lanes.h"

namespace samestep {
namespace {

/// Two at a time: NEON of 64-bit ARM.
struct TwoIntegersOfNeon {
  using V [[gnu::vector_size(16), gnu::may_alias]] = std::int64_t;
  using U [[gnu::vector_size(16), gnu::may_alias]] = std::uint64_t;
  using Loose [[gnu::vector_size(16), gnu::may_alias, gnu::aligned(8)]] = std::int64_t;
  using Fast = SoftBody<FastNumbers>;
  using Wide = SoftBody<WideNumbers>;

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
  [[gnu::always_inline]] static V mask(int bits) { return V{-(bits & 1), -(bits >> 1 & 1)}; }
  [[gnu::always_inline]] static std::uint64_t at(V v, int i) { return static_cast<std::uint64_t>(v[i]); }

  [[gnu::always_inline]] static void gather(const Fast* bodies, std::int32_t (Fast::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    const int32x4_t a = vld1q_s32(bodies[at[0]].*part);
    const int32x4_t b = vld1q_s32(bodies[at[1]].*part);
    const int32x4_t xy = vzip1q_s32(a, b);
    const int32x4_t zw = vzip2q_s32(a, b);
    x = reinterpret_cast<V>(vmovl_s32(vget_low_s32(xy)));
    y = reinterpret_cast<V>(vmovl_high_s32(xy));
    z = reinterpret_cast<V>(vmovl_s32(vget_low_s32(zw)));
    w = reinterpret_cast<V>(vmovl_high_s32(zw));
  }
  [[gnu::always_inline]] static void scatter(Fast* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                             V turn) {
    for (int i = 0; i < 2; ++i) {
      if ((fixed >> i & 1) != 0) continue;
      std::int32_t* to = bodies[at[i]].velocity;
      to[0] = static_cast<std::int32_t>(x[i]);
      to[1] = static_cast<std::int32_t>(y[i]);
      to[2] = static_cast<std::int32_t>(turn[i]);
    }
  }
  [[gnu::always_inline]] static void gather(const Wide* bodies, std::int64_t (Wide::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    const V* a = reinterpret_cast<const V*>(bodies[at[0]].*part);
    const V* b = reinterpret_cast<const V*>(bodies[at[1]].*part);
    x = __builtin_shufflevector(a[0], b[0], 0, 2);
    y = __builtin_shufflevector(a[0], b[0], 1, 3);
    z = __builtin_shufflevector(a[1], b[1], 0, 2);
    w = __builtin_shufflevector(a[1], b[1], 1, 3);
  }
  [[gnu::always_inline]] static void scatter(Wide* bodies, const std::uint32_t* at, int fixed, V x, V y,
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

}  // namespace
}  // namespace samestep
