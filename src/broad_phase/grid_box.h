// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/bb.h>
#include <samestep/box_tree.h>

/// The grid of integers on which trees hold boxes, each no smaller than the box it stands for.
namespace samestep {
namespace {

template <Scalar S>
const S kGridScale = S(1 << kGridBits);
/// The last whole metre on the grid.
template <Scalar S>
const S kGridEdge = S(kGridLimit >> kGridBits);

/// Grid line below x; what is no number counts as -infinity here and as +infinity in gridCeil: its box
/// overlaps everything.
template <Scalar S>
std::int32_t gridFloor(S x) {
  const S edge = kGridEdge<S>;
  const S clamped = x >= -edge ? min(x, edge) : -edge;
  const S scaled = clamped * kGridScale<S>;
  const int towardZero = static_cast<int>(scaled);
  return towardZero - (S(towardZero) > scaled ? 1 : 0);
}

template <Scalar S>
std::int32_t gridCeil(S x) {
  return -gridFloor(-x);
}

template <Scalar S>
GridBox gridBox(const BB<S>& box) {
  return {gridFloor(box.left), gridFloor(box.bottom), gridCeil(box.right), gridCeil(box.top)};
}

template <Scalar S>
bool onGrid(const Vector<S>& v) {
  const auto inside = [](S x) { return -kGridEdge<S> <= x && x <= kGridEdge<S>; };
  return inside(v.x) && inside(v.y);
}

}  // namespace
}  // namespace samestep
