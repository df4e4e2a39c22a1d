// SPDX-License-Identifier: MIT
#pragma once

#include "solver/kernels/x86/avx512_intrinsics.h"

#include "solver/kernels/generic/double_lanes.h"

namespace samestep {
namespace {

/// A bit per lane is a mask of the processor.
struct EightDoubles {
  using Numbers [[gnu::vector_size(64), gnu::may_alias]] = double;
  using Masks = __mmask8;

  [[gnu::always_inline]] static Masks mask(int bits) { return static_cast<Masks>(bits); }
  [[gnu::always_inline]] static Numbers select(Masks mask, Numbers a, Numbers b) {
    return numbers(_mm512_mask_blend_pd(mask, own(b), own(a)));
  }
  [[gnu::always_inline]] static Masks above(Numbers a, Numbers b) {
    return _mm512_cmp_pd_mask(own(a), own(b), _CMP_GT_OQ);
  }
  /// Greater one of two; of two zeros, and where one is no number, the processor gives the second, as the
  /// comparison does.
  [[gnu::always_inline]] static Numbers greater(Numbers a, Numbers b) {
    return numbers(_mm512_max_pd(own(b), own(a)));
  }
  /// Clamps in one go, for `low` is no more than `high`.
  [[gnu::always_inline]] static Numbers within(Numbers x, Numbers low, Numbers high) {
    return numbers(_mm512_max_pd(own(low), _mm512_min_pd(own(high), own(x))));
  }
  [[gnu::always_inline]] static bool differ(Numbers a, Numbers b) {
    return _mm512_cmp_pd_mask(own(a), own(b), _CMP_NEQ_UQ) != 0;
  }

 private:
  [[gnu::always_inline]] static __m512d own(Numbers v) { return reinterpret_cast<__m512d>(v); }
  [[gnu::always_inline]] static Numbers numbers(__m512d v) { return reinterpret_cast<Numbers>(v); }
};

/// Eight at a time: AVX-512.
struct DoubleLanes8 : DoubleLanes<EightDoubles> {
  [[gnu::always_inline]] static void gatherVelocity(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                    V& turn) {
    V none;
    gather(bodies, &Body::velocity, at, x, y, turn, none);
  }
  [[gnu::always_inline]] static void gatherMoved(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                 V& turn, V& bend) {
    gather(bodies, &Body::moved, at, x, y, turn, bend);
  }
  [[gnu::always_inline]] static void scatterVelocity(Body* bodies, const std::uint32_t* at, int fixed, V x,
                                                     V y, V turn) {
    const V evenXY = __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14);
    const V oddXY = __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
    const V evenTurn = __builtin_shufflevector(turn, zero(), 0, 8, 2, 10, 4, 12, 6, 14);
    const V oddTurn = __builtin_shufflevector(turn, zero(), 1, 9, 3, 11, 5, 13, 7, 15);
    const V row[4] = {__builtin_shufflevector(evenXY, evenTurn, 0, 1, 8, 9, 2, 3, 10, 11),
                      __builtin_shufflevector(oddXY, oddTurn, 0, 1, 8, 9, 2, 3, 10, 11),
                      __builtin_shufflevector(evenXY, evenTurn, 4, 5, 12, 13, 6, 7, 14, 15),
                      __builtin_shufflevector(oddXY, oddTurn, 4, 5, 12, 13, 6, 7, 14, 15)};
    const auto each = [&](auto&& skipped) __attribute__((always_inline)) {
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i) {
        const int low = i / 2 * 4 + i % 2;
        const auto of = reinterpret_cast<__m512d>(row[i]);
        if (!skipped(low)) _mm256_store_pd(bodies[at[low]].velocity, _mm512_castpd512_pd256(of));
        if (!skipped(low + 2)) _mm256_store_pd(bodies[at[low + 2]].velocity, _mm512_extractf64x4_pd(of, 1));
      }
    };
    if (fixed == 0) [[likely]] {
      each([](int) { return false; });
    } else {
      each([fixed](int i) { return (fixed >> i & 1) != 0; });
    }
  }

 private:
  /// The rows of two bodies.
  [[gnu::always_inline]] static V rows(const double* low, const double* high) {
    return reinterpret_cast<V>(
        _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(low)), _mm256_load_pd(high), 1));
  }
  [[gnu::always_inline]] static void gather(const Body* bodies, double (Body::*part)[4],
                                            const std::uint32_t* at, V& x, V& y, V& z, V& w) {
    const V a = rows(bodies[at[0]].*part, bodies[at[2]].*part);
    const V b = rows(bodies[at[1]].*part, bodies[at[3]].*part);
    const V c = rows(bodies[at[4]].*part, bodies[at[6]].*part);
    const V d = rows(bodies[at[5]].*part, bodies[at[7]].*part);
    const V ab02 = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    const V ab13 = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    const V cd02 = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
    const V cd13 = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
    x = __builtin_shufflevector(ab02, cd02, 0, 1, 4, 5, 8, 9, 12, 13);
    y = __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5, 8, 9, 12, 13);
    z = __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7, 10, 11, 14, 15);
    w = __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7, 10, 11, 14, 15);
  }
};

}  // namespace
}  // namespace samestep
