// SPDX-License-Identifier: MIT
#pragma once

#include <immintrin.h>

#include "integer_lanes.h"

namespace samestep {
namespace {

struct FourIntegerVectors {
  using V [[gnu::vector_size(32), gnu::may_alias]] = std::int64_t;
  using U [[gnu::vector_size(32), gnu::may_alias]] = std::uint64_t;
  using Loose [[gnu::vector_size(32), gnu::may_alias, gnu::aligned(8)]] = std::int64_t;
};

/// Four at a time: AVX2.
struct FourIntegers : UnsignedShifts<FourIntegerVectors> {
  using Fast = SoftBody<FastNumbers>;
  using Wide = SoftBody<WideNumbers>;

  [[gnu::always_inline]] static V widen(const std::int32_t* from) {
    return widened(_mm_load_si128(reinterpret_cast<const __m128i*>(from)));
  }
  [[gnu::always_inline]] static V multiply(V a, V b) {
    return reinterpret_cast<V>(_mm256_mul_epi32(reinterpret_cast<__m256i>(a), reinterpret_cast<__m256i>(b)));
  }
  [[gnu::always_inline]] static V mask(int bits) {
    const U all = U{} + static_cast<std::uint64_t>(bits);
    return -reinterpret_cast<V>((all >> U{0, 1, 2, 3}) & 1);
  }
  [[gnu::always_inline]] static std::uint64_t at(V v, int i) { return static_cast<std::uint64_t>(v[i]); }

  [[gnu::always_inline]] static void gather(const Fast* bodies, std::int32_t (Fast::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    __m128i row[4];
    for (int i = 0; i < 4; ++i) {
      row[i] = _mm_load_si128(reinterpret_cast<const __m128i*>(bodies[at[i]].*part));
    }
    transpose(row);
    x = widened(row[0]);
    y = widened(row[1]);
    z = widened(row[2]);
    w = widened(row[3]);
  }
  [[gnu::always_inline]] static void scatter(Fast* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                             V turn) {
    __m128i row[4] = {narrowed(x), narrowed(y), narrowed(turn), _mm_setzero_si128()};
    transpose(row);
    for (int i = 0; i < 4; ++i) {
      if ((fixed >> i & 1) == 0) _mm_store_si128(reinterpret_cast<__m128i*>(bodies[at[i]].velocity), row[i]);
    }
  }

  [[gnu::always_inline]] static void gather(const Wide* bodies, std::int64_t (Wide::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    transpose(row(bodies[at[0]].*part), row(bodies[at[1]].*part), row(bodies[at[2]].*part),
              row(bodies[at[3]].*part), x, y, z, w);
  }
  [[gnu::always_inline]] static void scatter(Wide* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                             V turn) {
    V rows[4];
    transpose(x, y, turn, V{}, rows[0], rows[1], rows[2], rows[3]);
    for (int i = 0; i < 4; ++i) {
      if ((fixed >> i & 1) == 0) *reinterpret_cast<V*>(bodies[at[i]].velocity) = rows[i];
    }
  }

 private:
  [[gnu::always_inline]] static V row(const std::int64_t* from) { return *reinterpret_cast<const V*>(from); }
  [[gnu::always_inline]] static void transpose(V a, V b, V c, V d, V& x, V& y, V& z, V& w) {
    const V ab02 = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    const V ab13 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const V cd02 = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const V cd13 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    x = __builtin_shufflevector(ab02, cd02, 0, 1, 4, 5);
    y = __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5);
    z = __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7);
    w = __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7);
  }
  [[gnu::always_inline]] static V widened(__m128i x) { return reinterpret_cast<V>(_mm256_cvtepi32_epi64(x)); }
  /// The low half of each.
  [[gnu::always_inline]] static __m128i narrowed(V x) {
    const __m256i packed =
        _mm256_permutevar8x32_epi32(reinterpret_cast<__m256i>(x), _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6));
    return _mm256_castsi256_si128(packed);
  }
  [[gnu::always_inline]] static void transpose(__m128i row[4]) {
    const __m128i a = _mm_unpacklo_epi32(row[0], row[1]);
    const __m128i b = _mm_unpackhi_epi32(row[0], row[1]);
    const __m128i c = _mm_unpacklo_epi32(row[2], row[3]);
    const __m128i d = _mm_unpackhi_epi32(row[2], row[3]);
    row[0] = _mm_unpacklo_epi64(a, c);
    row[1] = _mm_unpackhi_epi64(a, c);
    row[2] = _mm_unpacklo_epi64(b, d);
    row[3] = _mm_unpackhi_epi64(b, d);
  }
};

}  // namespace
}  // namespace samestep
