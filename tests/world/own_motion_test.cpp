// SPDX-License-Identifier: MIT
// How a body moves by itself: its factor of gravity, its damping, its limits, whether it turns.
#include <samestep/space.h>

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <class S>
class OwnMotionTest : public ::testing::Test {
 protected:
  static constexpr SolverKind kSolvers[] = {SolverKind::softStep, SolverKind::sequentialImpulses};

  static void set(Space<S>& space, SolverKind solver, S gravity) {
    space.setSolver(solver);
    space.setGravity({S(0), gravity});
  }
  static void stepFor(Space<S>& space, int steps) {
    for (int i = 0; i < steps; ++i) space.step(kTick<S>);
  }
  /// A box that slides on a floor without friction, so that the solver has it, or flies.
  static BodyId addSlider(Space<S>& space, bool onFloor) {
    if (onFloor) addWall<S>(space, {S(-50), S(0)}, {S(50), S(0)});
    return bodyOf(space, addBox<S>(space, {S(0), ratio<S>(1, 2)}, S(1), S(1), S(1), {S(8), S(0)}));
  }
};
TYPED_TEST_SUITE(OwnMotionTest, AllScalarsAndChecked);

TYPED_TEST(OwnMotionTest, ABodyFallsByItsFactorOfGravity) {
  using S = TypeParam;
  for (const SolverKind solver : this->kSolvers) {
    for (const S scale : {S(2), S(0), S(-1), ratio<S>(1, 2)}) {
      Space<S> own, whole;
      for (Space<S>* space : {&own, &whole}) space->setSolver(solver);
      own.setGravity({S(0), S(-8)});
      whole.setGravity({S(0), S(-8) * scale});
      const BodyId a = bodyOf(own, addDisc<S>(own, {}, S(1), S(2)));
      const BodyId b = bodyOf(whole, addDisc<S>(whole, {}, S(1), S(2)));
      own.body(a).setGravityScale(scale);
      this->stepFor(own, 64);
      this->stepFor(whole, 64);
      EXPECT_EQ(own.body(a).velocity(), whole.body(b).velocity());
      EXPECT_EQ(own.body(a).position(), whole.body(b).position());
    }
  }
}

TYPED_TEST(OwnMotionTest, DampingDividesWhatABodyHadInFlightAndInContact) {
  using S = TypeParam;
  for (const SolverKind solver : this->kSolvers) {
    for (const bool onFloor : {false, true}) {
      Space<S> space;
      this->set(space, solver, onFloor ? S(-8) : S(0));
      const BodyId id = this->addSlider(space, onFloor);
      space.body(id).setLinearDamping(S(64));
      this->stepFor(space, 1);
      EXPECT_NEAR(static_cast<double>(space.body(id).velocity().x), 4, 1e-6);
      this->stepFor(space, 1);
      EXPECT_NEAR(static_cast<double>(space.body(id).velocity().x), 2, 1e-6);
    }
    Space<S> space;
    this->set(space, solver, S(0));
    const BodyId id = this->addSlider(space, false);
    space.body(id).setAngularVelocity(S(6));
    space.body(id).setAngularDamping(S(128));
    this->stepFor(space, 1);
    EXPECT_NEAR(static_cast<double>(space.body(id).angularVelocity()), 2, 1e-6);
    EXPECT_NEAR(static_cast<double>(space.body(id).velocity().x), 8, 1e-6);
  }
}

TYPED_TEST(OwnMotionTest, NoStepLeavesABodyFasterThanItsLimits) {
  using S = TypeParam;
  for (const SolverKind solver : this->kSolvers) {
    Space<S> space;
    this->set(space, solver, S(-8));
    const BodyId id = this->addSlider(space, false);
    space.body(id).setSpeedLimit(S(5));
    space.body(id).setSpinLimit(S(3));
    for (int i = 0; i < 64; ++i) {
      space.body(id).setTorque(S(4));
      space.step(kTick<S>);
      EXPECT_LE(static_cast<double>(length(space.body(id).velocity())), 5 + 1e-6);
      EXPECT_LE(static_cast<double>(space.body(id).angularVelocity()), 3);
    }
    EXPECT_NEAR(static_cast<double>(length(space.body(id).velocity())), 5, 1e-6);
    EXPECT_EQ(space.body(id).angularVelocity(), S(3));
  }
}

