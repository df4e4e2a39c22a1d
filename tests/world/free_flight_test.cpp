// SPDX-License-Identifier: MIT
// What nothing touches moves in the soft step as under constant forces it does, however many substeps there
// are, and contacts that begin or end give nothing to it.
#include <samestep/space.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

constexpr int kSubsteps[] = {1, 2, 4, 8, 16};
constexpr ContactPrecision kPrecisions[] = {ContactPrecision::accurate, ContactPrecision::fast};

template <Scalar S>
class FreeFlightTest : public ::testing::Test {
 protected:
  static void set(Space<S>& space, int substeps, ContactPrecision precision) {
    space.setSubsteps(substeps);
    space.setPrecision(precision);
    space.setGravity({S(0), S(-10)});
  }
  /// A body that the solver has, since its shapes are within the margin of another's: it flies beside a
  /// kinematic wall that flies with it.
  static ShapeId addBesideAWall(Space<S>& space) {
    space.add(boxShape<S>(space.staticBody(), BB<S>(S(-3), S(-100), ratio<S>(-51, 100), S(100))));
    return addBox<S>(space, {}, S(1), S(1), S(1));
  }
  /// Energy of a body of 1 kg under gravity over y = 0, J.
  static double energyOf(const Body<S>& body, double height) {
    const double x = double(body.velocity().x), y = double(body.velocity().y);
    const double spin = double(body.angularVelocity());
    return (x * x + y * y) / 2 + double(body.moment()) * spin * spin / 2 +
           10 * (double(body.worldCenter().y) - height);
  }
};
TYPED_TEST_SUITE(FreeFlightTest, AllScalars);

TYPED_TEST(FreeFlightTest, ASecondsFallIsFiveMetresWhateverTheSubsteps) {
  using S = TypeParam;
  for (const ContactPrecision precision : kPrecisions) {
    for (const int substeps : kSubsteps) {
      for (const int rate : {60, 64}) {
        Space<S> space;
        TestFixture::set(space, substeps, precision);
        const ShapeId id = addDisc<S>(space, {}, S(1), S(2), {S(3), S(0)});
        for (int i = 0; i < rate; ++i) space.step(ratio<S>(1, rate));
        const Body<S>& body = space.body(bodyOf(space, id));
        EXPECT_NEAR(double(body.position().y), -5, 5e-8) << substeps << " substeps";
        EXPECT_NEAR(double(body.position().x), 3, 5e-8) << substeps << " substeps";
        EXPECT_NEAR(double(body.velocity().y), -10, 1e-7) << substeps << " substeps";
      }
    }
  }
}

TYPED_TEST(FreeFlightTest, SubstepsChangeNotABitOfIt) {
  using S = TypeParam;
  Vector<S> place, velocity;
  S angle{};
  for (const int substeps : kSubsteps) {
    Space<S> space;
    TestFixture::set(space, substeps, ContactPrecision::accurate);
    const ShapeId id = addDisc<S>(space, {ratio<S>(1, 3), S(0)}, S(1), S(2), {S(3), ratio<S>(1, 7)});
    for (int i = 0; i < 100; ++i) {
      Body<S>& body = space.body(bodyOf(space, id));
      body.setForce({ratio<S>(7, 3), S(1)});
      body.setTorque(ratio<S>(5, 3));
      space.step(ratio<S>(1, 60));
    }
    const Body<S>& body = space.body(bodyOf(space, id));
    if (substeps == 1) {
      place = body.position();
      velocity = body.velocity();
      angle = body.angle();
    }
    EXPECT_EQ(body.position(), place) << substeps;
    EXPECT_EQ(body.velocity(), velocity) << substeps;
    EXPECT_EQ(body.angle(), angle) << substeps;
  }
}

TYPED_TEST(FreeFlightTest, ForcesAndTorquesMoveItAsFarAsTheyDo) {
  using S = TypeParam;
  for (const int substeps : kSubsteps) {
    Space<S> space;
    TestFixture::set(space, substeps, ContactPrecision::accurate);
    const ShapeId id = addDisc<S>(space, {}, S(1), S(2));
    const double moment = double(space.body(bodyOf(space, id)).moment());
    for (int i = 0; i < 64; ++i) {
      Body<S>& body = space.body(bodyOf(space, id));
      body.setForce({S(4), S(2)});
      body.setTorque(S(1));
      space.step(kTick<S>);
    }
    const Body<S>& body = space.body(bodyOf(space, id));
    EXPECT_NEAR(double(body.position().x), 1, 5e-8) << substeps;
    EXPECT_NEAR(double(body.position().y), -4.5, 5e-8) << substeps;
    EXPECT_NEAR(double(body.angle()), 0.5 / moment, 5e-8) << substeps;
  }
}

// In the solver's units, which fast precision has few of.
TYPED_TEST(FreeFlightTest, WhatIsNearSomethingFliesAsFar) {
  using S = TypeParam;
  for (const ContactPrecision precision : kPrecisions) {
    for (const int substeps : kSubsteps) {
      Space<S> space;
      TestFixture::set(space, substeps, precision);
      const ShapeId id = TestFixture::addBesideAWall(space);
      for (int i = 0; i < 64; ++i) {
        Body<S>& body = space.body(bodyOf(space, id));
        body.setTorque(i % 2 == 0 ? ratio<S>(1, 1 << 10) : ratio<S>(-1, 1 << 10));
        space.step(kTick<S>);
        ASSERT_EQ(space.state().pairs.size(), 1u);
      }
      const Body<S>& body = space.body(bodyOf(space, id));
      const double rough = FixedNumber<S> && precision == ContactPrecision::fast ? 2e-5 : 1e-7;
      EXPECT_NEAR(double(body.position().y), -5, rough) << substeps << " substeps";
      EXPECT_EQ(body.position().x, S(0));
    }
  }
}

