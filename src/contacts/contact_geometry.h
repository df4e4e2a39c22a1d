// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/arbiter.h>
#include <samestep/body.h>

namespace samestep {

/// Coordinates of a body, as they lie in the world.
template <Scalar S>
struct Frame {
  Vector<S> origin{};
  Vector<S> rotation{S(1), S(0)};

  static Frame of(const Body<S>& body) { return {body.position(), body.rotation()}; }
  Vector<S> toLocal(const Vector<S>& point) const { return unrotate(point - origin, rotation); }
  Vector<S> toWorld(const Vector<S>& point) const { return origin + rotate(point, rotation); }

  friend bool operator==(const Frame&, const Frame&) = default;
};

/// Contact as it is now, from where its bodies are.
template <Scalar S>
struct ContactArms {
  /// Lever arms from the centres of mass to the surface points, in world axes, m.
  Vector<S> armA, armB;
  /// Separation of the surface points along the normal, m; negative where the shapes overlap.
  S separation;
};

/// Normal from A to B, a unit vector in the world.
template <Scalar S>
[[gnu::always_inline]] inline Vector<S> worldNormal(const Pair<S>& pair, const Body<S>& a) {
  return rotate(pair.localNormal, a.rotation());
}

/// @param normal  the pair's worldNormal
template <Scalar S>
[[gnu::always_inline]] inline ContactArms<S> contactArms(const Contact<S>& contact, const Vector<S>& normal,
                                                         const Body<S>& a, const Body<S>& b) {
  const Vector<S> armA = rotate(contact.anchorA - a.centerOfMass(), a.rotation());
  const Vector<S> armB = rotate(contact.anchorB - b.centerOfMass(), b.rotation());
  return {armA, armB, dot((b.worldCenter() - a.worldCenter()) + (armB - armA), normal)};
}

/// kg of the lighter of two bodies, of which one can be moved.
template <Scalar S>
Scaled<S> lighterMass(const Body<S>& a, const Body<S>& b) {
  return toScaled((a.inverseMass() > b.inverseMass() ? a : b).mass());
}

// Recycling, an idea of Box2D's contact recycling by E. Catto: while two bodies stand to each other as they
// did when they were collided, normal and points are taken to be fixed to them, and shapes that were apart to
// be apart. Separations are exact all the same, for they come from where the points are now; what is off is
// the place of a point on the surface, by as much as the bodies moved, and the direction of a normal that
// belongs to B, by as much as they turned. The pose compared with is that of the last true collision, so
// nothing adds up.

/// Units of a relative pose per metre, and per 1 of a cosine or sine.
inline constexpr int kPoseBits = 16;
inline constexpr int kPoseUnits = 1 << kPoseBits;
inline constexpr int kTurnBits = 29;
/// Units of a shape's reach per metre.
inline constexpr int kReachBits = 4;
inline constexpr int kReachUnits = 1 << kReachBits;
/// Units that no point of a shape may have moved: a millimetre, a fifth of the usual slop and a twentieth of
/// the usual margin.
inline constexpr int kSteadyUnits = 65;

/// A turn in 32 bits: the cosine or the sine, whichever is smaller in size, which is where it tells most, and
/// in the two lowest bits which one it is and the sign of the other.
template <Scalar S>
[[gnu::always_inline]] inline std::uint32_t turnBits(const Vector<S>& turn) {
  // Equal numbers take the cosine.
  const bool bySine = (turn.x - turn.y) * (turn.x + turn.y) > S(0);
  const S small = bySine ? turn.y : turn.x, large = bySine ? turn.x : turn.y;
  std::int32_t units;
  if constexpr (FixedNumber<S>) {
    units = static_cast<std::int32_t>(small.raw() / (std::int64_t{1} << (S::kBits - kTurnBits)));
  } else {
    units = static_cast<std::int32_t>(small * S(1 << kTurnBits));
  }
  return static_cast<std::uint32_t>(units) << 2 | (bySine ? 2u : 0u) | (large < S(0) ? 1u : 0u);
}

/// Pose of `b` relative to `a`. What is farther than 2^15 m is told modulo 2^16 m: shapes that meet before
/// and after never moved by that.
template <Scalar S>
[[gnu::always_inline]] inline RelativePose relativePose(const Frame<S>& a, const Frame<S>& b) {
  // Units are cut toward zero: the mirror image stands in the mirror image of the place.
  const auto units = [](S x) {
    if constexpr (FixedNumber<S>) {
      return static_cast<std::int32_t>(x.raw() / ((std::int64_t{1} << S::kBits) / kPoseUnits));
    } else {
      return static_cast<std::int32_t>(static_cast<std::int64_t>(x * S(kPoseUnits)));
    }
  };
  const Vector<S> place = a.toLocal(b.origin);
  return {units(place.x), units(place.y), turnBits(unrotate(b.rotation, a.rotation))};
}

/// Contact recycling test: true if no point within a reach of b's origin has moved by more than kSteadyUnits,
/// whatever was cut off both poses. A turn by more than 2^-8, or across a diagonal, where the other number
/// becomes the smaller one, counts as far.
/// @param reach  in units of 1 / kReachUnits m
[[gnu::always_inline]] inline bool steady(const RelativePose& now, const RelativePose& then,
                                          std::int32_t reach) {
  constexpr std::uint32_t kFarTurn = 1u << (kTurnBits - 8);
  const std::uint32_t turn = now.turn - then.turn;
  if ((turn & 3u) != 0 || turn + 4 * kFarTurn > 8 * kFarTurn) return false;
  const auto apart = [](std::uint32_t difference) {
    const std::int64_t size = static_cast<std::int32_t>(difference);
    return max(size, -size) + 1;
  };
  const std::int64_t x = apart(static_cast<std::uint32_t>(now.x) - static_cast<std::uint32_t>(then.x));
  const std::int64_t y = apart(static_cast<std::uint32_t>(now.y) - static_cast<std::uint32_t>(then.y));
  const std::int64_t turned = (apart(turn) >> 2) + 1;
  constexpr int kPerUnit = kTurnBits - kPoseBits + kReachBits;
  // Most have hardly moved.
  if (((x + y) << kPerUnit) + 2 * reach * turned <= std::int64_t{kSteadyUnits - 1} << kPerUnit) return true;
  // A turn changes a sine s by its size times sqrt(1 - s^2) on the way, and the inverse of that root is at
  // most 1 + s^2 for the smaller of sine and cosine.
  constexpr int kPart = 12;
  const std::int64_t sine = (apart(now.turn) >> (2 + kTurnBits - kPart)) + (1 << (kPart - 8)) + 1;
  const std::int64_t perTurn = (1 << kPart) + ((sine * sine) >> kPart) + 1;
  const std::int64_t room = kSteadyUnits - 1 - ((reach * turned * perTurn) >> (kPerUnit + kPart));
  return max(x, y) <= room && x * x + y * y <= room * room;
}

/// Bits of a kept rotation.
inline constexpr int kRotationBits = 30;
/// Metres that a point of a shape moves at the most while its body turns away from the rotation that a pair
/// has kept.
template <Scalar S>
inline constexpr S kKeptWay = ratio<S>(1, 128);

template <Scalar S>
[[gnu::always_inline]] inline KeptRotation keptRotation(const Vector<S>& rotation) {
  const auto units = [](S x) {
    if constexpr (FixedNumber<S>) {
      return static_cast<std::int32_t>(x.raw() / (std::int64_t{1} << (S::kBits - kRotationBits)));
    } else {
      return static_cast<std::int32_t>(x * S(1 << kRotationBits));
    }
  };
  return {units(rotation.x), units(rotation.y)};
}
/// Cosine and sine of a kept rotation.
template <Scalar S>
[[gnu::always_inline]] inline Vector<S> rotationOf(const KeptRotation& kept) {
  const auto number = [](std::int32_t x) {
    if constexpr (FixedNumber<S>) {
      return S::fromRaw(std::int64_t{x} * (std::int64_t{1} << (S::kBits - kRotationBits)));
    } else {
      return static_cast<S>(x) * S(0x1p-30);
    }
  };
  return {number(kept.x), number(kept.y)};
}

template <Scalar S>
void keepRotations(Pair<S>& pair, const Vector<S>& a, const Vector<S>& b) {
  pair.rotationA = keptRotation(a);
  pair.rotationB = keptRotation(b);
}

/// Takes the rotations that the bodies of a pair have now where either has turned so far from the kept one
/// that a point of its shape may have moved by more than kKeptWay. The soft step takes normals and arms as
/// they were: a contact that turns with its bodies, by ever so little, is what lets high stacks buckle.
/// @param reach  of the larger shape, in units of 1 / kReachUnits m
template <Scalar S>
[[gnu::always_inline]] inline void followRotations(Pair<S>& pair, const Frame<S>& a, const Frame<S>& b,
                                                   std::int32_t reach) {
  const Vector<S> keptA = rotationOf<S>(pair.rotationA), keptB = rotationOf<S>(pair.rotationB);
  const S turned = max(abs(cross(keptA, a.rotation)), abs(cross(keptB, b.rotation)));
  const bool near = turned * S(reach) <= kKeptWay<S> * S(kReachUnits);
  if (near && dot(keptA, a.rotation) > S(0) && dot(keptB, b.rotation) > S(0)) return;
  keepRotations(pair, a.rotation, b.rotation);
}

}  // namespace samestep