TYPED_TEST(OwnMotionTest, AnImpulseLeavesABodyWithinItsLimits) {
  using S = TypeParam;
  Body<S> body{S(1), S(1)};
  body.setSpeedLimit(S(5));
  body.applyImpulse({S(30), S(40)}, body.worldCenter());
  EXPECT_NEAR(static_cast<double>(body.velocity().x), 3, 1e-6);
  EXPECT_NEAR(static_cast<double>(body.velocity().y), 4, 1e-6);
}

TYPED_TEST(OwnMotionTest, WhatDoesNotRotateIsNotTurnedUntilItDoes) {
  using S = TypeParam;
  for (const SolverKind solver : this->kSolvers) {
    Space<S> space;
    this->set(space, solver, S(0));
    const BodyId id = this->addSlider(space, false);
    Body<S>& body = space.body(id);
    body.setRotates(false);
    body.setTorque(S(4));
    this->stepFor(space, 1);
    EXPECT_EQ(space.body(id).angularVelocity(), S(0));
    space.body(id).setRotates(true);
    space.body(id).setTorque(S(4));
    this->stepFor(space, 1);
    EXPECT_GT(space.body(id).angularVelocity(), S(0));
  }
}

// A disc rolls on without end. With a resistance of c the torque m g c r slows it by c g / (1 + 1/2): it
// comes to rest after v^2 / (2 a).
TYPED_TEST(OwnMotionTest, ADiscRollsAsFarAsItsRollingResistanceSays) {
  using S = TypeParam;
  for (const SolverKind solver : this->kSolvers) {
    for (const bool resists : {false, true}) {
      Space<S> space;
      this->set(space, solver, S(-8));
      const ShapeId floor = addWall<S>(space, {S(-50), S(0)}, {S(50), S(0)});
      const ShapeId disc = addDisc<S>(space, {S(0), ratio<S>(1, 2)}, ratio<S>(1, 2), S(1), {S(2), S(0)});
      space.body(bodyOf(space, disc)).setAngularVelocity(S(-4));
      space.change(floor, [](Shape<S>& shape) { shape.setFriction(S(1)); });
      space.change(disc, [&](Shape<S>& shape) {
        shape.setFriction(S(1));
        if (resists) shape.setRollingResistance(ratio<S>(1, 8));
      });
      this->stepFor(space, 64 * 5);
      const Body<S>& body = space.body(bodyOf(space, disc));
      if (resists) {
        EXPECT_NEAR(static_cast<double>(body.position().x), 3.0, 0.2);
        EXPECT_NEAR(static_cast<double>(body.velocity().x), 0, 1e-2);
      } else {
        EXPECT_NEAR(static_cast<double>(body.position().x), 10, 0.1);
      }
    }
  }
}

TYPED_TEST(OwnMotionTest, WhatIsOutOfRangeIsRefusedByNameAndValue) {
  using S = TypeParam;
  Body<S> body{S(1), S(1)};
  const auto said = [&](auto&& set) {
    try {
      set();
    } catch (const IllegalBody& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(said([&] { body.setGravityScale(S(2000)); }), HasSubstr("setGravityScale: scale is 2000"));
  EXPECT_THAT(said([&] { body.setLinearDamping(S(-1)); }), HasSubstr("setLinearDamping: damping is -1"));
  EXPECT_THAT(said([&] { body.setAngularDamping(S(2000)); }),
              HasSubstr("setAngularDamping: damping is 2000"));
  EXPECT_THAT(said([&] { body.setSpeedLimit(S(2000)); }), HasSubstr("setSpeedLimit: limit is 2000"));
  EXPECT_THAT(said([&] { body.setSpinLimit(S(-1)); }), HasSubstr("setSpinLimit: limit is -1"));
  Shape<S> disc = circleShape(BodyId{1, 1}, S(1));
  EXPECT_THROW(disc.setRollingResistance(S(-1)), ValueOutOfRange);
  EXPECT_EQ(disc.rollingResistance(), S(0));
  EXPECT_EQ(body.gravityScale(), S(1));
  EXPECT_EQ(body.speedLimit(), kMaxSpeed<S>);
}

}  // namespace
}  // namespace samestep
