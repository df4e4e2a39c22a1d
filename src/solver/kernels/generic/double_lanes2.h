// SPDX-License-Identifier: MIT
#pragma once

#include "solver/kernels/generic/double_lanes.h"

namespace samestep {
namespace {

struct TwoDoubles {
  using Numbers [[gnu::vector_size(16), gnu::may_alias]] = double;
  using Masks [[gnu::vector_size(16), gnu::may_alias]] = std::int64_t;
};

/// Two at a time: SSE2, NEON, wasm's simd128, or what the compiler makes of it elsewhere.
struct DoubleLanes2 : DoubleLanes<ChosenDoubles<TwoDoubles>> {
  [[gnu::always_inline]] static void gatherVelocity(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                    V& turn) {
    gather(bodies[at[0]].velocity, bodies[at[1]].velocity, x, y);
    turn = __builtin_shufflevector(load(bodies[at[0]].velocity + 2), load(bodies[at[1]].velocity + 2), 0, 2);
  }
  [[gnu::always_inline]] static void gatherMoved(const Body* bodies, const std::uint32_t* at, V& x, V& y,
                                                 V& turn, V& bend) {
    gather(bodies[at[0]].moved, bodies[at[1]].moved, x, y);
    gather(bodies[at[0]].moved + 2, bodies[at[1]].moved + 2, turn, bend);
  }
  [[gnu::always_inline]] static void scatterVelocity(Body* bodies, const std::uint32_t* at, int fixed, V x,
                                                     V y, V turn) {
    if ((fixed & 1) == 0) put(bodies[at[0]], __builtin_shufflevector(x, y, 0, 2), turn[0]);
    if ((fixed & 2) == 0) put(bodies[at[1]], __builtin_shufflevector(x, y, 1, 3), turn[1]);
  }

 private:
  [[gnu::always_inline]] static void gather(const double* a, const double* b, V& x, V& y) {
    x = __builtin_shufflevector(load(a), load(b), 0, 2);
    y = __builtin_shufflevector(load(a), load(b), 1, 3);
  }
  [[gnu::always_inline]] static void put(Body& body, V xy, double turn) {
    store(body.velocity, xy);
    body.velocity[2] = turn;
  }
};

}  // namespace
}  // namespace samestep
