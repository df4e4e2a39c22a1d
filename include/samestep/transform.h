// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/bb.h>
#include <samestep/vector.h>

namespace samestep {

/// An affine map of the plane, columns (a, b), (c, d), (tx, ty): x' = a x + c y + tx. MIS section 11.
template <Scalar S>
struct Transform {
  S a{1};
  S b{0};
  S c{0};
  S d{1};
  S tx{0};
  S ty{0};

  /// The identity.
  constexpr Transform() = default;
  /// MIS: transformNew
  constexpr Transform(S aIn, S bIn, S cIn, S dIn, S txIn, S tyIn)
      : a(aIn), b(bIn), c(cIn), d(dIn), tx(txIn), ty(tyIn) {}

  /// Makes a transform from the same numbers written row by row. MIS: transformNewTranspose
  [[gnu::always_inline]] static constexpr Transform fromRows(S a, S c, S tx, S b, S d, S ty) {
    return {a, b, c, d, tx, ty};
  }
  /// MIS: transformTranslate
  [[gnu::always_inline]] static constexpr Transform translation(const Vector<S>& v) {
    return {S(1), S(0), S(0), S(1), v.x, v.y};
  }
  /// MIS: transformScale
  [[gnu::always_inline]] static constexpr Transform scaling(S x, S y) {
    return {x, S(0), S(0), y, S(0), S(0)};
  }
  /// Turns by `angle` radians. MIS: transformRotate
  static Transform rotation(S angle) { return rigid(Vector<S>(), angle); }
  /// Turns by `angle` radians, then moves by v. MIS: transformRigid
  static Transform rigid(const Vector<S>& v, S angle) { return rigid(v, forAngle(angle)); }
  /// Turns by the unit vector `rotation`, then moves by v.
  [[gnu::always_inline]] static constexpr Transform rigid(const Vector<S>& v, const Vector<S>& rotation) {
    return {rotation.x, rotation.y, -rotation.y, rotation.x, v.x, v.y};
  }

  friend constexpr bool operator==(const Transform&, const Transform&) = default;
};

/// MIS: transformPoint
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> transformPoint(const Transform<S>& t, const Vector<S>& p) {
  return {dot(t.a, p.x, t.c, p.y) + t.tx, dot(t.b, p.x, t.d, p.y) + t.ty};
}

/// Transforms without the translation. MIS: transformVect
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> transformVect(const Transform<S>& t, const Vector<S>& v) {
  return {dot(t.a, v.x, t.c, v.y), dot(t.b, v.x, t.d, v.y)};
}

/// First `inner`, then `outer`. MIS: transformMult
template <Scalar S>
[[gnu::always_inline]] inline constexpr Transform<S> operator*(const Transform<S>& outer,
                                                               const Transform<S>& inner) {
  const Vector<S> x = transformVect(outer, Vector<S>(inner.a, inner.b));
  const Vector<S> y = transformVect(outer, Vector<S>(inner.c, inner.d));
  const Vector<S> t = transformPoint(outer, Vector<S>(inner.tx, inner.ty));
  return {x.x, x.y, y.x, y.y, t.x, t.y};
}

/// The inverse of any map whose determinant is not zero; Fixed: of one near 1. MIS: transformInverse
template <Scalar S>
[[gnu::always_inline]] inline constexpr Transform<S> inverse(const Transform<S>& t) {
  const S inv = reciprocal(cross(t.a, t.d, t.c, t.b));
  return {t.d * inv,
          -(t.b * inv),
          -(t.c * inv),
          t.a * inv,
          cross(t.c, t.ty, t.tx, t.d) * inv,
          cross(t.tx, t.b, t.a, t.ty) * inv};
}

/// The inverse of a rotation and translation. MIS: transformRigidInverse
template <Scalar S>
[[gnu::always_inline]] inline constexpr Transform<S> rigidInverse(const Transform<S>& t) {
  return {t.d, -t.b, -t.c, t.a, cross(t.c, t.ty, t.tx, t.d), cross(t.tx, t.b, t.a, t.ty)};
}

/// The smallest box around the image of a box. MIS: transformBB
template <Scalar S>
[[gnu::always_inline]] inline constexpr BB<S> transformBB(const Transform<S>& t, const BB<S>& box) {
  const S half = ratio<S>(1, 2);
  const S hw = (box.right - box.left) * half;
  const S hh = (box.top - box.bottom) * half;
  const S width = dot(abs(t.a), hw, abs(t.c), hh);
  const S height = dot(abs(t.b), hw, abs(t.d), hh);
  return BB<S>::forExtents(transformPoint(t, center(box)), width, height);
}

}  // namespace samestep
