// SPDX-License-Identifier: MIT
#pragma once

#include "solver/kernels/contact_block.h"

/// The passes over bodies, written once for every kernel, as the one over contacts: see solve_contacts.h. The
/// lanes are here x, y and turning of a body, and a fourth one that stays 0.
namespace samestep {
namespace {

/// Number of a body's four numbers that a kernel looks at: one at a time leaves out the last.
template <class L>
inline constexpr int kRowUsed = L::kWidth == 1 ? 3 : 4;

/// Marks what of numbers of the row had to be held.
template <class L, class Speed>
[[gnu::noinline, gnu::cold]] void markHeld(SoftMarks& marks, int first, const Speed* base,
                                           typename L::V wanted) {
  alignas(sizeof(typename L::V)) Speed free[L::kWidth];
  L::store(free, wanted);
  for (int i = 0; i < L::kWidth; ++i) {
    if (base[i] != free[i]) marks.held = static_cast<std::uint8_t>(marks.held | 1 << (first + i));
  }
}

/// Gives the velocity what contacts gave in the last substep, its difference from the base, once more.
template <class L, class N = typename L::Numbers>
std::uint64_t driveBodies(SoftBody<N>* bodies, SoftDrive<N>* drives, SoftMarks* marks, std::uint32_t count,
                          const SoftConstants<N>&) {
  using V = typename L::V;
  L lanes;
  for (std::uint32_t i = 0; i < count; ++i) {
    SoftBody<N>& body = bodies[i];
    SoftDrive<N>& drive = drives[i];
    const auto kept = L::factor(drive.limit[3]);
    for (int k = 0; k < kRowUsed<L>; k += L::kWidth) {
      const V velocity = L::load(body.velocity + k);
      const V given = velocity - L::load(drive.base + k);
      const V free = L::addProduct(velocity, kept, L::load(drive.push + k));
      const V limit = L::load(drive.limit + k);
      const V base = L::within(free, -limit, limit);
      L::store(drive.base + k, base);
      L::store(body.velocity + k, lanes.checkedSpeed(base + given, k));
      if (L::differ(base, free)) [[unlikely]]
        markHeld<L>(marks[i], k, drive.base + k, free);
    }
  }
  return lanes.left();
}

/// True if contacts have changed the velocity of a body in this substep.
template <class L, class N>
[[gnu::always_inline]] inline bool isHeld(const SoftBody<N>& body, const SoftDrive<N>& drive) {
  bool held = false;
  for (int k = 0; k < kRowUsed<L>; k += L::kWidth) {
    held = L::differ(L::load(body.velocity + k), L::load(drive.base + k)) || held;
  }
  return held;
}

/// Moves bodies that nothing holds at the mean of their velocities before and after the substep, as under a
/// constant force they do; those that contacts hold go where these make them go.
template <class L, class N = typename L::Numbers>
std::uint64_t moveBodies(SoftBody<N>* bodies, SoftDrive<N>* drives, SoftMarks* marks, std::uint32_t count,
                         const SoftConstants<N>& constants) {
  L lanes;
  const auto substep = L::factor(constants.substep), half = L::factor(constants.halfSubstep);
  for (std::uint32_t i = 0; i < count; ++i) {
    SoftBody<N>& body = bodies[i];
    const SoftDrive<N>& drive = drives[i];
    const bool held = isHeld<L>(body, drive);
    for (int k = 0; k < kRowUsed<L>; k += L::kWidth) {
      auto moved = L::addProduct(L::load(body.velocity + k), substep, L::load(body.moved + k));
      if (!held) moved = L::addProduct(-L::load(drive.push + k), half, moved);
      L::store(body.moved + k, lanes.checkedWay(moved));
    }
    body.moved[3] = L::bend(body.moved[2], marks[i].bendBits);
  }
  return lanes.left();
}

}  // namespace
}  // namespace samestep
