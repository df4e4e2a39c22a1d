// SPDX-License-Identifier: MIT
// Scenes of any size, by formula.
#include <samestep/poly_shape.h>

#include "base/require_ieee.h"
#include "scenes/scene_builder.h"

namespace samestep {
namespace {

/// A small generator of our own, the same everywhere (Knuth's 64-bit linear congruence, its upper bits).
class Draw {
 public:
  /// Random number from 0 to below `bound`.
  int below(int bound) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<int>((state_ >> 33) % static_cast<std::uint32_t>(bound));
  }

 private:
  std::uint64_t state_ = 2;
};

template <Scalar S>
Spawn<S> wall(S x, S y, S width, S height) {
  Spawn<S> made{Body<S>::fixedInPlace(), {boxShape<S>({}, width, height)}};
  made.body.setPosition({x, y});
  made.shapes[0].setFriction(ratio<S>(8, 10));
  return made;
}

}  // namespace

template <Scalar S>
void SceneBuilder<S>::buildPyramid(std::uint32_t rows) {
  scene_.space_.setGravity({S(0), S(-10)});
  const auto count = static_cast<int>(rows);
  addBody(wall<S>(S(0), S(-1), S(2 * count + 40), S(2)));
  Spawn<S> box{Body<S>(), {boxShape<S>({}, S(1), S(1))}};
  box.shapes[0].setDensity(S(1));
  box.shapes[0].setFriction(ratio<S>(8, 10));
  for (int row = 0; row < count; ++row) {
    for (int i = row; i < count; ++i) {
      box.body.setPosition({ratio<S>(2 * i - row + 1 - count, 2), ratio<S>(2 * row + 1, 2)});
      addBody(box);
    }
  }
}

template <Scalar S>
void SceneBuilder<S>::buildSoup(std::uint32_t count) {
  constexpr int kPerRow = 24;
  const int rows = (static_cast<int>(count) + kPerRow - 1) / kPerRow;
  const S height = S(rows + rows / 2 + 20);
  scene_.space_.setGravity({S(0), S(-10)});
  // No shape may reach farther than 2^14 m from its body, which the largest count keeps far from.
  addBody(wall<S>(S(0), S(-1), S(40), S(2)));
  for (const int side : {-1, 1}) addBody(wall<S>(S(19 * side), height / S(2), S(2), height));
  Draw draw;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const int corners = 3 + draw.below(6);
    const S size = ratio<S>(35 + draw.below(25), 100);
    std::vector<Vector<S>> points;
    for (int corner = 0; corner < corners; ++corner) {
      const S turn = ratio<S>(6283 * corner, 1000 * corners) + ratio<S>(draw.below(40) - 20, 100);
      points.push_back(forAngle(turn) * size);
    }
    Spawn<S> made{Body<S>(), {polyShape<S>({}, points)}};
    made.shapes[0].setDensity(S(1));
    made.shapes[0].setFriction(ratio<S>(8, 10));
    const int row = i / kPerRow;
    const int column = i % kPerRow;
    made.body.setPosition({ratio<S>(14 * (2 * column - kPerRow + 1), 20), ratio<S>(3 * row + 3, 2)});
    made.body.setAngle(ratio<S>(draw.below(628), 100));
    addBody(made);
  }
}

#define SAMESTEP_EACH_SCALAR template class SceneBuilder<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
