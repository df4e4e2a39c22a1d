// SPDX-License-Identifier: MIT
#pragma once

#include "solver/kernels/generic/double_lanes.h"

namespace samestep {
namespace {

struct FourDoubles {
  using Numbers [[gnu::vector_size(32), gnu::may_alias]] = double;
  using Masks [[gnu::vector_size(32), gnu::may_alias]] = std::int64_t;
};

/// Four at a time: AVX2.
struct DoubleLanes4 : DoubleLanes<ChosenDoubles<FourDoubles>> {
  [[gnu::always_inline]] static void gatherVelocity(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                    V& turn) {
    V none;
    transpose(load(bodies[at[0]].velocity), load(bodies[at[1]].velocity), load(bodies[at[2]].velocity),
              load(bodies[at[3]].velocity), x, y, turn, none);
  }
  [[gnu::always_inline]] static void gatherMoved(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                 V& turn, V& bend) {
    transpose(load(bodies[at[0]].moved), load(bodies[at[1]].moved), load(bodies[at[2]].moved),
              load(bodies[at[3]].moved), x, y, turn, bend);
  }
  [[gnu::always_inline]] static void scatterVelocity(Body* bodies, const std::uint32_t* at, int fixed, V x,
                                                     V y, V turn) {
    V row[4];
    transpose(x, y, turn, zero(), row[0], row[1], row[2], row[3]);
    if (fixed == 0) [[likely]] {
      for (int i = 0; i < 4; ++i) store(bodies[at[i]].velocity, row[i]);
    } else {
      for (int i = 0; i < 4; ++i) {
        if ((fixed >> i & 1) == 0) store(bodies[at[i]].velocity, row[i]);
      }
    }
  }

 private:
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

}  // namespace
}  // namespace samestep
