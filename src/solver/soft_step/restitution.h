// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/body.h>
#include <samestep/scalar.h>

namespace samestep {

/// A body at the end of a step in which something bounces.
template <Scalar S>
struct BounceBody {
  S before[3]{};    ///< x, y, angular when the step began: m/s, rad/s.
  S velocity[3]{};  ///< After contacts that do not bounce.
  S moved[3]{};     ///< In the step: m, rad.
  S pushed[3]{};    ///< Velocity that forces give in a substep: m/s, rad/s.
  S perSecond{};    ///< Substeps.
  S mass{};         ///< kg; 0 of what contacts leave as it is.
  S momentPerMass{};
};

/// A contact point that gives back what it took. Impulses are u: see BlockAxis.
template <Scalar S>
struct BouncePoint {
  std::uint32_t bodyA = 0, bodyB = 0;
  Vector<S> normal{};
  S shareA{};
  /// r x n and r x t.
  S armA{}, armB{}, tangentArmA{}, tangentArmB{};
  S spinA{}, spinB{};
  /// Impulses of the contact in the step, the part that it did not hold before, and the speed of the surface
  /// along the tangent.
  S pressed{}, rubbed{}, taken{}, surface{};
  S elasticity{};
  /// Impulse that was given back.
  S rebound{};
  /// Block and point it is from.
  std::uint32_t block = 0;
  std::uint8_t lane = 0, index = 0;
};

/// Restitution by Poisson's hypothesis: a contact gives back the part `elasticity` of the impulse that it
/// took, all contacts at once, so that neither their order nor how many hold a body matters. What they took
/// is first solved to its end, for the passes of a step come only near it. Where that were more than this
/// part, squared, of the energy that the step has taken from bodies that bounce together, all of these give
/// back less: energy never grows. Sources: C. Glocker and F. Pfeiffer, "Multiple impacts with friction in
/// rigid multibody systems" (1995).
template <Scalar S>
class Restitution {
 public:
  std::vector<BounceBody<S>> bodies;
  std::vector<BouncePoint<S>> points;

  void clear(std::size_t bodyCount) {
    bodies.assign(bodyCount, {});
    points.clear();
  }
  /// Changes the velocities of bodies and sets the rebounds to what was given.
  void solve();

 private:
  struct Change {
    S velocity[3]{};
  };
  /// The energy of bodies that bounce together, J: what the step took, and what giving all back gives, in
  /// proportion to how much is given and to its square.
  struct Balance {
    Scaled<S> taken{}, linear{}, square{};
    S elasticity{};
    S part{};
  };

  void press();
  S pressPoint(BouncePoint<S>& point);
  std::uint32_t groupOf(std::uint32_t body);
  void findGroups();
  void takeBodies();
  void takePoint(const BouncePoint<S>& point);
  static S partOf(const Balance& balance);

  std::vector<std::uint32_t> group_;
  std::vector<Change> changes_;
  std::vector<Balance> balances_;
};

#define SAMESTEP_EACH_SCALAR extern template class Restitution<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
