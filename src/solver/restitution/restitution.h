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
  S moved[3]{};     ///< Motion in the step: m, rad.
  S pushed[3]{};    ///< Velocity that forces give in a substep: m/s, rad/s.
  S perSecond{};    ///< Substeps.
  S mass{};         ///< kg; 0 of what contacts leave as it is.
  S momentPerMass{};
  bool bounces = false;  ///< Moves, and has a point that bounces.
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
  /// Spins along the tangent.
  S tangentSpinA{}, tangentSpinB{};
  S friction{};
  /// Impulses of the contact in the step, the part that it did not hold before, and the speed of the surface
  /// along the tangent.
  S pressed{}, rubbed{}, taken{}, surface{};
  S elasticity{};
  /// Impulse that was given back.
  S rebound{};
  /// The pair it is of, whose points follow each other.
  std::uint32_t pair = 0;
  /// Block and point it is from.
  std::uint32_t block = 0;
  std::uint8_t lane = 0, index = 0;
};

/// Restitution by Poisson's hypothesis: a contact gives back the part `elasticity` of the impulse that it
/// took, all contacts at once, so that neither their order nor how many hold a body matters. What they took
/// is first solved to its end, for the passes of a step come only near it. Where that were more than this
/// part, squared, of the energy that the step has taken from bodies that bounce together, all of these give
/// back less: energy never grows. What they gave others is not taken. Sources: C. Glocker and F. Pfeiffer,
/// "Multiple impacts with friction in rigid multibody systems" (1995).
template <Scalar S>
class Restitution {
 public:
  std::vector<BounceBody<S>> bodies;
  std::vector<BouncePoint<S>> points;
  /// Points that do not bounce, of bodies that do: through them energy goes to others and comes from them.
  std::vector<BouncePoint<S>> others;

  void clear(std::size_t bodyCount) {
    bodies.assign(bodyCount, {});
    points.clear();
    others.clear();
  }
  /// Marks the bodies of the points, before others are looked for.
  void markBouncing() {
    for (const BouncePoint<S>& point : points) {
      for (const std::uint32_t body : {point.bodyA, point.bodyB})
        bodies[body].bounces = bodies[body].mass != S(0);
    }
  }
  bool bounces(std::uint32_t body) const { return bodies[body].bounces; }
  /// True if the next point is this one, which is then passed.
  bool passPoint(std::uint32_t block, int lane, int index, std::size_t& next) const {
    if (next == points.size()) return false;
    const BouncePoint<S>& point = points[next];
    const bool is = point.block == block && point.lane == lane && point.index == index;
    next += is ? 1 : 0;
    return is;
  }
  /// Number of passes over so many points at the most: many are solved less often, since the balance holds
  /// for what has not come to its end, too.
  static std::size_t passes(std::size_t points) {
    constexpr std::size_t kMost = 100, kFewest = 10, kMostSolved = 6400;
    return max(min(kMostSolved / max(points, std::size_t{1}), kMost), kFewest);
  }
  /// Changes the velocities of bodies, which are marked, and sets the rebounds to what was given.
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
  void rub();
  S take(BouncePoint<S>& point, S u);
  S pressPoint(BouncePoint<S>& point);
  S pressPair(BouncePoint<S>& first, BouncePoint<S>& second);
  S rubPoint(BouncePoint<S>& point);
  void push(const BouncePoint<S>& point, const Vector<S>& axis, S spinA, S spinB, S u);
  std::uint32_t groupOf(std::uint32_t body);
  void findGroups();
  void takeBodies();
  Scaled<S> massOf(const BouncePoint<S>& point) const;
  Scaled<S> workThrough(const BouncePoint<S>& point, bool movesA, bool movesB) const;
  void takePoint(const BouncePoint<S>& point);
  void takeOther(const BouncePoint<S>& point);
  static S partOf(const Balance& balance);

  std::vector<std::uint32_t> group_;
  std::vector<Change> changes_;
  std::vector<Balance> balances_;
};

#define SAMESTEP_EACH_SCALAR extern template class Restitution<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
