// SPDX-License-Identifier: MIT
// Bodies that go far in a step are stopped where they first meet something: nothing passes through a wall.
#include <samestep/space.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/random.h"
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

constexpr SolverKind kSolvers[] = {SolverKind::softStep, SolverKind::sequentialImpulses};

template <Scalar S>
class ContinuousTest : public ::testing::Test {
 protected:
  static constexpr S kHalf = S(4);  ///< Half of the inside of a closed room, m.

  /// Ways in which the walls of a room are made.
  enum class Walls { boxes, segments, thickSegments, tiles };

  static void addRoom(Space<S>& space, Walls walls) {
    const S thin = S(0x1p-6), half = kHalf, out = half + thin, one(1);
    const auto box = [&](S left, S bottom, S right, S top) {
      space.add(boxShape<S>(space.staticBody(), BB<S>(left, bottom, right, top)));
    };
    const Vector<S> corners[] = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
    switch (walls) {
      case Walls::boxes:
        box(-out, -out, out, -half), box(-out, half, out, out);
        box(-out, -out, -half, out), box(half, -out, out, out);
        break;
      case Walls::segments:
      case Walls::thickSegments:
        for (int i = 0; i < 4; ++i) {
          addWall<S>(space, corners[i], corners[(i + 1) % 4],
                     walls == Walls::segments ? S(0) : thin * ratio<S>(1, 2));
        }
        break;
      case Walls::tiles:
        for (S at = -half - one; at < half + one; at += one) {
          box(at, -out, at + one, -half), box(at, half, at + one, out);
          box(-out, at, -half, at + one), box(half, at, out, at + one);
        }
        break;
    }
  }
  static Shape<S> randomShape(BodyId body, Random& random) {
    const S size = ratio<S>(random.between(2, 24), 32), thin = ratio<S>(random.between(1, 8), 32);
    Shape<S> shape = circleShape(body, size * ratio<S>(1, 2));
    const Vector<S> corner(S(0), size);
    switch (random.below(4)) {
      case 0:
        break;
      case 1:
        shape = boxShape<S>(body, size, thin);
        break;
      case 2:
        shape = segmentShape<S>(body, {-size, S(0)}, {size, S(0)}, thin * ratio<S>(1, 2));
        break;
      default:
        shape = polyShape<S>(
            body, std::vector<Vector<S>>{{-size, S(0)}, {size, S(0)}, {S(0), size}, corner + corner});
    }
    shape.setMass(S(1));
    shape.setElasticity(random.number<S>(0, 1));
    shape.setFriction(random.number<S>(0, 1));
    // Bullets fly through each other.
    shape.setFilter({7, 0xffffffffu, 0xffffffffu});
    return shape;
  }
  static Vector<S> randomVelocity(Random& random) {
    const int speed = random.oneIn(3) ? 1 << 10 : random.oneIn(2) ? 100 : 20;
    return {random.number<S>(-speed, speed), random.number<S>(-speed, speed)};
  }
  static BodyId addBullet(Space<S>& space, Random& random) {
    Body<S> body;
    body.setPosition({random.number<S>(-2, 2), random.number<S>(-2, 2)});
    body.setAngle(random.number<S>(-3, 3));
    body.setVelocity(randomVelocity(random));
    if (random.oneIn(2)) body.setAngularVelocity(random.number<S>(-256, 256));
    const BodyId id = space.add(body);
    space.add(randomShape(id, random));
    return id;
  }
  static BodyId addBall(Space<S>& space, const Vector<S>& position, const Vector<S>& velocity, S radius,
                        S elasticity = S(0)) {
    const ShapeId shape = addDisc<S>(space, position, radius, S(1), velocity);
    space.change(shape, [&](Shape<S>& disc) { disc.setElasticity(elasticity); });
    return bodyOf(space, shape);
  }
};
TYPED_TEST_SUITE(ContinuousTest, AllScalars);

TYPED_TEST(ContinuousTest, NothingFliesOutOfAClosedRoomOfThinWalls) {
  using S = TypeParam;
  using Made = typename TestFixture::Walls;
  Random random(1);
  for (const SolverKind solver : kSolvers) {
    for (const Made walls : {Made::boxes, Made::segments, Made::thickSegments, Made::tiles}) {
      Space<S> space;
      space.setSolver(solver);
      space.setContinuous(true);
      space.setGravity({S(0), S(-10)});
      TestFixture::addRoom(space, walls);
      std::vector<BodyId> bullets;
      for (int i = 0; i < 60; ++i) bullets.push_back(TestFixture::addBullet(space, random));
      for (int tick = 0; tick < 40; ++tick) space.step(ratio<S>(1, 60));
      int through = 0;
      for (const BodyId id : bullets) {
        if (!within(space.body(id).worldCenter(), TestFixture::kHalf)) ++through;
      }
      EXPECT_EQ(through, 0) << static_cast<int>(walls) << " " << static_cast<int>(solver);
    }
  }
}

