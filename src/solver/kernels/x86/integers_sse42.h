// SPDX-License-Identifier: MIT
#pragma once

#include <immintrin.h>

#include "solver/kernels/generic/integer_vectors.h"

namespace samestep {
namespace {

struct Sse42Vectors {
  using V [[gnu::vector_size(16), gnu::may_alias]] = std::int64_t;
  using U [[gnu::vector_size(16), gnu::may_alias]] = std::uint64_t;
  using Half [[gnu::vector_size(16), gnu::may_alias]] = std::int32_t;
  using Loose [[gnu::vector_size(16), gnu::may_alias, gnu::aligned(8)]] = std::int64_t;
  using LooseHalf [[gnu::vector_size(16), gnu::may_alias, gnu::aligned(4)]] = std::int32_t;

  /// Multiplies the low halves.
  [[gnu::always_inline]] static U multiply(U a, U b) {
    return reinterpret_cast<U>(_mm_mul_epi32(reinterpret_cast<__m128i>(a), reinterpret_cast<__m128i>(b)));
  }
  /// The low halves of one, the high halves of the other.
  [[gnu::always_inline]] static U oddOf(U even, U odd) {
    return reinterpret_cast<U>(
        _mm_blend_epi16(reinterpret_cast<__m128i>(even), reinterpret_cast<__m128i>(odd), 0xcc));
  }
};

/// Two of 64 bits.
struct WideSse42 : UnsignedShifts<Sse42Vectors> {
  using Body = SoftBody<WideNumbers>;

  [[gnu::always_inline]] static V widen(const std::int32_t* from) {
    return reinterpret_cast<V>(_mm_cvtepi32_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
  }
  [[gnu::always_inline]] static V multiply(V a, V b) {
    return reinterpret_cast<V>(Sse42Vectors::multiply(reinterpret_cast<U>(a), reinterpret_cast<U>(b)));
  }
  [[gnu::always_inline]] static bool any(V v) {
    return _mm_testz_si128(reinterpret_cast<__m128i>(v), reinterpret_cast<__m128i>(v)) == 0;
  }
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
};

/// Four of 32 bits.
struct FastSse42 : EvenAndOdd<Sse42Vectors> {
  using Loose = Sse42Vectors::LooseHalf;
  using Body = SoftBody<FastNumbers>;

  [[gnu::always_inline]] static V greater(V a, V b) { return vector(_mm_max_epi32(bits(a), bits(b))); }
  [[gnu::always_inline]] static V less(V a, V b) { return vector(_mm_min_epi32(bits(a), bits(b))); }
  [[gnu::always_inline]] static bool any(V v) {
    return _mm_testz_si128(reinterpret_cast<__m128i>(v), reinterpret_cast<__m128i>(v)) == 0;
  }
  [[gnu::always_inline]] static V mask(int bits) {
    return V{-(bits & 1), -(bits >> 1 & 1), -(bits >> 2 & 1), -(bits >> 3 & 1)};
  }
  [[gnu::always_inline]] static std::uint64_t at(V v, int i) { return static_cast<std::uint32_t>(v[i]); }
  [[gnu::always_inline]] static void gather(const Body* bodies, std::int32_t (Body::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    __m128i row[4];
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
      row[i] = _mm_load_si128(reinterpret_cast<const __m128i*>(bodies[at[i]].*part));
    }
    transpose(row);
    x = vector(row[0]);
    y = vector(row[1]);
    z = vector(row[2]);
    w = vector(row[3]);
  }
  [[gnu::always_inline]] static void scatter(Body* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                             V turn) {
    __m128i row[4] = {bits(x), bits(y), bits(turn), _mm_setzero_si128()};
    transpose(row);
    for (int i = 0; i < 4; ++i) {
      if ((fixed >> i & 1) == 0) _mm_store_si128(reinterpret_cast<__m128i*>(bodies[at[i]].velocity), row[i]);
    }
  }

 private:
  [[gnu::always_inline]] static __m128i bits(V v) { return reinterpret_cast<__m128i>(v); }
  [[gnu::always_inline]] static V vector(__m128i v) { return reinterpret_cast<V>(v); }
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
