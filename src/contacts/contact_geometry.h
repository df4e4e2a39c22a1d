// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/arbiter.h>
#include <samestep/body.h>

namespace samestep {

/// Where a body's coordinates lie in the world.
template <Scalar S>
struct Frame {
  Vector<S> origin{};
  Vector<S> rotation{S(1), S(0)};

  static Frame of(const Body<S>& body) { return {body.position(), body.rotation()}; }
  Vector<S> toLocal(const Vector<S>& point) const { return unrotate(point - origin, rotation); }

  friend bool operator==(const Frame&, const Frame&) = default;
};

/// Where a contact is now, from where its bodies are.
template <Scalar S>
struct ContactArms {
  /// From the centres of mass to the surface points, in world axes, m.
  Vector<S> armA, armB;
  /// Of the surface points along the normal, m; negative where the shapes overlap.
  S separation;
};

/// From A to B, a unit vector in the world.
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

// Recycling, an idea of Box2D's contact recycling by E. Catto: while two bodies stand to each other as they
// did when they were collided, normal and points are taken to be fixed to them, and shapes that were apart to
// be apart. Separations are exact all the same, for they come from where the points are now; what is off is
// the place of a point on the surface, by as much as the bodies moved, and the direction of a normal that
// belongs to B, by as much as they turned. The pose compared with is that of the last true collision, so
// nothing adds up.

/// Units of a relative pose per metre, and per 1 of cosine and sine.
inline constexpr int kPoseUnits = 1 << 14;
/// How many units no point of a shape may have moved: a millimetre, a fifth of the usual slop and a
/// twentieth of the usual margin.
inline constexpr int kSteadyUnits = 16;

/// How `b` stands to `a`.
/// @pre the origins are less than 2^16 m apart along each axis, as those of shapes that meet are
template <Scalar S>
[[gnu::always_inline]] inline RelativePose relativePose(const Frame<S>& a, const Frame<S>& b) {
  // Toward zero: the mirror image stands in the mirror image of the place.
  const auto units = [](S x) {
    if constexpr (FixedNumber<S>) {
      return static_cast<std::int32_t>(x.raw() / ((std::int64_t{1} << S::kBits) / kPoseUnits));
    } else {
      return static_cast<std::int32_t>(x * S(kPoseUnits));
    }
  };
  const Vector<S> place = a.toLocal(b.origin);
  const Vector<S> turn = unrotate(b.rotation, a.rotation);
  return {units(place.x), units(place.y),
          static_cast<std::uint32_t>(units(turn.x)) << 16 |
              (static_cast<std::uint32_t>(units(turn.y)) & 0xffffu)};
}

/// Whether no point within `reach` metres of b's origin has moved by more than kSteadyUnits.
[[gnu::always_inline]] inline bool steady(const RelativePose& now, const RelativePose& then,
                                          std::int32_t reach) {
  const auto apart = [](std::int64_t x, std::int64_t y) { return max(x - y, y - x); };
  const auto half = [](std::uint32_t bits) {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
  };
  const std::int64_t moved = max(apart(now.x, then.x), apart(now.y, then.y));
  const std::int64_t turned =
      max(apart(half(now.turn >> 16), half(then.turn >> 16)), apart(half(now.turn), half(then.turn)));
  return moved + reach * turned <= kSteadyUnits;
}

}  // namespace samestep
