// SPDX-License-Identifier: MIT
#pragma once

#include "solver/kernels/x86/avx512_intrinsics.h"

#include "solver/kernels/generic/integer_vectors.h"

namespace samestep {
namespace {

struct Avx512Vectors {
  using V [[gnu::vector_size(64), gnu::may_alias]] = std::int64_t;
  using U [[gnu::vector_size(64), gnu::may_alias]] = std::uint64_t;
  using Half [[gnu::vector_size(64), gnu::may_alias]] = std::int32_t;
  using Loose [[gnu::vector_size(64), gnu::may_alias, gnu::aligned(8)]] = std::int64_t;
  using LooseHalf [[gnu::vector_size(64), gnu::may_alias, gnu::aligned(4)]] = std::int32_t;

  /// Multiplies the low halves.
  [[gnu::always_inline]] static U multiply(U a, U b) {
    return reinterpret_cast<U>(_mm512_mul_epi32(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b)));
  }
  /// The low halves of one, the high halves of the other.
  [[gnu::always_inline]] static U oddOf(U even, U odd) {
    return reinterpret_cast<U>(
        _mm512_mask_blend_epi32(0xaaaa, reinterpret_cast<__m512i>(even), reinterpret_cast<__m512i>(odd)));
  }
};

/// Eight of 64 bits.
struct WideAvx512 : Avx512Vectors {
  using Body = SoftBody<WideNumbers>;

  [[gnu::always_inline]] static V greater(V a, V b) {
    return reinterpret_cast<V>(_mm512_max_epi64(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b)));
  }
  [[gnu::always_inline]] static V less(V a, V b) {
    return reinterpret_cast<V>(_mm512_min_epi64(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b)));
  }
  template <int kBits>
  [[gnu::always_inline]] static V rounded(V x) {
    return (x + ((std::int64_t{1} << (kBits - 1)) + (x >> 63))) >> kBits;
  }
  template <int kBits>
  [[gnu::always_inline]] static V down(V x) {
    return reinterpret_cast<V>(reinterpret_cast<U>(x) >> kBits);
  }
  [[gnu::always_inline]] static V widen(const std::int32_t* from) {
    return reinterpret_cast<V>(
        _mm512_cvtepi32_epi64(_mm256_load_si256(reinterpret_cast<const __m256i*>(from))));
  }
  [[gnu::always_inline]] static V multiply(V a, V b) {
    return reinterpret_cast<V>(Avx512Vectors::multiply(reinterpret_cast<U>(a), reinterpret_cast<U>(b)));
  }
  [[gnu::always_inline]] static bool any(V v) {
    return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(v), reinterpret_cast<__m512i>(v)) != 0;
  }
  [[gnu::always_inline]] static V mask(int bits) {
    return reinterpret_cast<V>(_mm512_movm_epi64(static_cast<__mmask8>(bits)));
  }
  [[gnu::always_inline]] static void gather(const Body* bodies, std::int64_t (Body::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    const V a = rows(bodies[at[0]].*part, bodies[at[2]].*part);
    const V b = rows(bodies[at[1]].*part, bodies[at[3]].*part);
    const V c = rows(bodies[at[4]].*part, bodies[at[6]].*part);
    const V d = rows(bodies[at[5]].*part, bodies[at[7]].*part);
    const V ab02 = evenOf(a, b), ab13 = oddOf(a, b), cd02 = evenOf(c, d), cd13 = oddOf(c, d);
    x = __builtin_shufflevector(ab02, cd02, 0, 1, 4, 5, 8, 9, 12, 13);
    y = __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5, 8, 9, 12, 13);
    z = __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7, 10, 11, 14, 15);
    w = __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7, 10, 11, 14, 15);
  }
  [[gnu::always_inline]] static void scatter(Body* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                             V turn) {
    const V evenXY = evenOf(x, y), oddXY = oddOf(x, y), evenTurn = evenOf(turn, V{}),
            oddTurn = oddOf(turn, V{});
    const V row[4] = {__builtin_shufflevector(evenXY, evenTurn, 0, 1, 8, 9, 2, 3, 10, 11),
                      __builtin_shufflevector(oddXY, oddTurn, 0, 1, 8, 9, 2, 3, 10, 11),
                      __builtin_shufflevector(evenXY, evenTurn, 4, 5, 12, 13, 6, 7, 14, 15),
                      __builtin_shufflevector(oddXY, oddTurn, 4, 5, 12, 13, 6, 7, 14, 15)};
    const auto each = [&](auto&& skipped) __attribute__((always_inline)) {
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i) {
        const int low = i / 2 * 4 + i % 2;
        const auto of = reinterpret_cast<__m512i>(row[i]);
        if (!skipped(low)) put(bodies[at[low]], _mm512_castsi512_si256(of));
        if (!skipped(low + 2)) put(bodies[at[low + 2]], _mm512_extracti64x4_epi64(of, 1));
      }
    };
    if (fixed == 0) [[likely]] {
      each([](int) { return false; });
    } else {
      each([fixed](int i) { return (fixed >> i & 1) != 0; });
    }
  }

 private:
  [[gnu::always_inline]] static V evenOf(V a, V b) {
    return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
  }
  [[gnu::always_inline]] static V oddOf(V a, V b) {
    return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  }
  /// The rows of two bodies.
  [[gnu::always_inline]] static V rows(const std::int64_t* low, const std::int64_t* high) {
    const __m256i first = _mm256_load_si256(reinterpret_cast<const __m256i*>(low));
    const __m256i second = _mm256_load_si256(reinterpret_cast<const __m256i*>(high));
    return reinterpret_cast<V>(_mm512_inserti64x4(_mm512_castsi256_si512(first), second, 1));
  }
  [[gnu::always_inline]] static void put(Body& body, __m256i row) {
    _mm256_store_si256(reinterpret_cast<__m256i*>(body.velocity), row);
  }
};

