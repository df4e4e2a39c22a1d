// SPDX-License-Identifier: MIT
#include "study/chart_track.h"

#include <gtest/gtest.h>

#include <samestep/scene.h>
#include "study/method.h"
#include "support/scalars.h"

namespace samestep {
namespace {

Spot spot(std::uint32_t index, double x, double y) { return {{index, 1}, x, y}; }

TEST(TrackTest, DistanceIsTheRootMeanSquareOverBodiesThatBothHave) {
  const Spots a{spot(1, 0, 0), spot(3, 1, 1), spot(4, 0, 0), spot(6, 5, 5)};
  const Spots b{spot(0, 9, 9), spot(3, 4, 5), spot(4, 0, 0), spot(7, 5, 5)};

  EXPECT_DOUBLE_EQ(distanceBetween(a, b) * distanceBetween(a, b), 25.0 / 2);
  EXPECT_EQ(distanceBetween(a, Spots{}), 0);
}

TEST(TrackTest, ALaterBodyInTheSameSlotIsAnother) {
  EXPECT_EQ(distanceBetween(Spots{{{1, 1}, 0, 0}}, Spots{{{1, 3}, 2, 0}}), 0);
}

TEST(TrackTest, DistanceOfTracksIsOverTheStepsThatBothHave) {
  const Track a{{spot(1, 0, 0)}, {spot(1, 2, 0)}, {spot(1, 99, 0)}};
  const Track b{{spot(1, 0, 0)}, {spot(1, 0, 0)}};

  EXPECT_DOUBLE_EQ(distanceBetween(a, b) * distanceBetween(a, b), 2);
}

/// A body as exact answers start from it.
StartWorld::Moving moving(double y) { return {spot(1, 3, y), 1, 0, 0, 0.5, 0, 0}; }

TEST(ExactAnswerTest, OnlySomeScenesHaveOne) {
  EXPECT_NE(exactAnswerOf("incline"), nullptr);
  EXPECT_NE(exactAnswerOf("bounce"), nullptr);
  EXPECT_NE(exactAnswerOf("pyramid40"), nullptr);
  EXPECT_NE(exactAnswerOf("pyramid:12"), nullptr);
  EXPECT_EQ(exactAnswerOf("soup"), nullptr);
}

// The ball falls from 5 m: down in 1 s, with 10 m/s; up again with 5 m/s to 1.25 m, down after 1 s.
TEST(ExactAnswerTest, BallFallsAndBouncesWithItsElasticity) {
  StartWorld start;
  start.gravityY = -10;
  start.floor = 1;
  start.bodies = {moving(6.5)};
  start.bodies[0].elasticity = 0.5;
  const auto height = [&](double time) { return exactAnswerOf("bounce")->after(start, time)[0].y - 1.5; };

  EXPECT_DOUBLE_EQ(height(0), 5);
  EXPECT_DOUBLE_EQ(height(0.5), 3.75);
  EXPECT_NEAR(height(1), 0, 1e-12);
  EXPECT_DOUBLE_EQ(height(1.5), 1.25);
  EXPECT_NEAR(height(2), 0, 1e-12);
  EXPECT_DOUBLE_EQ(height(2.25), 0.3125);
  // All its bounces are over after 3 s.
  EXPECT_EQ(height(3.1), 0);
  start.bodies[0].elasticity = 0;
  EXPECT_EQ(height(1.5), 0);
}

// A slope of 3 : 4 downwards to the left: 6 m/s^2 along it, 8 into it.
TEST(ExactAnswerTest, BlockSlidesByGravityLessFrictionOrStays) {
  StartWorld start;
  start.gravityY = -10;
  start.bodies = {moving(0)};
  start.bodies[0].cosine = 0.8;
  start.bodies[0].sine = 0.6;
  const auto path = [&](double friction) {
    start.bodies[0].friction = friction;
    const Spot at = exactAnswerOf("incline")->after(start, 2)[0];
    EXPECT_NEAR((at.x - 3) * 0.6, at.y * 0.8, 1e-12);
    return (3 - at.x) / 0.8;
  };

  EXPECT_DOUBLE_EQ(path(0), 12);
  EXPECT_DOUBLE_EQ(path(0.5), 4);
  EXPECT_NEAR(path(0.75), 0, 1e-12);
  EXPECT_NEAR(path(0.9), 0, 1e-12);
}

// The ball is thrown at 3 and 4 m/s: after 2 s 6 m on, 8 - 20 up.
TEST(ExactAnswerTest, WhatTouchesNothingFliesAParabola) {
  StartWorld start;
  start.gravityY = -10;
  start.bodies = {moving(5)};
  start.bodies[0].velocityX = 3;
  start.bodies[0].velocityY = 4;
  const Spot at = exactAnswerOf("projectile")->after(start, 2)[0];

  EXPECT_DOUBLE_EQ(at.x, 9);
  EXPECT_DOUBLE_EQ(at.y, -7);
}

TEST(ExactAnswerTest, FrictionStopsABoxOrBringsItToTheSpeedOfTheBelt) {
  StartWorld start;
  start.gravityY = -10;
  start.bodies = {moving(0)};
  start.bodies[0].velocityX = 10;
  start.bodies[0].friction = 0.5;
  const auto path = [&](double time) { return exactAnswerOf("slide")->after(start, time)[0].x - 3; };

  EXPECT_DOUBLE_EQ(path(1), 7.5);
  EXPECT_DOUBLE_EQ(path(2), 10);
  EXPECT_DOUBLE_EQ(path(9), 10);
  start.belt = 20;
  EXPECT_DOUBLE_EQ(path(2), 30);
  EXPECT_DOUBLE_EQ(path(3), 50);
  start.bodies[0].friction = 0;
  EXPECT_DOUBLE_EQ(path(2), 20);
}

// A slope of 3 : 4 as above: 4 m/s^2 along it.
TEST(ExactAnswerTest, ABallRollsWithTwoThirdsOfWhatABlockWouldHave) {
  StartWorld start;
  start.gravityY = -10;
  start.bodies = {moving(0)};
  start.bodies[0].cosine = 0.8;
  start.bodies[0].sine = 0.6;
  const Spot at = exactAnswerOf("roll")->after(start, 2)[0];

  EXPECT_DOUBLE_EQ((3 - at.x) / 0.8, 8);
  EXPECT_DOUBLE_EQ(at.y / -0.6, 8);
}

// The second of equal masses goes on with the speed of the first; of a heavy first one both go on.
TEST(ExactAnswerTest, BallsThatMeetExchangeTheirSpeeds) {
  StartWorld start;
  start.bodies = {moving(0), moving(0)};
  start.bodies[1].spot.x = 6;
  start.bodies[0].velocityX = 2;
  start.bodies[0].elasticity = 1;
  const auto after = [&](double time) { return exactAnswerOf("impact")->after(start, time); };

  EXPECT_DOUBLE_EQ(after(1)[0].x, 5);
  EXPECT_DOUBLE_EQ(after(1)[1].x, 6);
  EXPECT_DOUBLE_EQ(after(3)[0].x, 5);
  EXPECT_DOUBLE_EQ(after(3)[1].x, 10);
  start.bodies[0].elasticity = 0;
  EXPECT_DOUBLE_EQ(after(3)[0].x, 7);
  EXPECT_DOUBLE_EQ(after(3)[1].x, 8);
}

template <class S>
class ExactSceneTest : public ::testing::Test {};
TYPED_TEST_SUITE(ExactSceneTest, AllScalars);

/// Distance of bodies from the exact answer at its last step.
template <Scalar S>
double distanceAtEnd(const char* name, std::uint64_t steps, SolverKind solver, std::size_t bodies) {
  Scene<S> scene(SceneSource::find(name));
  scene.space().setSolver(solver);
  const StartWorld start = startOf(scene.space());
  while (scene.tick() < steps) scene.step();
  const double time = static_cast<double>(scene.timeStep()) * static_cast<double>(steps);
  const Spots exact = exactAnswerOf(name)->after(start, time);
  EXPECT_EQ(exact.size(), bodies);
  return distanceBetween(exact, spotsOf(scene.space()));
}

// The bounds are what a step's length is worth: bodies move up to 0.17 m in one.
TYPED_TEST(ExactSceneTest, TheEngineComesNearTheExactAnswers) {
  for (const SolverKind solver : {SolverKind::sequentialImpulses, SolverKind::softStep}) {
    EXPECT_LT(distanceAtEnd<TypeParam>("incline", 180, solver, 10), 0.1);
    EXPECT_LT(distanceAtEnd<TypeParam>("bounce", 180, solver, 9), 0.3);
    EXPECT_LT(distanceAtEnd<TypeParam>("pyramid:8", 330, solver, 36), 0.01);
    EXPECT_LT(distanceAtEnd<TypeParam>("projectile", 120, solver, 6), 0.2);
    EXPECT_LT(distanceAtEnd<TypeParam>("slide", 300, solver, 8), 0.08);
    EXPECT_LT(distanceAtEnd<TypeParam>("conveyor", 300, solver, 8), 0.08);
    EXPECT_LT(distanceAtEnd<TypeParam>("roll", 240, solver, 6), 0.12);
    EXPECT_LT(distanceAtEnd<TypeParam>("impact", 120, solver, 14), 0.12);
  }
}

}  // namespace
}  // namespace samestep
