// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdint>

/// The records that the soft step's kernels work on. Plain arrays: a kernel built for one processor must
/// share no inline function with the rest of the library.
namespace samestep {

/// Numbers of a block that are a scalar as it is.
template <class S, bool kSpins>
struct PlainNumbers {
  /// Pairs side by side in a block: as many as the widest kernel takes at once.
  static constexpr int kLanes = std::floating_point<S> ? 8 : 4;
  using Coefficient = S;  ///< Directions, arms, masses.
  using Speed = S;        ///< Number type of a body's speed.
  using Sum = S;          ///< Impulses and what is found from speeds.
  /// True if the spin per impulse is kept, where products are dear.
  static constexpr bool kStoresSpins = kSpins;
};

/// Coefficients as integers of 32 bits in units of powers of two. A body's turning is kept as the way of a
/// point at its radius, a power of two no less than the arms of its contacts.
struct IntegerUnits {
  using Coefficient = std::int32_t;
  static constexpr bool kStoresSpins = true;
  /// Fraction bits of directions, of arms by radius, of masses, shares and softness; of rates, speeds by
  /// ways; of spins per impulse.
  static constexpr int kUnitBits = 30, kRateBits = 22, kSpinBits = 26;
};

/// Speeds, ways and impulses in 64 bits: the accuracy and the range of Q32.32.
struct WideNumbers : IntegerUnits {
  static constexpr int kLanes = 8;
  using Speed = std::int64_t;
  using Sum = std::int64_t;
  static constexpr int kFrictionBits = 22;
  /// Limits of speeds, by the radius where they turn: 2^26 m/s; and of friction, 2^20 m/s.
  static constexpr std::int64_t kMostSpeed = std::int64_t{1} << 58, kMostLimit = std::int64_t{1} << 52;
};

/// All in 32 bits. Speeds and impulses have one unit for the whole step, chosen by the largest of them, and
/// ways another.
struct FastNumbers : IntegerUnits {
  static constexpr int kLanes = 16;
  using Speed = std::int32_t;
  using Sum = std::int32_t;
  static constexpr int kFrictionBits = 28;
  /// Bound of speeds and impulses in size; ways must stay below half of it, changes of impulses below a
  /// quarter: then no sum leaves 32 bits.
  static constexpr std::int32_t kRange = 1 << 28;
};

/// One body in the substeps.
template <class N>
struct alignas(4 * sizeof(typename N::Speed)) SoftBody {
  /// x, y, angular, 0: m/s, rad/s.
  typename N::Speed velocity[4];
  /// Motion since the step began: x, y, m; the angle, rad; half its square: how far turning moves a point
  /// towards the centre, per metre.
  typename N::Speed moved[4];
};

/// Further numbers of a body that a substep needs.
template <class N>
struct alignas(4 * sizeof(typename N::Speed)) SoftDrive {
  /// Added to the velocity by each substep; the last is 0.
  typename N::Speed push[4];
  /// The velocity of the substep before contacts: what it is less by holds the impulses of the contacts.
  /// The last is 0.
  typename N::Speed base[4];
  /// Limits of the velocity before contacts; the last is what damping leaves of a velocity in a substep, no
  /// less than 0.
  typename N::Speed limit[4];
};

/// Marks of a body.
struct SoftMarks {
  /// A bit for each of x, y and angular whose velocity had to be held at its limit.
  std::uint8_t held;
  /// Bits by which the square of a turning of integers is shifted to be a bend, which depends on the radius.
  std::uint8_t bendBits;
};

/// One axis of a contact point, the normal n or the tangent t = perp(n), of each lane. An impulse u is the
/// change of the relative speed that the masses alone would make: no mass appears in the loop.
template <class N, bool = N::kStoresSpins>
struct BlockAxis {
  /// r x axis of both bodies, m.
  typename N::Coefficient armA[N::kLanes], armB[N::kLanes];
  /// The u that changes the speed at the point by 1, in [0, 1].
  typename N::Coefficient mass[N::kLanes];
  /// Accumulated u, m/s.
  typename N::Sum sum[N::kLanes];
};
template <class N>
struct BlockAxis<N, true> : BlockAxis<N, false> {
  /// The spin that a u of 1 gives each body, 1/m.
  typename N::Coefficient spinA[N::kLanes], spinB[N::kLanes];
};

template <class N>
struct BlockPoint {
  BlockAxis<N> normal, tangent;
  /// Separation of the surfaces along the normal when the step began, m.
  alignas(64) typename N::Speed separation[N::kLanes];
  /// Speed at which the surfaces may still come nearer, or, if not above 0, at which a spring holds them to
  /// overlap less: by where the bodies were when they moved last, m/s.
  typename N::Speed target[N::kLanes];
};

/// Response of the bodies' spins to an impulse, 1/m^2: spin = moment * arm * u.
template <class N, bool = N::kStoresSpins>
struct BlockMoments {
  typename N::Coefficient momentA[N::kLanes], momentB[N::kLanes];
};
template <class N>
struct BlockMoments<N, true> {};

/// Input from which the points of a block are prepared.
template <class N>
struct alignas(64) BlockInput {
  using Coefficient = typename N::Coefficient;
  /// Rotation of each body.
  Coefficient cosA[N::kLanes], sinA[N::kLanes], cosB[N::kLanes], sinB[N::kLanes];
  /// Normal in A's coordinates.
  Coefficient normalX[N::kLanes], normalY[N::kLanes];
  /// The spin that an impulse u of 1 gives each body at an arm of 1.
  Coefficient momentA[N::kLanes], momentB[N::kLanes];
  struct Point {
    /// Lever arms from the centres of mass, in the coordinates of each body.
    Coefficient armAX[N::kLanes], armAY[N::kLanes], armBX[N::kLanes], armBY[N::kLanes];
    /// 1, or all bits of an integer; 0 where the pair has no such point.
    Coefficient present[N::kLanes];
  } point[2];
};

/// Pairs that share no body but such as nothing moves.
template <class N>
struct alignas(64) ContactBlock {
  std::uint32_t bodyA[N::kLanes], bodyB[N::kLanes];
  /// Points of each lane, and the most of them.
  std::uint8_t count[N::kLanes], points;
  /// A bit per lane: whether contacts leave A or B as it is; whether its surface is round, so that turning
  /// does not move it; whether the contact is one with a body that nothing moves; whether springs do
  /// not push it apart; and whether velocities of pushing do, see BlockSolver::run.
  std::uint16_t fixedA, fixedB, roundA, roundB, stiff, stays, pushed;
  /// Marks: any point bounces; any strikes, that is approaches fast and holds nothing yet.
  std::uint8_t bounces, strikes;
  /// Shift of the friction in 32 bits: it is 2^this times what is written, where that does not hold it.
  std::uint8_t frictionShift;
  alignas(64) typename N::Coefficient normalX[N::kLanes];
  typename N::Coefficient normalY[N::kLanes];
  /// The part of u that changes the speed of A; the rest that of B.
  typename N::Coefficient shareA[N::kLanes];
  /// Part of the push along the normal.
  typename N::Coefficient pushAX[N::kLanes], pushAY[N::kLanes];
  // Takes no room where spins are kept: what follows stays aligned.
  [[no_unique_address]] BlockMoments<N> moments;
  typename N::Coefficient friction[N::kLanes];
  /// The surface's own speed along the tangent, m/s.
  typename N::Speed surface[N::kLanes];
  BlockPoint<N> point[2];
};

/// Cold data of a block: what it needs once in a while.
template <class N>
struct alignas(64) BlockRest {
  /// The sums added up over the substeps.
  typename N::Sum normalTotal[2][N::kLanes], tangentTotal[2][N::kLanes];
  /// Accumulated u of the pushing apart, m/s: of pairs that are pushed.
  typename N::Sum pushSum[2][N::kLanes];
  /// Speed that a bounce shall leave, m/s; 0 for none.
  typename N::Sum bounce[2][N::kLanes];
  /// Pair of the Space in each lane; kNoPair for an empty one.
  std::uint32_t pair[N::kLanes];
  static constexpr std::uint32_t kNoPair = 0xffffffffu;
};

/// A damped spring, made to be stable for its substep.
template <class T>
struct Softness {
  T biasRate;      ///< Part of an overlap that goes, 1/s.
  T massScale;     ///< Fraction of the speed that is corrected, in [0, 1].
  T impulseScale;  ///< Fraction of the accumulated impulse that is given back, in [0, 1].
};

/// Constants of a substep.
template <class N>
struct SoftConstants {
  /// Between bodies that move, and against one that does not.
  Softness<typename N::Coefficient> softness[2];
  /// Inverse of a substep's seconds.
  typename N::Coefficient perSubstep;
  /// The greatest speed of pushing apart, m/s.
  typename N::Speed pushSpeed;
  /// The greatest accumulated u, m/s.
  typename N::Sum mostSum;
  /// The greatest gap and the greatest overlap that a kernel of limited range tells apart, m.
  typename N::Speed mostGap, mostOverlap;
  /// The substep and half of it as the factor of a speed that gives the way, s.
  typename N::Speed substep, halfSubstep;
};

/// Passes over `count` blocks, in order.
/// @return not 0 where a number left the kernel's range: the results are then worth nothing
template <class N>
using ContactPass = std::uint64_t (*)(ContactBlock<N>* blocks, BlockRest<N>* rests, std::uint32_t count,
                                      SoftBody<N>* bodies, const SoftConstants<N>& constants);

/// Fills the arms, spins and masses of a block and its normals in the world, and gives the sums that its
/// points hold to the bodies' velocities.
/// @return not 0 where a number left the kernel's range: the results are then worth nothing
template <class N>
using ContactPreparation = std::uint64_t (*)(const BlockInput<N>& input, ContactBlock<N>& block,
                                             SoftBody<N>* bodies);

/// Passes over `count` bodies.
/// @return as a ContactPass
template <class N>
using BodyPass = std::uint64_t (*)(SoftBody<N>* bodies, SoftDrive<N>* drives, SoftMarks* marks,
                                   std::uint32_t count, const SoftConstants<N>& constants);

/// Passes over the contacts that a kernel has.
template <class N>
struct SoftPasses {
  ContactPreparation<N> prepare;
  /// Solves with springs, before any body moves; and after one did and contacts relaxed.
  ContactPass<N> start, solve;
  /// Solves without springs; adds the substep's sums to the totals.
  ContactPass<N> relax;
  /// Pushes pairs apart: the bodies' velocities are those of pushing.
  ContactPass<N> push;
  /// Gives bodies the velocities of a substep before contacts, and once more what contacts gave in the last.
  BodyPass<N> drive;
  /// Moves them.
  BodyPass<N> move;
};

}  // namespace samestep