/// Sixteen of 32 bits.
struct FastAvx512 : EvenAndOdd<Avx512Vectors> {
  using Loose = Avx512Vectors::LooseHalf;
  using Body = SoftBody<FastNumbers>;

  [[gnu::always_inline]] static bool any(V v) {
    return _mm512_test_epi32_mask(reinterpret_cast<__m512i>(v), reinterpret_cast<__m512i>(v)) != 0;
  }
  [[gnu::always_inline]] static V greater(V a, V b) { return vector(_mm512_max_epi32(bits(a), bits(b))); }
  [[gnu::always_inline]] static V less(V a, V b) { return vector(_mm512_min_epi32(bits(a), bits(b))); }
  [[gnu::always_inline]] static V mask(int bits) {
    return vector(_mm512_movm_epi32(static_cast<__mmask16>(bits)));
  }
  [[gnu::always_inline]] static std::uint64_t at(V v, int i) { return static_cast<std::uint32_t>(v[i]); }
  [[gnu::always_inline]] static void gather(const Body* bodies, std::int32_t (Body::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    __m512i row[4];
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
      const auto rowOf = [&](int lane) __attribute__((always_inline)) {
        return _mm_load_si128(reinterpret_cast<const __m128i*>(bodies[at[lane]].*part));
      };
      // Copies to all places, of which some are kept, need no shuffling.
      row[i] = _mm512_broadcast_i32x4(rowOf(i));
      row[i] = _mm512_mask_broadcast_i32x4(row[i], 0x00f0, rowOf(i + 4));
      row[i] = _mm512_mask_broadcast_i32x4(row[i], 0x0f00, rowOf(i + 8));
      row[i] = _mm512_mask_broadcast_i32x4(row[i], 0xf000, rowOf(i + 12));
    }
    transpose(row);
    x = vector(row[0]);
    y = vector(row[1]);
    z = vector(row[2]);
    w = vector(row[3]);
  }
  [[gnu::always_inline]] static void scatter(Body* bodies, const std::uint32_t* at, int fixed, V x, V y,
                                             V turn) {
    __m512i row[4] = {bits(x), bits(y), bits(turn), _mm512_setzero_si512()};
    transpose(row);
    const auto each = [&](auto&& skipped) __attribute__((always_inline)) {
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i) {
        if (!skipped(i)) put(bodies[at[i]], _mm512_castsi512_si128(row[i]));
        if (!skipped(i + 4)) put(bodies[at[i + 4]], _mm512_extracti32x4_epi32(row[i], 1));
        if (!skipped(i + 8)) put(bodies[at[i + 8]], _mm512_extracti32x4_epi32(row[i], 2));
        if (!skipped(i + 12)) put(bodies[at[i + 12]], _mm512_extracti32x4_epi32(row[i], 3));
      }
    };
    if (fixed == 0) [[likely]] {
      each([](int) { return false; });
    } else {
      each([fixed](int i) { return (fixed >> i & 1) != 0; });
    }
  }

 private:
  [[gnu::always_inline]] static __m512i bits(V v) { return reinterpret_cast<__m512i>(v); }
  [[gnu::always_inline]] static V vector(__m512i v) { return reinterpret_cast<V>(v); }
  [[gnu::always_inline]] static void put(Body& body, __m128i row) {
    _mm_store_si128(reinterpret_cast<__m128i*>(body.velocity), row);
  }
  [[gnu::always_inline]] static void transpose(__m512i row[4]) {
    const __m512i a = _mm512_unpacklo_epi32(row[0], row[1]);
    const __m512i b = _mm512_unpackhi_epi32(row[0], row[1]);
    const __m512i c = _mm512_unpacklo_epi32(row[2], row[3]);
    const __m512i d = _mm512_unpackhi_epi32(row[2], row[3]);
    row[0] = _mm512_unpacklo_epi64(a, c);
    row[1] = _mm512_unpackhi_epi64(a, c);
    row[2] = _mm512_unpacklo_epi64(b, d);
    row[3] = _mm512_unpackhi_epi64(b, d);
  }
};

}  // namespace
}  // namespace samestep
