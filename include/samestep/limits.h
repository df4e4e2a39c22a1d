// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

#include <samestep/scalar.h>
#include <samestep/vector.h>

namespace samestep {

// The supported ranges, the same for every scalar. A caller's value outside them is refused; a value that
// leaves them during a step is held at the limit and listed as an event.

/// Distance from the origin that a body may have, metres, unless the Space says otherwise.
template <Scalar S>
inline constexpr S kDefaultWorldExtent = S(1 << 15);
/// The largest extent a Space may ask for, metres.
template <Scalar S>
inline constexpr S kMaxWorldExtent = S(1 << 20);
/// Limit of each component of a velocity, m/s.
template <Scalar S>
inline constexpr S kMaxSpeed = S(1 << 10);
/// rad/s.
template <Scalar S>
inline constexpr S kMaxAngularSpeed = S(1 << 8);
/// Limit of a body's angle, rad: beyond it a turn is no longer resolved.
template <Scalar S>
inline constexpr S kMaxAngle = S(1 << 30);
/// kg. A mass may also be 0: to be accumulated from shapes.
template <Scalar S>
inline constexpr S kMinMass = ratio<S>(1, 1000);
template <Scalar S>
inline constexpr S kMaxMass = S(1000000);
/// kg m^2, as the caller may state it. Moments accumulated from shapes may be smaller.
template <Scalar S>
inline constexpr S kMinMoment = ratio<S>(1, 1 << 20);
template <Scalar S>
inline constexpr S kMaxMoment = S(1 << 30);
/// Limit of the inverse moment times a mass, 1/m^2: a disc of 2^-5 m has 2^11.
template <Scalar S>
inline constexpr S kMaxRelativeMoment = S(1 << 18);
/// Limit of each component of an acceleration, m/s^2.
template <Scalar S>
inline constexpr S kMaxAcceleration = S(1 << 15);
/// Limit of each component of a force, N, and of a torque, N m.
template <Scalar S>
inline constexpr S kMaxForce = S(1 << 30);
/// Limit of the distance of the centre of mass from the body's origin, along each axis, metres.
template <Scalar S>
inline constexpr S kMaxCenterOfMass = S(1 << 8);
/// Number of pairs of shapes a Space may hold, unless it or who reads a world says otherwise: four for each
/// of the bodies that a reader lets in. A step takes up to 3.3 KB for each of them, see docs/formats.md.
inline constexpr std::uint32_t kDefaultMaxPairs = 1u << 18;
/// The most it may be told to hold.
inline constexpr std::uint32_t kMostPairs = 1u << 28;
/// Up to here it is counted how long a body has been at rest, seconds; the longest time after which bodies
/// may be told to sleep.
template <Scalar S>
inline constexpr S kMaxRestTime = S(1 << 10);
/// Seconds in one step.
template <Scalar S>
inline constexpr S kMaxTimeStep = S(1);

/// True if |x| <= limit; false for NaN.
template <Scalar S>
[[gnu::always_inline]] inline constexpr bool within(S x, S limit) {
  return x >= -limit && x <= limit;
}
template <Scalar S>
[[gnu::always_inline]] inline constexpr bool within(const Vector<S>& v, S limit) {
  return within(v.x, limit) && within(v.y, limit);
}

/// v, each component held within +-limit.
template <Scalar S>
inline constexpr Vector<S> heldWithin(const Vector<S>& v, S limit) {
  return {clamp(v.x, -limit, limit), clamp(v.y, -limit, limit)};
}
/// The number a Scaled stands for, held within +-limit.
template <Scalar S>
[[gnu::always_inline]] inline constexpr S toScalarWithin(const Scaled<S>& x, S limit) {
  const Scaled<S> most = toScaled(limit);
  return x > most ? limit : x < -most ? -limit : toScalar<S>(x);
}
/// Clamps a number to the range of S: for getters, which saturate.
template <Scalar S>
[[gnu::always_inline]] inline constexpr S saturated(const Scaled<S>& x) {
  return toScalarWithin<S>(x, std::numeric_limits<S>::max());
}

}  // namespace samestep
