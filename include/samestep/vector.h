// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/scalar.h>

namespace samestep {

/// A point, direction or displacement in the plane; metres where it is a place. MIS section 9.
template <Scalar S>
struct Vector {
  S x{};
  S y{};

  /// The zero vector.
  constexpr Vector() = default;
  /// MIS: vect
  constexpr Vector(S xIn, S yIn) : x(xIn), y(yIn) {}
  constexpr explicit Vector(const Components<S>& c) : x(c.x), y(c.y) {}

  /// Exact, component by component. MIS: vectEqual
  friend constexpr bool operator==(const Vector&, const Vector&) = default;

  /// MIS: vectAdd
  [[gnu::always_inline]] friend constexpr Vector operator+(const Vector& a, const Vector& b) {
    return {a.x + b.x, a.y + b.y};
  }
  /// MIS: vectSub
  [[gnu::always_inline]] friend constexpr Vector operator-(const Vector& a, const Vector& b) {
    return {a.x - b.x, a.y - b.y};
  }
  /// MIS: vectNeg
  [[gnu::always_inline]] friend constexpr Vector operator-(const Vector& v) { return {-v.x, -v.y}; }
  /// MIS: vectMult
  [[gnu::always_inline]] friend constexpr Vector operator*(const Vector& v, S s) {
    return {v.x * s, v.y * s};
  }
  [[gnu::always_inline]] friend constexpr Vector operator*(S s, const Vector& v) { return v * s; }

  [[gnu::always_inline]] constexpr Vector& operator+=(const Vector& v) { return *this = *this + v; }
  [[gnu::always_inline]] constexpr Vector& operator-=(const Vector& v) { return *this = *this - v; }
  [[gnu::always_inline]] constexpr Vector& operator*=(S s) { return *this = *this * s; }
};

/// MIS: vectDot
template <Scalar S>
[[gnu::always_inline]] inline constexpr S dot(const Vector<S>& a, const Vector<S>& b) {
  return dot(a.x, b.x, a.y, b.y);
}

/// The z component of the cross product: positive where b lies to the left of a. MIS: vectCross
template <Scalar S>
[[gnu::always_inline]] inline constexpr S cross(const Vector<S>& a, const Vector<S>& b) {
  return cross(a.x, b.y, a.y, b.x);
}

/// a.b and a x b at full width: comparing them decides exactly, whatever the size of the edges.
template <Scalar S>
[[gnu::always_inline]] inline constexpr Wide<S> exactDot(const Vector<S>& a, const Vector<S>& b) {
  return exactDot(a.x, b.x, a.y, b.y);
}
template <Scalar S>
[[gnu::always_inline]] inline constexpr Wide<S> exactCross(const Vector<S>& a, const Vector<S>& b) {
  return exactCross(a.x, b.y, a.y, b.x);
}

/// a + b * s with one rounding per component.
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> mulAdd(const Vector<S>& b, S s, const Vector<S>& a) {
  return {mulAdd(b.x, s, a.x), mulAdd(b.y, s, a.y)};
}

/// A quarter turn counter-clockwise (y up): (-y, x). MIS: vectPerp
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> perp(const Vector<S>& v) {
  return {-v.y, v.x};
}

/// A quarter turn clockwise (y up): (y, -x). MIS: vectRPerp
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> rperp(const Vector<S>& v) {
  return {v.y, -v.x};
}

/// Complex multiplication: turns v by the angle of the unit vector `rotation`. MIS: vectRotate
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> rotate(const Vector<S>& v, const Vector<S>& rotation) {
  return {cross(v.x, rotation.x, v.y, rotation.y), dot(v.x, rotation.y, v.y, rotation.x)};
}

/// The inverse of rotate. MIS: vectUnrotate
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> unrotate(const Vector<S>& v, const Vector<S>& rotation) {
  return {dot(v.x, rotation.x, v.y, rotation.y), cross(v.y, rotation.x, v.x, rotation.y)};
}

/// Square metres. In Fixed only for vectors shorter than 2^15 m. MIS: vectLengthSq
template <Scalar S>
[[gnu::always_inline]] inline constexpr S lengthSq(const Vector<S>& v) {
  return dot(v, v);
}

/// MIS: vectLength
template <Scalar S>
[[gnu::always_inline]] inline constexpr S length(const Vector<S>& v) {
  return length(v.x, v.y);
}

/// The unit vector along v; the zero vector stays zero. MIS: vectNormalize
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> normalize(const Vector<S>& v) {
  return Vector<S>(normalize(v.x, v.y));
}

/// The component of v along `onto`; zero where `onto` is zero. MIS: vectProject
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> project(const Vector<S>& v, const Vector<S>& onto) {
  const Vector<S> direction = normalize(onto);
  return direction * dot(v, direction);
}

/// The unit vector at `angle` radians from the x axis. MIS: vectForAngle
template <Scalar S>
[[gnu::always_inline]] inline Vector<S> forAngle(S angle) {
  const SinCos<S> sc = sincos(angle);
  return {sc.cos, sc.sin};
}

/// The angle of v from the x axis, in (-pi, pi]; 0 for the zero vector. MIS: vectToAngle
template <Scalar S>
[[gnu::always_inline]] inline S toAngle(const Vector<S>& v) {
  return atan2(v.y, v.x);
}

/// v, shortened to `limit` metres if it is longer. MIS: vectClamp
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> clampLength(const Vector<S>& v, S limit) {
  return length(v) > limit ? normalize(v) * limit : v;
}

/// Interpolates from a (t = 0) to b (t = 1), each component rounded once. MIS: vectLerp
template <Scalar S>
[[gnu::always_inline]] inline constexpr Vector<S> lerp(const Vector<S>& a, const Vector<S>& b, S t) {
  return mulAdd(b - a, t, a);
}

/// Square metres; see lengthSq. MIS: vectDistSq
template <Scalar S>
[[gnu::always_inline]] inline constexpr S distanceSq(const Vector<S>& a, const Vector<S>& b) {
  return lengthSq(a - b);
}

/// MIS: vectDist
template <Scalar S>
[[gnu::always_inline]] inline constexpr S distance(const Vector<S>& a, const Vector<S>& b) {
  return length(a - b);
}

/// True if a and b are less than `limit` metres apart, decided exactly. MIS: vectNear
template <Scalar S>
[[gnu::always_inline]] inline constexpr bool near(const Vector<S>& a, const Vector<S>& b, S limit) {
  const Vector<S> d = a - b;
  return exactDot(d, d) < exactProduct(limit, limit);
}

}  // namespace samestep
