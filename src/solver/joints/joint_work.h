// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/body.h>
#include <samestep/joint.h>
#include <samestep/slot_map.h>

#include "contacts/contact_row.h"
#include "solver/kernels/contact_block.h"

namespace samestep {

/// Bodies and joints of a world.
template <Scalar S>
struct JointedWorld {
  const SlotMap<Body<S>, BodyId>* bodies = nullptr;
  const SlotMap<Joint<S>, JointId>* joints = nullptr;
};

/// A body that joints hold, as they see it.
template <Scalar S>
struct JointBody {
  /// Velocity of its centre of mass, m/s, and spin, rad/s.
  Vector<S> velocity{};
  S spin{};
  /// The velocities before a pass, and what all passes of a substep have added since it began.
  Vector<S> before{};
  S spinBefore{};
  Vector<S> given{};
  S spinGiven{};
  /// Where it was when the step began: the centre of mass, m, and its rotation and angle, rad.
  Vector<S> center{}, centerOfMass{}, rotation{S(1), S(0)};
  S angle{};
  /// Way and turn since then, m and rad.
  Vector<S> moved{};
  S turned{};
  /// Its rotation now.
  Vector<S> turn{S(1), S(0)};
  std::uint32_t slot = 0;
  /// Its number in the solver.
  std::uint32_t solver = 0;
};

/// Times of a step: a substep is a whole step by sequential impulses.
template <Scalar S>
struct JointTiming {
  /// Seconds, and its inverse.
  S substep{}, perSubstep{};
  int substeps = 1;
};

/// One joint in the solver.
template <Scalar S>
struct JointWork {
  std::uint32_t joint = 0;  ///< Its slot.
  std::uint32_t a = 0, b = 0;
  PairResponse<S> response{};
  /// The spin that a turning u of 1 gives each body, and from u to the kept impulse and back; 0 where nothing
  /// turns.
  S turnA{}, turnB{}, turnScale{}, turnPerKept{};
  /// Greatest impulses in a substep, as they are kept, of the motor and of what is held. 0: any.
  S motorMost{}, forceMost{}, torqueMost{};
  Softness<S> spring{}, angularSpring{};
  JointImpulses<S> kept{};
  /// Added up over the substeps: in the world, and turning.
  Vector<S> total{};
  S totalTurn{};
  std::uint32_t begin = 0, end = 0;
  /// True if the last two rows hold a point with no more than forceMost.
  bool holdsPoint = false;
  /// True if it holds something with any force; if a tree has it, see JointTrees.
  bool isHard = false, inTree = false;
  /// Factors from an impulse, N s or N m s, to the speed of the lighter body and to the spin of the one of
  /// less moment.
  Scaled<S> perForce{}, perTorque{};
  /// True if nothing moves A, or B.
  bool fixedA = false, fixedB = false;
};

}  // namespace samestep