TYPED_TEST(FreeFlightTest, AJumpIsAsHighWhateverTheSubsteps) {
  using S = TypeParam;
  for (const ContactPrecision precision : kPrecisions) {
    for (const int substeps : kSubsteps) {
      Space<S> space;
      TestFixture::set(space, substeps, precision);
      space.add(boxShape<S>(space.staticBody(), BB<S>(S(-5), S(-1), S(5), S(0))));
      const ShapeId id = addBox<S>(space, {S(0), ratio<S>(1, 2)}, S(1), S(1), S(1));
      for (int i = 0; i < 64; ++i) space.step(kTick<S>);
      Body<S>& body = space.body(bodyOf(space, id));
      const double from = double(body.position().y);
      body.setVelocity({S(0), S(6)});
      double highest = 0;
      for (int i = 0; i < 64; ++i) {
        space.step(kTick<S>);
        highest = std::max(highest, double(space.body(bodyOf(space, id)).position().y) - from);
      }
      EXPECT_NEAR(highest, 1.8, 2e-3) << substeps << " substeps";
    }
  }
}

// But for what it is lifted where a step finds it in the floor.
TYPED_TEST(FreeFlightTest, ABouncingBallGainsNothing) {
  using S = TypeParam;
  for (const ContactPrecision precision : kPrecisions) {
    for (const int substeps : kSubsteps) {
      Space<S> space;
      TestFixture::set(space, substeps, precision);
      Shape<S> floor = boxShape<S>(space.staticBody(), BB<S>(S(-5), S(-1), S(5), S(0)));
      floor.setElasticity(S(1));
      space.add(floor);
      const S radius = ratio<S>(1, 4);
      const ShapeId id = addDisc<S>(space, {S(0), S(2)}, radius, S(1));
      space.change(id, [](Shape<S>& shape) { shape.setElasticity(S(1)); });
      const Body<S>& body = space.body(bodyOf(space, id));
      double energy = TestFixture::energyOf(body, double(radius));
      for (int i = 0; i < 64 * 20; ++i) {
        const double before = energy, overlap = std::max(double(radius - body.position().y), 0.0);
        space.step(kTick<S>);
        energy = TestFixture::energyOf(body, double(radius));
        const double lifted = std::max(overlap - std::max(double(radius - body.position().y), 0.0), 0.0);
        EXPECT_LE(energy, before + 10 * lifted + 1e-4) << substeps << " substeps, step " << i;
      }
    }
  }
}

// Lifted off by little, turned a little, and dropped: at no moment is there more than what it had.
TYPED_TEST(FreeFlightTest, ABoxThatLeavesTheFloorAndLandsGainsNothing) {
  using S = TypeParam;
  for (const ContactPrecision precision : kPrecisions) {
    for (const int substeps : kSubsteps) {
      for (const int speed : {1, 5, 20, 100}) {
        for (const int spin : {0, 1}) {
          Space<S> space;
          TestFixture::set(space, substeps, precision);
          space.add(boxShape<S>(space.staticBody(), BB<S>(S(-5), S(-1), S(5), S(0))));
          const ShapeId id = addBox<S>(space, {S(0), ratio<S>(1, 2)}, S(1), S(1), S(1));
          for (int i = 0; i < 32; ++i) space.step(kTick<S>);
          Body<S>& body = space.body(bodyOf(space, id));
          body.setVelocity({S(0), ratio<S>(speed, 100)});
          body.setAngularVelocity(S(spin) * ratio<S>(speed, 400));
          const double start = TestFixture::energyOf(body, 0.5);
          for (int i = 0; i < 128; ++i) {
            space.step(kTick<S>);
            const double energy = TestFixture::energyOf(space.body(bodyOf(space, id)), 0.5);
            EXPECT_LE(energy, start + 2e-3) << substeps << " substeps, " << speed << " cm/s, step " << i;
          }
          EXPECT_NEAR(double(space.body(bodyOf(space, id)).position().y), 0.5, 1e-3);
          EXPECT_NEAR(double(space.body(bodyOf(space, id)).velocity().y), 0, 2e-3);
        }
      }
    }
  }
}

TYPED_TEST(FreeFlightTest, SequentialImpulsesFallAsTheSpecificationHasIt) {
  using S = TypeParam;
  Space<S> space;
  space.setSolver(SolverKind::sequentialImpulses);
  space.setGravity({S(0), S(-10)});
  const ShapeId id = addDisc<S>(space, {}, S(1), S(1));
  for (int i = 0; i < 60; ++i) space.step(ratio<S>(1, 60));
  EXPECT_NEAR(double(space.body(bodyOf(space, id)).position().y), -5 + 10.0 / 2 / 60, 1e-6);
}

}  // namespace
}  // namespace samestep
