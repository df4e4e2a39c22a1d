// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/error.h>
#include <samestep/vector.h>

namespace samestep {

/// An axis-aligned box, edges included, metres. MIS section 10.
template <Scalar S>
struct BB {
  S left{};
  S bottom{};
  S right{};
  S top{};

  constexpr BB() = default;
  /// MIS: BBNew
  constexpr BB(S l, S b, S r, S t) : left(l), bottom(b), right(r), top(t) {}

  /// @throws NegativeHalfDimensions
  /// MIS: BBNewForExtents
  [[gnu::always_inline]] static constexpr BB forExtents(const Vector<S>& center, S halfWidth, S halfHeight) {
    require<Fault::NegativeHalfDimensions>(halfWidth >= S(0) && halfHeight >= S(0), "BB: half its width is ",
                                           halfWidth, " and half its height ", halfHeight,
                                           ", allowed are 0 and above");
    return {center.x - halfWidth, center.y - halfHeight, center.x + halfWidth, center.y + halfHeight};
  }

  /// @throws NegativeRadius
  /// MIS: BBNewForCircle
  [[gnu::always_inline]] static constexpr BB forCircle(const Vector<S>& center, S radius) {
    require<Fault::NegativeRadius>(radius >= S(0), "BB: radius is ", radius, ", allowed are 0 and above");
    return {center.x - radius, center.y - radius, center.x + radius, center.y + radius};
  }

  friend constexpr bool operator==(const BB&, const BB&) = default;
};

/// True if the boxes share a point; touching counts. MIS: BBIntersects
template <Scalar S>
[[gnu::always_inline]] inline constexpr bool intersects(const BB<S>& a, const BB<S>& b) {
  return a.left <= b.right && b.left <= a.right && a.bottom <= b.top && b.bottom <= a.top;
}

/// True if `inner` lies in `outer`, edges included. MIS: BBContainsBB
template <Scalar S>
[[gnu::always_inline]] inline constexpr bool contains(const BB<S>& outer, const BB<S>& inner) {
  return outer.left <= inner.left && inner.right <= outer.right && outer.bottom <= inner.bottom &&
         inner.top <= outer.top;
}

/// MIS: BBContainsVect
template <Scalar S>
[[gnu::always_inline]] inline constexpr bool contains(const BB<S>& box, const Vector<S>& v) {
  return box.left <= v.x && v.x <= box.right && box.bottom <= v.y && v.y <= box.top;
}

/// The smallest box around both. MIS: BBMerge
template <Scalar S>
[[gnu::always_inline]] inline constexpr BB<S> merge(const BB<S>& a, const BB<S>& b) {
  return {min(a.left, b.left), min(a.bottom, b.bottom), max(a.right, b.right), max(a.top, b.top)};
}

/// The smallest box around the box and the point.
template <Scalar S>
[[gnu::always_inline]] inline constexpr BB<S> expand(const BB<S>& box, const Vector<S>& v) {
  return {min(box.left, v.x), min(box.bottom, v.y), max(box.right, v.x), max(box.top, v.y)};
}

/// The box grown by `margin` metres on every side.
template <Scalar S>
[[gnu::always_inline]] inline constexpr BB<S> inflate(const BB<S>& box, S margin) {
  return {box.left - margin, box.bottom - margin, box.right + margin, box.top + margin};
}

/// MIS: BBCenter
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> center(const BB<S>& box) {
  return lerp(Vector<S>(box.left, box.bottom), Vector<S>(box.right, box.top), ratio<S>(1, 2));
}

/// Square metres. In Fixed only below 2^31 m^2; the trees go by perimeter instead. MIS: BBArea
template <Scalar S>
[[gnu::always_inline]] inline constexpr S area(const BB<S>& box) {
  return (box.right - box.left) * (box.top - box.bottom);
}

/// MIS: BBMergedArea
template <Scalar S>
[[gnu::always_inline]] inline constexpr S mergedArea(const BB<S>& a, const BB<S>& b) {
  return area(merge(a, b));
}

/// Half the perimeter, metres.
template <Scalar S>
[[gnu::always_inline]] inline constexpr S halfPerimeter(const BB<S>& box) {
  return (box.right - box.left) + (box.top - box.bottom);
}

/// The point of the box nearest to v. MIS: BBClampVect
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> clampTo(const BB<S>& box, const Vector<S>& v) {
  return {clamp(v.x, box.left, box.right), clamp(v.y, box.bottom, box.top)};
}

/// v moved by whole widths and heights into the box, as on a torus. An empty side leaves its coordinate at
/// the lower edge. MIS: BBWrapVect
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> wrapInto(const BB<S>& box, const Vector<S>& v) {
  const auto wrap = [](S value, S low, S high) {
    const S size = high - low;
    if (size <= S(0)) return low;
    const S offset = remainder(value - low, size);
    return low + (offset < S(0) ? offset + size : offset);
  };
  return {wrap(v.x, box.left, box.right), wrap(v.y, box.bottom, box.top)};
}

/// MIS: BBOffset
template <Scalar S>
[[gnu::always_inline]] inline constexpr BB<S> offset(const BB<S>& box, const Vector<S>& v) {
  return {box.left + v.x, box.bottom + v.y, box.right + v.x, box.top + v.y};
}

}  // namespace samestep
