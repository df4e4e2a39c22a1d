// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/limits.h>
#include <samestep/scalar.h>
#include <samestep/vector.h>

namespace samestep {

/// Bounds of velocities between two joints, so that relative speeds stay below 2^29 m/s: velocities are held
/// at 2^20 m/s and 2^16 rad/s between two joints, and arms at 2^11 m.
template <Scalar S>
inline constexpr S kMostJointSpeed = S(1 << 20);
template <Scalar S>
inline constexpr S kMostJointSpin = S(1 << 16);

/// One direction in which a joint holds its bodies, in velocity units: an impulse is the change u of the
/// relative speed that it makes, m/s or rad/s, so that no mass appears in the loop.
template <Scalar S>
struct JointRow {
  /// Direction and arms: the relative speed is that of the points along n, and of turning by the arms. A row
  /// that only turns has no n. B's less A's.
  Vector<S> n{};
  S armA{}, armB{};
  /// Changes of the speeds along n and of the spins by a u of 1.
  S speedA{}, speedB{}, spinA{}, spinB{};
  /// Negative of the relative speed that is wanted: 0 = speed + bias.
  S bias{};
  /// A spring's; 1 and 0 of what is stiff.
  S massScale{1}, impulseScale{};
  /// Bounds of the accumulated u.
  S low{}, high{};
  S sum{};
  /// Factors from u to the kept impulse, and back.
  S scale{}, perKept{};
  /// Place of the row among the kept impulses; see JointSlot.
  std::uint8_t slot = 0;
  /// 1 if it corrects a place, which the relaxing pass does not.
  std::uint8_t corrects = 0;
};

/// Names of the impulses of JointImpulses that rows keep.
enum JointSlot : std::uint8_t {
  kKeptPoint,  ///< In x and y of the world, where it adds by its direction.
  kKeptAlong,
  kKeptAcross,
  kKeptAngular,
  kKeptSpring,
  kKeptMotor,
  kKeptLower,
  kKeptUpper,
};

template <Scalar S>
[[gnu::always_inline]] inline S relativeSpeed(const JointRow<S>& row, const Vector<S>& dv, S spinA, S spinB) {
  return dot4(row.n.x, dv.x, row.n.y, dv.y, row.armB, spinB, -row.armA, spinA);
}

/// Answers an impulse u.
template <Scalar S>
[[gnu::always_inline]] inline void answer(const JointRow<S>& row, S u, Vector<S>& velocityA, S& spinA,
                                          Vector<S>& velocityB, S& spinB) {
  const S most = kMostJointSpeed<S>, spin = kMostJointSpin<S>;
  velocityA = heldWithin(velocityA - row.n * (row.speedA * u), most);
  velocityB = heldWithin(velocityB + row.n * (row.speedB * u), most);
  spinA = clamp(mulAdd(-row.spinA, u, spinA), -spin, spin);
  spinB = clamp(mulAdd(row.spinB, u, spinB), -spin, spin);
}

/// Solves one row for the velocities.
/// @param corrects  whether it also corrects its place
template <Scalar S>
[[gnu::always_inline]] inline void solveRow(JointRow<S>& row, bool corrects, Vector<S>& velocityA, S& spinA,
                                            Vector<S>& velocityB, S& spinB) {
  const S speed = relativeSpeed(row, velocityB - velocityA, spinA, spinB);
  const S wanted = speed + (row.corrects != 0 && !corrects ? S(0) : row.bias);
  const S before = row.sum;
  row.sum = clamp(before - dot(row.massScale, wanted, row.impulseScale, before), row.low, row.high);
  answer(row, row.sum - before, velocityA, spinA, velocityB, spinB);
}

}  // namespace samestep
