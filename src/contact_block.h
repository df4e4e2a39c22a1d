// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

/// The records that the soft step's kernels work on. Plain arrays: a kernel built for one processor must share
/// no inline function with the rest of the library.
namespace samestep {

/// Pairs side by side in a block: as many as the widest kernel takes at once.
inline constexpr int kBlockLanes = 4;

/// One body in the substeps.
template <class T>
struct alignas(32) SoftBody {
  /// x, y, angular, 0: m/s, rad/s.
  T velocity[4];
  /// Since the step began: x, y, m; the angle, rad; half its square: how far turning moves a point towards
  /// the centre, per metre.
  T moved[4];
};

/// What else a substep needs of a body.
template <class T>
struct alignas(32) SoftDrive {
  /// Added to the velocity by each substep.
  T push[4];
  /// The velocity of the substep before contacts: what it is less by holds the impulses of the contacts.
  T base[4];
  /// What damping leaves of a velocity in one substep.
  T kept;
};

/// One axis of a contact point, the normal n or the tangent t = perp(n), of each lane. An impulse u is the
/// change of the relative speed that the masses alone would make: no mass appears in the loop.
template <class T, bool kStoresSpins>
struct BlockAxis {
  /// r x axis of both bodies, m.
  T armA[kBlockLanes], armB[kBlockLanes];
  /// The u that changes the speed at the point by 1, in [0, 1].
  T mass[kBlockLanes];
  /// Accumulated u, m/s.
  T sum[kBlockLanes];
};
/// Where products are dear, the spin that a u of 1 gives each body is kept, too, 1/m.
template <class T>
struct BlockAxis<T, true> : BlockAxis<T, false> {
  T spinA[kBlockLanes], spinB[kBlockLanes];
};

template <class T, bool kStoresSpins>
struct BlockPoint {
  BlockAxis<T, kStoresSpins> normal, tangent;
  /// Between the surfaces along the normal when the step began, m.
  T separation[kBlockLanes];
};

/// Up to four pairs that share no body but such as nothing moves.
template <class T, bool kStoresSpins>
struct alignas(64) ContactBlock {
  std::uint32_t bodyA[kBlockLanes], bodyB[kBlockLanes];
  /// Points of each lane, and the most of them.
  std::uint8_t count[kBlockLanes], points;
  /// A bit per lane: whether contacts leave A or B as it is; whether its surface is round, so that turning
  /// does not move it; whether the contact is one with a body that nothing moves.
  std::uint8_t fixedA, fixedB, roundA, roundB, stiff;
  /// Whether any point bounces.
  std::uint8_t bounces;
  alignas(32) T normalX[kBlockLanes];
  T normalY[kBlockLanes];
  /// The part of u that changes the speed of A; the rest that of B.
  T shareA[kBlockLanes];
  /// How an impulse turns the bodies, 1/m^2: spin = moment * arm * u.
  T momentA[kBlockLanes], momentB[kBlockLanes];
  T friction[kBlockLanes];
  /// The surface's own speed along the tangent, m/s.
  T surface[kBlockLanes];
  BlockPoint<T, kStoresSpins> point[2];
};

/// What a block needs once in a while.
template <class T>
struct alignas(32) BlockRest {
  /// The sums added up over the substeps.
  T normalTotal[2][kBlockLanes], tangentTotal[2][kBlockLanes];
  /// What a bounce shall leave, m/s; 0 for none.
  T bounce[2][kBlockLanes];
  /// Which pair of the Space each lane is; kNoPair for an empty one.
  std::uint32_t pair[kBlockLanes];
  static constexpr std::uint32_t kNoPair = 0xffffffffu;
};

/// A damped spring, made to be stable for its substep.
template <class T>
struct Softness {
  T biasRate;      ///< Part of an overlap that goes, 1/s.
  T massScale;     ///< How hard the speed is corrected, in [0, 1].
  T impulseScale;  ///< How much of the accumulated impulse is given back, in [0, 1].
};

/// Of a substep.
template <class T>
struct SoftConstants {
  /// Between bodies that move, and against one that does not.
  Softness<T> softness[2];
  /// Seconds, and its inverse.
  T substep, perSubstep;
  /// The greatest speed of pushing apart, m/s.
  T pushSpeed;
  /// The greatest accumulated u, m/s.
  T mostSum;
};

/// One pass over blocks, in order.
template <class T, bool kStoresSpins>
using ContactPass = void (*)(ContactBlock<T, kStoresSpins>* blocks, BlockRest<T>* rests, std::uint32_t count,
                             SoftBody<T>* bodies, const SoftConstants<T>& constants);

/// The passes of one kernel.
template <class T, bool kStoresSpins>
struct ContactPasses {
  /// With springs.
  ContactPass<T, kStoresSpins> solve;
  /// Without; adds the substep's sums to the totals.
  ContactPass<T, kStoresSpins> relax;
};

}  // namespace samestep
