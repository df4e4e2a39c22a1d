// SPDX-License-Identifier: MIT
#pragma once

#include <immintrin.h>

#include "solver/kernels/generic/integer_vectors.h"

namespace samestep {
namespace {

struct Avx2Vectors {
  using V [[gnu::vector_size(32), gnu::may_alias]] = std::int64_t;
  using U [[gnu::vector_size(32), gnu::may_alias]] = std::uint64_t;
  using Half [[gnu::vector_size(32), gnu::may_alias]] = std::int32_t;
  using Loose [[gnu::vector_size(32), gnu::may_alias, gnu::aligned(8)]] = std::int64_t;
  using LooseHalf [[gnu::vector_size(32), gnu::may_alias, gnu::aligned(4)]] = std::int32_t;

  /// Multiplies the low halves.
  [[gnu::always_inline]] static U multiply(U a, U b) {
    return reinterpret_cast<U>(_mm256_mul_epi32(reinterpret_cast<__m256i>(a), reinterpret_cast<__m256i>(b)));
  }
  /// The low halves of one, the high halves of the other.
  [[gnu::always_inline]] static U oddOf(U even, U odd) {
    return reinterpret_cast<U>(
        _mm256_blend_epi32(reinterpret_cast<__m256i>(even), reinterpret_cast<__m256i>(odd), 0xaa));
  }
};

/// Four of 64 bits.
struct WideAvx2 : UnsignedShifts<Avx2Vectors> {
  using Body = SoftBody<WideNumbers>;

  [[gnu::always_inline]] static V widen(const std::int32_t* from) {
    return reinterpret_cast<V>(_mm256_cvtepi32_epi64(_mm_load_si128(reinterpret_cast<const __m128i*>(from))));
  }
  [[gnu::always_inline]] static V multiply(V a, V b) {
    return reinterpret_cast<V>(Avx2Vectors::multiply(reinterpret_cast<U>(a), reinterpret_cast<U>(b)));
  }
  [[gnu::always_inline]] static bool any(V v) {
    return _mm256_testz_si256(reinterpret_cast<__m256i>(v), reinterpret_cast<__m256i>(v)) == 0;
  }
  [[gnu::always_inline]] static V mask(int bits) {
    const U all = U{} + static_cast<std::uint64_t>(bits);
    return -reinterpret_cast<V>((all >> U{0, 1, 2, 3}) & 1);
  }
  [[gnu::always_inline]] static void gather(const Body* bodies, std::int64_t (Body::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    transpose(row(bodies[at[0]].*part), row(bodies[at[1]].*part), row(bodies[at[2]].*part),
              row(bodies[at[3]].*part), x, y, z, w);
  }
  [[gnu::always_inline]] static void scatter(Body* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                             V turn) {
    V rows[4];
    transpose(x, y, turn, V{}, rows[0], rows[1], rows[2], rows[3]);
    const auto each = [&](auto&& skipped) __attribute__((always_inline)) {
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i) {
        if (!skipped(i)) *reinterpret_cast<V*>(bodies[at[i]].velocity) = rows[i];
      }
    };
    if (fixed == 0) [[likely]] {
      each([](int) { return false; });
    } else {
      each([fixed](int i) { return (fixed >> i & 1) != 0; });
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
};

/// Eight of 32 bits.
struct FastAvx2 : EvenAndOdd<Avx2Vectors> {
  using Loose = Avx2Vectors::LooseHalf;
  using Body = SoftBody<FastNumbers>;

  [[gnu::always_inline]] static V greater(V a, V b) { return vector(_mm256_max_epi32(bits(a), bits(b))); }
  [[gnu::always_inline]] static V less(V a, V b) { return vector(_mm256_min_epi32(bits(a), bits(b))); }
  [[gnu::always_inline]] static bool any(V v) { return _mm256_testz_si256(bits(v), bits(v)) == 0; }
  [[gnu::always_inline]] static V mask(int bits) {
    return ((V{} + bits) << V{31, 30, 29, 28, 27, 26, 25, 24}) >> 31;
  }
  [[gnu::always_inline]] static std::uint64_t at(V v, int i) { return static_cast<std::uint32_t>(v[i]); }
  [[gnu::always_inline]] static void gather(const Body* bodies, std::int32_t (Body::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    __m256i row[4];
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
      const auto* low = reinterpret_cast<const __m128i*>(bodies[at[i]].*part);
      const auto* high = reinterpret_cast<const __m128i*>(bodies[at[i + 4]].*part);
      row[i] = _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_load_si128(low)), _mm_load_si128(high), 1);
    }
    transpose(row);
    x = vector(row[0]);
    y = vector(row[1]);
    z = vector(row[2]);
    w = vector(row[3]);
  }
  [[gnu::always_inline]] static void scatter(Body* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                             V turn) {
    __m256i row[4] = {bits(x), bits(y), bits(turn), _mm256_setzero_si256()};
    transpose(row);
    const auto each = [&](auto&& skipped) __attribute__((always_inline)) {
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i) {
        if (!skipped(i)) put(bodies[at[i]], _mm256_castsi256_si128(row[i]));
        if (!skipped(i + 4)) put(bodies[at[i + 4]], _mm256_extracti128_si256(row[i], 1));
      }
    };
    if (fixed == 0) [[likely]] {
      each([](int) { return false; });
    } else {
      each([fixed](int i) { return (fixed >> i & 1) != 0; });
    }
  }

 private:
  [[gnu::always_inline]] static __m256i bits(V v) { return reinterpret_cast<__m256i>(v); }
  [[gnu::always_inline]] static V vector(__m256i v) { return reinterpret_cast<V>(v); }
  [[gnu::always_inline]] static void put(Body& body, __m128i row) {
    _mm_store_si128(reinterpret_cast<__m128i*>(body.velocity), row);
  }
  [[gnu::always_inline]] static void transpose(__m256i row[4]) {
    const __m256i a = _mm256_unpacklo_epi32(row[0], row[1]);
    const __m256i b = _mm256_unpackhi_epi32(row[0], row[1]);
    const __m256i c = _mm256_unpacklo_epi32(row[2], row[3]);
    const __m256i d = _mm256_unpackhi_epi32(row[2], row[3]);
    row[0] = _mm256_unpacklo_epi64(a, c);
    row[1] = _mm256_unpackhi_epi64(a, c);
    row[2] = _mm256_unpacklo_epi64(b, d);
    row[3] = _mm256_unpackhi_epi64(b, d);
  }
};

}  // namespace
}  // namespace samestep
