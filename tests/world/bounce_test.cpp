// SPDX-License-Identifier: MIT
// What bounces leaves as it came, however many points and pairs hold it.
#include <samestep/space.h>

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <class S>
class BounceTest : public ::testing::Test {
 protected:
  struct Way {
    SolverKind solver;
    ContactPrecision precision;
  };
  static constexpr Way kWays[] = {{SolverKind::softStep, ContactPrecision::accurate},
                                  {SolverKind::softStep, ContactPrecision::fast},
                                  {SolverKind::sequentialImpulses, ContactPrecision::accurate}};
  static void set(Space<S>& space, const Way& way) {
    space.setSolver(way.solver);
    space.setPrecision(way.precision);
  }

  static void addFloor(Space<S>& space, S from, S to) {
    Shape<S> floor = boxShape<S>(space.add(Body<S>::fixedInPlace()), BB<S>{from, S(-1), to, S(0)});
    floor.setElasticity(S(1));
    floor.setFriction(S(1));
    space.add(floor);
  }
  static BodyId addElastic(Space<S>& space, const Vector<S>& at, const Vector<S>& velocity, S elasticity,
                           S mass = S(1), S friction = S(0), S height = S(1)) {
    const ShapeId box = addBox<S>(space, at, S(1), height, mass, velocity);
    space.change(box, [&](Shape<S>& shape) {
      shape.setElasticity(elasticity);
      shape.setFriction(friction);
    });
    return bodyOf(space, box);
  }
  /// 14 bodies of all shapes that move anyhow between four walls, without gravity.
  static std::vector<BodyId> addClosedBox(Space<S>& space, S friction) {
    Random random(7);
    const auto dress = [&](Shape<S>& shape) {
      shape.setElasticity(S(1));
      shape.setFriction(friction);
      space.add(shape);
    };
    for (const BB<S>& wall : {BB<S>{S(-8), S(-8), S(8), S(-6)}, BB<S>{S(-8), S(6), S(8), S(8)},
                              BB<S>{S(-8), S(-8), S(-6), S(8)}, BB<S>{S(6), S(-8), S(8), S(8)}}) {
      Shape<S> shape = boxShape<S>(space.add(Body<S>::fixedInPlace()), wall);
      dress(shape);
    }
    std::vector<BodyId> bodies;
    for (int i = 0; i < 14; ++i) {
      Body<S> body;
      body.setPosition({S(i % 4 * 3 - 4), S(i / 4 * 3 - 4)});
      body.setVelocity({random.number<S>(-6, 6), random.number<S>(-6, 6)});
      body.setAngularVelocity(random.number<S>(-3, 3));
      const BodyId id = bodies.emplace_back(space.add(body));
      Shape<S> shape = i % 3 == 0   ? circleShape(id, ratio<S>(1, 2))
                       : i % 3 == 1 ? boxShape(id, S(1), S(2))
                                    : segmentShape(id, {S(-1), S(0)}, {S(1), S(0)}, ratio<S>(1, 4));
      shape.setMass(S(1 + i % 4));
      dress(shape);
    }
    return bodies;
  }
  static void stepFor(Space<S>& space, int steps) {
    for (int i = 0; i < steps; ++i) space.step(kTick<S>);
  }
  static void expectLeaves(const Space<S>& space, BodyId id, double speed, const std::string& what) {
    const Body<S>& body = space.body(id);
    EXPECT_NEAR(static_cast<double>(body.velocity().x), 0, 1e-4) << what;
    EXPECT_NEAR(static_cast<double>(body.velocity().y), speed, 1e-4) << what;
    EXPECT_NEAR(static_cast<double>(body.angularVelocity()), 0, 1e-4) << what;
  }
  static double energyOf(const Space<S>& space, const std::vector<BodyId>& bodies) {
    double sum = 0;
    for (const BodyId id : bodies) {
      const Body<S>& body = space.body(id);
      const auto number = [](S x) { return static_cast<double>(x); };
      const double x = number(body.velocity().x), y = number(body.velocity().y),
                   w = number(body.angularVelocity());
      sum += (number(body.mass()) * (x * x + y * y) + number(body.moment()) * w * w) / 2;
    }
    return sum;
  }
};
TYPED_TEST_SUITE(BounceTest, AllScalarsAndChecked);

TYPED_TEST(BounceTest, ABoxThatFallsFlatLeavesAsFastAsItsElasticitySaysWithoutSpin) {
  using S = TypeParam;
  struct Floor {
    const char* name;
    std::vector<std::pair<S, S>> boxes;
  };
  const Floor floors[] = {{"floor", {{S(-9), S(9)}}},
                          {"seam", {{S(-9), ratio<S>(1, 8)}, {ratio<S>(1, 8), S(9)}}},
                          {"narrow", {{ratio<S>(-1, 8), ratio<S>(3, 16)}}},
                          {"legs", {{ratio<S>(-1, 2), ratio<S>(-3, 8)}, {ratio<S>(1, 4), ratio<S>(3, 8)}}}};
  for (const auto& way : this->kWays) {
    // Where energy does not grow, sequential impulses do as the MIS says, one contact after the other.
    const bool all = way.solver == SolverKind::softStep;
    for (const Floor& floor : floors) {
      for (const S elasticity : {S(1), ratio<S>(1, 2), ratio<S>(1, 4)}) {
        for (const S friction : {S(0), ratio<S>(1, 4), S(1)}) {
          for (const S height : {S(1), S(3)}) {
            if (!all && (elasticity != S(1) || friction != S(0))) continue;
            Space<S> space;
            this->set(space, way);
            for (const auto& [from, to] : floor.boxes) this->addFloor(space, from, to);
            const Vector<S> at(S(0), (S(1) + height) * ratio<S>(1, 2));
            const BodyId box = this->addElastic(space, at, {S(0), S(-6)}, elasticity, S(1), friction, height);
            this->stepFor(space, 40);
            this->expectLeaves(space, box, 6 * static_cast<double>(elasticity), floor.name);
          }
        }
      }
    }
  }
}

