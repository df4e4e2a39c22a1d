// SPDX-License-Identifier: MIT
#include "solver/restitution/restitution.h"

#include <tuple>

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class RestitutionTest : public ::testing::Test {
 protected:
  double energy() const {
    double sum = 0;
    for (const BounceBody<S>& body : restitution_.bodies) {
      const auto number = [](S x) { return static_cast<double>(x); };
      const double x = number(body.velocity[0]), y = number(body.velocity[1]), w = number(body.velocity[2]);
      const double perMoment = number(body.momentPerMass);
      sum += number(body.mass) * (x * x + y * y + (perMoment == 0 ? 0 : w * w / perMoment)) / 2;
    }
    return sum;
  }
  /// Bodies that move anyhow, the first of them a wall, at points anywhere that have taken nothing yet.
  void scatter(Random& random) {
    const int bodies = random.between(2, 6);
    restitution_.clear(static_cast<std::size_t>(bodies));
    for (int i = 0; i < bodies; ++i) {
      BounceBody<S>& body = restitution_.bodies[static_cast<std::size_t>(i)];
      if (i == 0) continue;
      body.mass = random.number<S>(0, 7) + ratio<S>(1, 4);
      body.momentPerMass = random.oneIn(4) ? S(0) : random.number<S>(0, 15) + ratio<S>(1, 2);
      for (S& speed : body.velocity) speed = random.number<S>(-7, 7);
      if (body.momentPerMass == S(0)) body.velocity[2] = S(0);
      for (int k = 0; k < 3; ++k) body.before[k] = body.velocity[k];
    }
    const int points = random.between(1, 10);
    for (int i = 0; i < points; ++i) {
      BouncePoint<S>& point = restitution_.points.emplace_back();
      point.bodyB = 1 + random.below(static_cast<std::uint32_t>(bodies - 1));
      point.bodyA = random.below(point.bodyB);
      const BounceBody<S>&a = restitution_.bodies[point.bodyA], &b = restitution_.bodies[point.bodyB];
      point.normal = forAngle(random.number<S>(-3, 3));
      point.shareA = a.mass == S(0) ? S(0) : b.mass / (a.mass + b.mass);
      point.armA = a.mass == S(0) ? S(0) : random.number<S>(-1, 1);
      point.armB = random.number<S>(-1, 1);
      point.spinA = a.momentPerMass * point.armA * point.shareA;
      point.spinB = b.momentPerMass * point.armB * (S(1) - point.shareA);
      point.tangentArmA = a.mass == S(0) ? S(0) : random.number<S>(-1, 1);
      point.tangentArmB = random.number<S>(-1, 1);
      point.tangentSpinA = a.momentPerMass * point.tangentArmA * point.shareA;
      point.tangentSpinB = b.momentPerMass * point.tangentArmB * (S(1) - point.shareA);
      point.friction = random.oneIn(2) ? S(0) : random.number<S>(0, 1);
      point.pair = static_cast<std::uint32_t>(i);
      point.elasticity = random.oneIn(3) ? S(1) : random.number<S>(0, 1);
      if (point.elasticity < S(0)) point.elasticity = -point.elasticity;
    }
  }

  Restitution<S> restitution_;
};
TYPED_TEST_SUITE(RestitutionTest, AllScalarsAndChecked);

TYPED_TEST(RestitutionTest, EnergyNeverGrowsWithAnyNumberOfPointsOfAnyElasticity) {
  int bounced = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Random random(seed);
    this->scatter(random);
    const double before = this->energy();
    this->restitution_.markBouncing();
    this->restitution_.solve();
    EXPECT_LE(this->energy(), before * (1 + 0x1p-20)) << "seed " << seed;
    for (const auto& point : this->restitution_.points) bounced += point.rebound > TypeParam(0) ? 1 : 0;
  }
  EXPECT_GT(bounced, 3000);
}

// Two points of a wide body against a wall, in both orders: it leaves as fast as it came and does not turn.
TYPED_TEST(RestitutionTest, TheOrderOfPointsMakesNoDifferenceToABodyThatLiesOnThem) {
  using S = TypeParam;
  for (const auto& [turned, together, friction] : {std::tuple(false, true, S(0)),
                                                   {true, true, S(0)},
                                                   {false, true, S(1)},
                                                   {true, true, S(1)},
                                                   {false, false, S(0)},
                                                   {true, false, S(0)}}) {
    Restitution<S>& restitution = this->restitution_;
    restitution.clear(2);
    BounceBody<S>& body = restitution.bodies[1];
    body.mass = S(3);
    body.momentPerMass = S(6);
    body.before[1] = body.velocity[1] = S(-6);
    for (const bool left : {turned, !turned}) {
      BouncePoint<S>& point = restitution.points.emplace_back();
      point.bodyB = 1;
      point.normal = {S(0), S(1)};
      point.armB = left ? ratio<S>(-1, 8) : ratio<S>(1, 2);
      point.spinB = S(6) * point.armB;
      point.tangentArmB = ratio<S>(3, 2);
      point.tangentSpinB = S(6) * point.tangentArmB;
      point.friction = friction;
      point.pair = together ? 0 : static_cast<std::uint32_t>(restitution.points.size());
      point.elasticity = S(1);
    }
    restitution.markBouncing();
    restitution.solve();
    EXPECT_NEAR(static_cast<double>(body.velocity[1]), 6, 1e-6);
    EXPECT_NEAR(static_cast<double>(body.velocity[2]), 0, 1e-6);
  }
}

}  // namespace
}  // namespace samestep
