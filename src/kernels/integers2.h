// SPDX-License-Identifier: MIT
#pragma once

#include <immintrin.h>

#include "integer_lanes.h"

namespace samestep {
namespace {

struct TwoIntegerVectors {
  using V [[gnu::vector_size(16), gnu::may_alias]] = std::int64_t;
  using U [[gnu::vector_size(16), gnu::may_alias]] = std::uint64_t;
  using Loose [[gnu::vector_size(16), gnu::may_alias, gnu::aligned(8)]] = std::int64_t;
};

/// Two at a time: SSE4.2.
struct TwoIntegers : UnsignedShifts<TwoIntegerVectors> {
  using Fast = SoftBody<FastNumbers>;
  using Wide = SoftBody<WideNumbers>;

  [[gnu::always_inline]] static V widen(const std::int32_t* from) {
    return widened(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from)));
  }
  [[gnu::always_inline]] static V multiply(V a, V b) {
    return reinterpret_cast<V>(_mm_mul_epi32(reinterpret_cast<__m128i>(a), reinterpret_cast<__m128i>(b)));
  }
  [[gnu::always_inline]] static V mask(int bits) { return V{-(bits & 1), -(bits >> 1 & 1)}; }
  [[gnu::always_inline]] static std::uint64_t at(V v, int i) { return static_cast<std::uint64_t>(v[i]); }

  [[gnu::always_inline]] static void gather(const Fast* bodies, std::int32_t (Fast::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    const __m128i a = _mm_load_si128(reinterpret_cast<const __m128i*>(bodies[at[0]].*part));
    const __m128i b = _mm_load_si128(reinterpret_cast<const __m128i*>(bodies[at[1]].*part));
    const __m128i xy = _mm_unpacklo_epi32(a, b);
    const __m128i zw = _mm_unpackhi_epi32(a, b);
    x = widened(xy);
    y = widened(_mm_unpackhi_epi64(xy, xy));
    z = widened(zw);
    w = widened(_mm_unpackhi_epi64(zw, zw));
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

 private:
  [[gnu::always_inline]] static V widened(__m128i x) { return reinterpret_cast<V>(_mm_cvtepi32_epi64(x)); }
};

}  // namespace
}  // namespace samestep