TYPED_TEST(ContinuousTest, WithoutItMostFlyThrough) {
  using S = TypeParam;
  Random random(1);
  Space<S> space;
  space.setContinuous(false);
  TestFixture::addRoom(space, TestFixture::Walls::boxes);
  std::vector<BodyId> bullets;
  for (int i = 0; i < 60; ++i) bullets.push_back(TestFixture::addBullet(space, random));
  for (int tick = 0; tick < 40; ++tick) space.step(ratio<S>(1, 60));
  const auto inside = [&](BodyId id) { return within(space.body(id).worldCenter(), TestFixture::kHalf); };
  EXPECT_LT(std::count_if(bullets.begin(), bullets.end(), inside), 30);
}

TYPED_TEST(ContinuousTest, ABallThatMeetsAWallAtTheSpeedLimitBouncesInTheNextStep) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setContinuous(true);
    const ShapeId wall = addWall<S>(space, {S(10), S(-5)}, {S(10), S(5)}, S(0x1p-7));
    space.change(wall, [](Shape<S>& shape) { shape.setElasticity(S(1)); });
    const BodyId ball = TestFixture::addBall(space, {S(0), S(0)}, {S(1024), S(0)}, ratio<S>(1, 8), S(1));
    space.step(ratio<S>(1, 64));
    EXPECT_NEAR(double(space.body(ball).position().x), 10 - 0.125 - 0x1p-7, 0.004);
    space.step(ratio<S>(1, 64));
    space.step(ratio<S>(1, 64));
    EXPECT_NEAR(double(space.body(ball).velocity().x), -1024, 1);
    EXPECT_LT(space.body(ball).position().x, S(0));
  }
}

TYPED_TEST(ContinuousTest, APlateThatSpinsDoesNotPassAWallThatItsTipMeets) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    for (const int spin : {20, 100, 256}) {
      Space<S> space;
      space.setSolver(solver);
      space.setContinuous(true);
      addWall<S>(space, {S(0), S(-8)}, {S(0), S(8)}, S(0x1p-7));
      Body<S> body;
      // Upright, a little beside the wall, so that it meets it before it has made half a turn.
      body.setPosition({ratio<S>(-1, 2), S(0)});
      body.setAngle(ratio<S>(355, 226));
      body.setAngularVelocity(S(spin));
      const BodyId plate = space.add(body);
      Shape<S> shape = boxShape<S>(plate, S(2), S(0x1p-5));
      shape.setMass(S(1));
      space.add(shape);
      for (int tick = 0; tick < 100; ++tick) {
        space.step(ratio<S>(1, 60));
        for (const S x : {S(-1), S(1)}) {
          ASSERT_LT(double(space.body(plate).toWorld({x, S(0)}).x), 0x1p-5) << spin << " at " << tick;
        }
      }
    }
  }
}

TYPED_TEST(ContinuousTest, AWallThatMovesByItselfTakesAlongWhatItMeets) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    for (const int speed : {10, 100, 1000}) {
      Space<S> space;
      space.setSolver(solver);
      space.setContinuous(true);
      Body<S> mover = Body<S>::kinematic();
      mover.setPosition({S(-4), S(0)});
      mover.setVelocity({S(speed), S(0)});
      const BodyId wall = space.add(mover);
      space.add(segmentShape<S>(wall, {S(0), S(-4)}, {S(0), S(4)}, S(0x1p-7)));
      const BodyId ball = TestFixture::addBall(space, {S(0), S(0)}, {}, ratio<S>(1, 8));
      for (int tick = 0; tick < 20; ++tick) {
        space.step(ratio<S>(1, 60));
        ASSERT_GT(space.body(ball).position().x, space.body(wall).position().x) << speed << " at " << tick;
      }
    }
  }
}

TYPED_TEST(ContinuousTest, ABarThatTurnsByItselfPassesNoBall) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    for (const int spin : {5, 30, 60}) {
      Space<S> space;
      space.setSolver(solver);
      space.setContinuous(true);
      Body<S> mover = Body<S>::kinematic();
      mover.setAngularVelocity(S(spin));
      const BodyId bar = space.add(mover);
      space.add(segmentShape<S>(bar, {}, {S(3), S(0)}, S(0x1p-7)));
      const BodyId ball = TestFixture::addBall(space, {S(0), ratio<S>(3, 2)}, {}, ratio<S>(1, 8));
      for (int tick = 0; tick < 30; ++tick) {
        const Vector<S> before = space.body(bar).toLocal(space.body(ball).position());
        space.step(ratio<S>(1, 60));
        const Vector<S> after = space.body(bar).toLocal(space.body(ball).position());
        // Before it in the sense of its turn, until it has flown off.
        if (length(before) > S(3) || length(after) > S(3)) break;
        if (!(before.y > S(0) && before.x > S(0))) continue;
        ASSERT_GT(after.y, S(0)) << spin << " at " << tick;
      }
    }
  }
}