TYPED_TEST(BounceTest, EnergyNeverGrowsAmongManyElasticBodiesInAClosedBox) {
  using S = TypeParam;
  for (const auto& way : this->kWays) {
    for (const S friction : {S(0), ratio<S>(1, 2)}) {
      Space<S> space;
      this->set(space, way);
      const std::vector<BodyId> bodies = this->addClosedBox(space, friction);
      const double before = this->energyOf(space, bodies);
      double most = 0;
      for (int i = 0; i < 320; ++i) {
        space.step(kTick<S>);
        most = std::max(most, this->energyOf(space, bodies));
      }
      EXPECT_LE(most, before * 1.0001);
      EXPECT_GE(this->energyOf(space, bodies), friction == S(0) ? before * 0.9 : before * 0.01);
    }
  }
}

TYPED_TEST(BounceTest, ABoxThatBouncesOnAFloorComesBackNoHigherAndHardlyLower) {
  using S = TypeParam;
  for (const auto& way : this->kWays) {
    Space<S> space;
    this->set(space, way);
    space.setGravity({S(0), S(-10)});
    this->addFloor(space, S(-9), S(9));
    const BodyId box = this->addElastic(space, {S(0), S(2)}, {}, S(1));
    S highest = S(0);
    for (int i = 0; i < 600; ++i) {
      space.step(kTick<S>);
      if (space.body(box).velocity().y > S(0)) highest = max(highest, space.body(box).position().y);
    }
    // Sequential impulses push an overlap apart, which lifts the box beside what the blow gives back.
    EXPECT_LT(static_cast<double>(highest), way.solver == SolverKind::softStep ? 2.0 : 2.05);
    EXPECT_GT(static_cast<double>(highest), 1.8);
  }
}

TYPED_TEST(BounceTest, ElasticBoxesInAStackLeaveTogether) {
  using S = TypeParam;
  for (const auto& way : this->kWays) {
    for (const S upper : {S(1), S(16)}) {
      Space<S> space;
      this->set(space, way);
      this->addFloor(space, S(-9), S(9));
      const BodyId low = this->addElastic(space, {S(0), S(1)}, {S(0), S(-6)}, S(1));
      const BodyId high = this->addElastic(space, {S(0), S(2)}, {S(0), S(-6)}, S(1), upper);
      const double before = this->energyOf(space, {low, high});
      this->stepFor(space, 40);
      EXPECT_LE(this->energyOf(space, {low, high}), before * 1.0001);
      // One contact after the other loses energy where two bodies strike together.
      if (way.solver == SolverKind::softStep) {
        EXPECT_GE(this->energyOf(space, {low, high}), before * 0.99);
      }
    }
  }
}

TYPED_TEST(BounceTest, ARowOfElasticBallsKeepsMomentumAndEnergy) {
  using S = TypeParam;
  for (const auto& way : this->kWays) {
    for (const S gap : {S(1), ratio<S>(17, 16)}) {
      Space<S> space;
      this->set(space, way);
      std::vector<BodyId> balls;
      double before = 0;
      for (int i = 0; i < 6; ++i) {
        const Vector<S> at(i == 5 ? S(-3) : S(i) * gap, S(0));
        const ShapeId ball =
            addDisc<S>(space, at, ratio<S>(1, 2), S(1), i == 5 ? Vector<S>(S(6), S(0)) : Vector<S>());
        space.change(ball, [](Shape<S>& shape) { shape.setElasticity(S(1)); });
        balls.push_back(bodyOf(space, ball));
        before = this->energyOf(space, balls);
      }
      this->stepFor(space, 120);
      double momentum = 0;
      for (const BodyId id : balls) momentum += static_cast<double>(space.body(id).velocity().x);
      EXPECT_NEAR(momentum, 6, 1e-3);
      EXPECT_LE(this->energyOf(space, balls), before * 1.0001);
      EXPECT_GE(this->energyOf(space, balls), before * 0.99);
    }
  }
}

TYPED_TEST(BounceTest, ABallThatAMovingPlateStrikesLeavesTwiceAsFast) {
  using S = TypeParam;
  Space<S> space;
  Body<S> plate = Body<S>::kinematic();
  plate.setVelocity({S(0), S(5)});
  Shape<S> shape = boxShape<S>(space.add(plate), S(8), S(1));
  shape.setElasticity(S(1));
  space.add(shape);
  const ShapeId ball = addDisc<S>(space, {S(0), S(2)}, ratio<S>(1, 2), S(1));
  space.change(ball, [](Shape<S>& of) { of.setElasticity(S(1)); });
  this->stepFor(space, 40);
  EXPECT_NEAR(static_cast<double>(space.body(bodyOf(space, ball)).velocity().y), 10, 1e-3);
}

TYPED_TEST(BounceTest, WhatStrikesSlowerThanTheThresholdDoesNotBounce) {
  using S = TypeParam;
  Space<S> space;
  this->addFloor(space, S(-9), S(9));
  const BodyId box = this->addElastic(space, {S(0), ratio<S>(5, 8)}, {S(0), ratio<S>(-7, 8)}, S(1));
  this->stepFor(space, 40);
  this->expectLeaves(space, box, 0, "slow");
}

}  // namespace
}  // namespace samestep
