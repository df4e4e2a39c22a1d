// SPDX-License-Identifier: MIT
#include <samestep/control.h>
#include <samestep/error.h>
#include <samestep/limits.h>

#include <utility>
#include <vector>

namespace samestep {
namespace {

template <Scalar S>
using Points = std::span<Vector<S>>;

/// A part of the hull still to be found: the points outside the line from a to b over a pivot on the hull.
template <Scalar S>
struct HullPart {
  Points<S> points;  // Empty: the pivot alone.
  Vector<S> a, pivot, b;
  bool emitPivotFirst;  // The part left of the pivot is done.
};

/// True if a point next to the line from a to b lies farther than the tolerance beyond an end.
template <Scalar S>
bool beyondEnd(const Vector<S>& point, const Vector<S>& a, const Vector<S>& b, S tolerance) {
  if (sign(exactDot(point - a, b - a)) < 0) return !near(point, a, tolerance);
  return sign(exactDot(point - b, b - a)) > 0 && !near(point, b, tolerance);
}

/// MIS: QHullPartition. Brings the points to the right of a -> b that are farther from it than the tolerance
/// to the front, the farthest from the line first, and returns them.
template <Scalar S>
Points<S> partition(Points<S> points, const Vector<S>& a, const Vector<S>& b, S tolerance) {
  if (points.empty()) return {};
  const Vector<S> along = b - a;
  const Wide<S> limit = exactProduct(tolerance, length(along));
  Wide<S> farthest{};
  std::size_t pivot = 0, head = 0, end = points.size();
  while (head < end) {
    const Wide<S> area = exactCross(points[head] - a, along);
    if (area > limit || (sign(area) > 0 && beyondEnd(points[head], a, b, tolerance))) {
      // Only the ends of several equally far points, which lie on one line, are corners of the hull.
      const bool onward = area == farthest && sign(exactDot(points[head] - points[pivot], along)) > 0;
      if (area > farthest || onward) {
        farthest = area;
        pivot = head;
      }
      ++head;
    } else {
      std::swap(points[head], points[--end]);
    }
  }
  std::swap(points[0], points[pivot]);
  return points.first(head);
}

/// MIS: QHullReduce, with the recursion turned into a list of parts, so that no input is too deep. The hull
/// is written to `out` from left to right; it never overtakes the points still to be read, since each of its
/// points was taken out of them before.
template <Scalar S>
int reduce(Points<S> points, const Vector<S>& a, const Vector<S>& pivot, const Vector<S>& b, S tolerance,
           Points<S> out) {
  std::size_t count = 0;
  std::vector<HullPart<S>> todo{{points, a, pivot, b, false}};
  while (!todo.empty()) {
    const HullPart<S> part = todo.back();
    todo.pop_back();
    if (part.emitPivotFirst) {
      out[count++] = part.pivot;
      const Points<S> right = partition(part.points, part.pivot, part.b, tolerance);
      if (!right.empty()) {
        const Vector<S> next = right[0];
        todo.push_back({right.subspan(1), part.pivot, next, part.b, false});
      }
      continue;
    }
    const Points<S> left = partition(part.points, part.a, part.pivot, tolerance);
    todo.push_back({part.points.subspan(left.size()), part.a, part.pivot, part.b, true});
    if (!left.empty()) {
      const Vector<S> next = left[0];
      todo.push_back({left.subspan(1), part.a, next, part.pivot, false});
    }
  }
  return static_cast<int>(count);
}

}  // namespace

template <Scalar S>
LoopIndices loopIndices(std::span<const Vector<S>> points) {
  require<Fault::IndexOutOfBounds>(!points.empty(), "loopIndices: there are 0 points");
  LoopIndices found;
  Vector<S> least = points[0], most = points[0];
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vector<S>& v = points[i];
    if (v.x < least.x || (v.x == least.x && v.y < least.y)) {
      least = v;
      found.start = static_cast<int>(i);
    } else if (v.x > most.x || (v.x == most.x && v.y > most.y)) {
      most = v;
      found.end = static_cast<int>(i);
    }
  }
  return found;
}

template <Scalar S>
int convexHull(std::span<const Vector<S>> points, std::span<Vector<S>> result, int* first, S tolerance) {
  require<Fault::IndexOutOfBounds>(!points.empty() && result.size() >= points.size(), "convexHull: of ",
                                   points.size(), " points, with room for ", result.size());
  require<Fault::ValueOutOfRange>(tolerance >= S(0) && tolerance <= kMaxWorldExtent<S>,
                                  "convexHull: tolerance is ", tolerance, " m, allowed are 0 to ",
                                  kMaxWorldExtent<S>, " m");
  for (const Vector<S>& v : points)
    require<Fault::ValueOutOfRange>(within(v, kMaxWorldExtent<S>), "convexHull: a point is ", v,
                                    " m, allowed are up to ", kMaxWorldExtent<S>, " m along each axis");

  const LoopIndices ends = loopIndices<S>(points);
  if (result.data() != points.data()) {
    for (std::size_t i = 0; i < points.size(); ++i) result[i] = points[i];
  }
  if (first != nullptr) *first = ends.start;
  if (ends.start == ends.end) return 1;

  // The leftmost point to the front, the rightmost behind it; the first exchange may have moved the latter.
  std::swap(result[0], result[static_cast<std::size_t>(ends.start)]);
  std::swap(result[1], result[static_cast<std::size_t>(ends.end == 0 ? ends.start : ends.end)]);
  const Vector<S> a = result[0], b = result[1];
  return 1 + reduce<S>(result.subspan(2, points.size() - 2), a, b, a, tolerance, result.subspan(1));
}

#define SAMESTEP_EACH_SCALAR                                       \
  template LoopIndices loopIndices<S>(std::span<const Vector<S>>); \
  template int convexHull<S>(std::span<const Vector<S>>, std::span<Vector<S>>, int*, S);
#include <samestep/each_scalar.h>

}  // namespace samestep