TYPED_TEST(ContinuousTest, ABulletMeetsWhatContactsMoveAndOthersDoNot) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    for (const bool bullet : {true, false}) {
      Space<S> space;
      space.setSolver(solver);
      space.setContinuous(true);
      const BodyId plate = bodyOf(space, addBox<S>(space, {S(10), S(0)}, S(0x1p-5), S(4), S(1)));
      const BodyId ball = TestFixture::addBall(space, {}, {S(1000), S(0)}, ratio<S>(1, 8));
      space.body(ball).setBullet(bullet);
      for (int tick = 0; tick < 6; ++tick) space.step(ratio<S>(1, 60));
      EXPECT_EQ(space.body(plate).velocity().x > S(1), bullet);
      EXPECT_EQ(space.body(ball).position().x < space.body(plate).position().x, bullet);
    }
  }
}

TYPED_TEST(ContinuousTest, BulletsThatFlyAtEachOtherMeet) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setContinuous(true);
    const BodyId a = TestFixture::addBall(space, {S(-9), S(0)}, {S(900), S(0)}, ratio<S>(1, 8), S(1));
    const BodyId b = TestFixture::addBall(space, {S(9), S(0)}, {S(-700), S(0)}, ratio<S>(1, 8), S(1));
    space.body(a).setBullet(true);
    space.body(b).setBullet(true);
    for (int tick = 0; tick < 10; ++tick) {
      space.step(ratio<S>(1, 60));
      ASSERT_LT(space.body(a).position().x, space.body(b).position().x) << tick;
    }
    EXPECT_LT(space.body(a).velocity().x, S(0));
    EXPECT_GT(space.body(b).velocity().x, S(0));
  }
}

struct Calls {
  int begin = 0, preSolve = 0, separate = 0;
};

template <Scalar S, bool kAccepts>
CollisionHandler<S> countingHandler(Calls& calls) {
  CollisionHandler<S> handler;
  handler.data = &calls;
  handler.begin = [](Arbiter<S>&, Space<S>&, void* data) {
    ++static_cast<Calls*>(data)->begin;
    return true;
  };
  handler.preSolve = [](Arbiter<S>&, Space<S>&, void* data) {
    ++static_cast<Calls*>(data)->preSolve;
    return kAccepts;
  };
  handler.separate = [](Arbiter<S>&, Space<S>&, void* data) { ++static_cast<Calls*>(data)->separate; };
  return handler;
}

TYPED_TEST(ContinuousTest, SensorsOnTheWayAreToldOnce) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setContinuous(true);
    Calls calls;
    space.registerHandler(1, countingHandler<S, true>(calls));
    space.addWildcardHandler(5, 1);
    space.setEventListing({true, false, S(1)});
    const ShapeId gate = addWall<S>(space, {S(3), S(-1)}, {S(3), S(1)}, S(0x1p-6));
    space.change(gate, [](Shape<S>& shape) {
      shape.setSensor(true);
      shape.setCollisionType(5);
    });
    const BodyId ball = TestFixture::addBall(space, {}, {S(600), S(0)}, ratio<S>(1, 8));
    space.step(ratio<S>(1, 60));
    EXPECT_EQ(calls.begin, 1);
    EXPECT_EQ(calls.separate, 0);
    ASSERT_EQ(space.contactEvents().begins.size(), 1u);
    EXPECT_EQ(space.contactEvents().begins[0].sensor, 1);
    EXPECT_NEAR(double(space.body(ball).position().x), 10, 1e-6);
    space.step(ratio<S>(1, 60));
    EXPECT_EQ(calls.separate, 1);
    EXPECT_EQ(space.contactEvents().ends.size(), 1u);
    for (int tick = 0; tick < 5; ++tick) space.step(ratio<S>(1, 60));
    EXPECT_EQ(calls.begin, 1);
    EXPECT_EQ(calls.separate, 1);
    EXPECT_NEAR(double(space.body(ball).position().x), 70, 1e-5);
  }
}

TYPED_TEST(ContinuousTest, HandlersSayWhetherAWallHolds) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    for (const bool accepts : {true, false}) {
      Space<S> space;
      space.setSolver(solver);
      space.setContinuous(true);
      Calls calls;
      space.registerHandler(1, accepts ? countingHandler<S, true>(calls) : countingHandler<S, false>(calls));
      space.addWildcardHandler(5, 1);
      const ShapeId wall = addWall<S>(space, {S(3), S(-1)}, {S(3), S(1)}, S(0x1p-6));
      space.change(wall, [](Shape<S>& shape) { shape.setCollisionType(5); });
      const BodyId ball = TestFixture::addBall(space, {}, {S(600), S(0)}, ratio<S>(1, 8));
      for (int tick = 0; tick < 5; ++tick) space.step(ratio<S>(1, 60));
      EXPECT_EQ(calls.begin, 1);
      EXPECT_GE(calls.preSolve, 1);
      EXPECT_EQ(space.body(ball).position().x < S(3), accepts);
      if (!accepts) {
        EXPECT_EQ(calls.separate, 1);
        EXPECT_NEAR(double(space.body(ball).position().x), 50, 1e-5);
      }
    }
  }
}

