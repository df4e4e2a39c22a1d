// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/limits.h>
#include <samestep/vector.h>

namespace samestep {

/// Method by which contacts are solved.
enum class SolverKind : std::uint8_t {
  /// Method of the MIS and Chipmunk: `iterations` passes over all contacts for the speeds, with bias
  /// velocities that push overlaps apart. Fits few contacts, and what must behave like Chipmunk.
  sequentialImpulses = 0,
  /// `substeps` small steps with soft contacts and relaxation: for equal work far more accurate in piles and
  /// stacks.
  softStep = 1,
};

/// Numbers with which the soft step computes contacts, where the scalar leaves a choice.
enum class ContactPrecision : std::uint8_t {
  /// Computes to the unit of the scalar.
  accurate = 0,
  /// Fixed: in integers of 32 bits, more at a time: the accuracy of a float, relative to the fastest body
  /// that touches anything and to the largest impulse. A step in which a number would not fit is made
  /// accurately, see Space::accurateInstead. Double: no difference.
  fast = 1,
};

/// State variables of a Space that a user sets, as the MIS names them, and those of the soft step.
template <Scalar S>
struct Settings {
  SolverKind solver = SolverKind::softStep;
  ContactPrecision precision = ContactPrecision::accurate;
  /// True if bodies that go far in a step are stopped where they meet something that never moves, or that
  /// moves by itself, see docs/continuous.md: 0 or 1.
  std::uint8_t continuous = 0;
  std::uint8_t unused = 0;
  /// Sequential impulses: how often all contacts are solved in a step, 1 to 1000.
  std::int32_t iterations = 10;
  /// Soft step: how many substeps a step has, 1 to 100. They are for contacts: what nothing touches moves as
  /// constant forces have it, to rounding, with any number of them.
  std::int32_t substeps = 4;
  /// Number of steps for which a contact that came apart keeps its impulses.
  std::uint32_t collisionPersistence = 3;
  /// m/s^2
  Vector<S> gravity{};
  /// Fraction of every velocity that is left after one second without forces, in [0, 1].
  S damping{1};
  /// Sequential impulses: how far shapes may overlap without being pushed apart, m.
  S collisionSlop = ratio<S>(1, 200);
  /// Sequential impulses: what is left of an overlap after one second, in [0, 1].
  S collisionBias = ratio<S>(1797010, 1000000000);
  /// Soft step: the greatest stiffness of contacts, cycles per second, 0 to 1000. They are as stiff as the
  /// substeps resolve, a sixth of their rate (40 at 60 steps of 4 substeps), and no stiffer than this: at the
  /// default more substeps make stiffer contacts, so that errors fall with them.
  S contactHertz{1000};
  /// Soft step: how strongly a contact's spring is damped; 1 is critical.
  S contactDamping{10};
  /// Soft step: the greatest speed at which an overlap is pushed apart, m/s.
  S contactPushSpeed{3};
  /// Soft step: shapes this close are solved before they touch, m.
  S contactMargin = ratio<S>(1, 50);
  /// Soft step: slower impacts do not bounce, m/s.
  S bounceThreshold{1};
  /// Bodies are held within this distance of the origin along each axis, m.
  S worldExtent = kDefaultWorldExtent<S>;
  /// For how long all bodies of an island have been at rest when it falls asleep, s, up to kMaxRestTime; 0:
  /// nothing ever sleeps. See docs/sleeping.md.
  S sleepTimeThreshold{};
  /// A body is at rest while no point of it can be faster, m/s: |vx| + |vy| + |w| times how far its shapes
  /// reach. With 0 only what stands still is.
  S idleSpeedThreshold = ratio<S>(1, 20);

  friend bool operator==(const Settings&, const Settings&) = default;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("solver", self.solver);
    visit("precision", self.precision);
    visit("continuous", self.continuous);
    visit("iterations", self.iterations);
    visit("substeps", self.substeps);
    visit("collisionPersistence", self.collisionPersistence);
    visit("gravity", self.gravity);
    visit("damping", self.damping);
    visit("collisionSlop", self.collisionSlop);
    visit("collisionBias", self.collisionBias);
    visit("contactHertz", self.contactHertz);
    visit("contactDamping", self.contactDamping);
    visit("contactPushSpeed", self.contactPushSpeed);
    visit("contactMargin", self.contactMargin);
    visit("bounceThreshold", self.bounceThreshold);
    visit("worldExtent", self.worldExtent);
    visit("sleepTimeThreshold", self.sleepTimeThreshold);
    visit("idleSpeedThreshold", self.idleSpeedThreshold);
  }
};

}  // namespace samestep