TYPED_TEST(ContinuousTest, BodiesThatAJointKeepsFromCollidingPassEachOther) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    for (const bool collides : {true, false}) {
      Space<S> space;
      space.setSolver(solver);
      space.setContinuous(true);
      const BodyId post = space.add(Body<S>::fixedInPlace());
      space.add(segmentShape<S>(post, {S(3), S(-1)}, {S(3), S(1)}, S(0x1p-6)));
      const BodyId ball = TestFixture::addBall(space, {}, {S(600), S(0)}, ratio<S>(1, 8));
      Joint<S> rope = ropeJoint<S>(post, ball, {}, {}, S(0), S(1000));
      rope.collideConnected = collides ? 1 : 0;
      space.add(rope);
      for (int tick = 0; tick < 3; ++tick) space.step(ratio<S>(1, 60));
      EXPECT_EQ(space.body(ball).position().x < S(3), collides);
    }
  }
}

// A body that slides or rolls fast in touch with a floor loses no time on it, nor at the edges of its tiles.
TYPED_TEST(ContinuousTest, AFloorDoesNotStopWhatRollsFastOnIt) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setContinuous(true);
    space.setGravity({S(0), S(-10)});
    for (int i = -2; i < 40; ++i) {
      space.add(boxShape<S>(space.staticBody(), BB<S>(S(i), S(-1), S(i + 1), S(0))));
    }
    const S radius = ratio<S>(1, 4);
    const BodyId ball = TestFixture::addBall(space, {S(0), radius}, {S(60), S(0)}, radius);
    for (int tick = 0; tick < 30; ++tick) space.step(ratio<S>(1, 60));
    EXPECT_NEAR(double(space.body(ball).position().x), 30, 0.01);
    EXPECT_NEAR(double(space.body(ball).position().y), 0.25, 0.01);
  }
}

template <Scalar S>
void fill(Space<S>& space, bool backwards) {
  const std::uint32_t count = 40;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t i = backwards ? count - k : k + 1;
    Random random(i);
    Body<S> body = i % 13 == 0 ? Body<S>::kinematic() : Body<S>();
    body.setPosition({random.number<S>(-3, 3), random.number<S>(-3, 3)});
    body.setVelocity({random.number<S>(-500, 500), random.number<S>(-500, 500)});
    body.setAngularVelocity(random.number<S>(-100, 100));
    body.setBullet(random.oneIn(2));
    const BodyId id = space.add(body, BodyId{i, 1});
    Shape<S> shape = boxShape<S>(id, ratio<S>(random.between(1, 16), 32), ratio<S>(1, 8));
    shape.setMass(S(1));
    shape.setElasticity(S(1));
    space.add(shape, ShapeId{100 + i, 1});
  }
}

TYPED_TEST(ContinuousTest, IsTheSameInAnyOrderWithWorkersAndAfterEachRestore) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space, backwards, shared, restored;
    WorkerPool pool(3);
    shared.setWorkers(&pool, Sharing::always);
    for (Space<S>* each : {&space, &backwards, &shared, &restored}) {
      each->setSolver(solver);
      each->setContinuous(true);
      const std::uint32_t walls[] = {1, 2, 3, 4};
      for (const std::uint32_t i : walls) {
        const S at = i % 2 == 0 ? S(5) : S(-5);
        const Vector<S> a = i <= 2 ? Vector<S>(at, S(-5)) : Vector<S>(S(-5), at);
        const Vector<S> b = i <= 2 ? Vector<S>(at, S(5)) : Vector<S>(S(5), at);
        each->add(segmentShape<S>(each->staticBody(), a, b, S(0x1p-7)), ShapeId{i, 1});
      }
      fill(*each, each == &backwards);
    }
    for (int tick = 0; tick < 40; ++tick) {
      restored.restore(restored.save());
      if (tick % 3 == 0) restored.dropCache();
      for (Space<S>* each : {&space, &backwards, &shared, &restored}) each->step(ratio<S>(1, 60));
      ASSERT_EQ(backwards.hash(), space.hash()) << tick;
      ASSERT_EQ(shared.hash(), space.hash()) << tick;
      ASSERT_EQ(restored.hash(), space.hash()) << tick;
    }
  }
}

}  // namespace
}  // namespace samestep
