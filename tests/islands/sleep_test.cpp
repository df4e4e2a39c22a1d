// SPDX-License-Identifier: MIT
// What is at rest falls asleep, and whatever could move it wakes it.
#include <samestep/joint.h>
#include <samestep/space.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

constexpr SolverKind kBothSolvers[] = {SolverKind::softStep, SolverKind::sequentialImpulses};
constexpr int kLongEnough = 400;

/// A tower of boxes on a floor of its own body, and another tower far away on the same floor.
template <Scalar S>
struct Towers {
  explicit Towers(SolverKind solver, int boxes = 3, bool mayRest = true) {
    space.setSolver(solver);
    space.setGravity({S(0), S(-10)});
    if (mayRest) space.setSleepTimeThreshold(ratio<S>(1, 2));
    floorBody = space.add(Body<S>::fixedInPlace());
    floor = addTile(S(0));
    farFloor = addTile(S(100));
    for (int i = 0; i < boxes; ++i) {
      tower.push_back(addOne(S(0), i));
      farTower.push_back(addOne(S(100), i));
    }
  }
  ShapeId addTile(S x) {
    const BB<S> box = BB<S>::forExtents({x, S(-1)}, S(4), S(1));
    Shape<S> shape = boxShape(floorBody, box);
    shape.setFriction(S(1));
    return space.add(shape);
  }
  BodyId addOne(S x, int i) {
    const ShapeId box = addBox<S>(space, {x, ratio<S>(1, 2) + S(i)}, S(1), S(1), S(1));
    space.change(box, [](Shape<S>& shape) { shape.setFriction(S(1)); });
    return bodyOf(space, box);
  }
  void step(int steps) {
    for (int i = 0; i < steps; ++i) space.step(kTick<S>);
  }
  /// Lets both fall asleep.
  void rest() {
    step(kLongEnough);
    ASSERT_TRUE(asleep(tower));
    ASSERT_TRUE(asleep(farTower));
  }
  bool asleep(const std::vector<BodyId>& bodies) const {
    return std::all_of(bodies.begin(), bodies.end(),
                       [&](BodyId id) { return !space.contains(id) || space.body(id).isSleeping(); });
  }
  bool awake(const std::vector<BodyId>& bodies) const {
    return std::none_of(bodies.begin(), bodies.end(),
                        [&](BodyId id) { return space.contains(id) && space.body(id).isSleeping(); });
  }
  double height(BodyId id) const { return double(std::as_const(space).body(id).position().y); }
  ShapeId shapeOf(BodyId id) const {
    ShapeId found;
    space.eachShape(id, [&](const Shape<S>& shape) { found = shape.id(); });
    return found;
  }

  Space<S> space;
  BodyId floorBody;
  ShapeId floor, farFloor;
  std::vector<BodyId> tower, farTower;
};

template <Scalar S>
class SleepTest : public ::testing::Test {};
TYPED_TEST_SUITE(SleepTest, AllScalars);

TYPED_TEST(SleepTest, NothingSleepsUnlessTheSpaceSaysSo) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> world(solver, 3, false);
    world.step(kLongEnough);
    EXPECT_TRUE(world.awake(world.tower));
    EXPECT_TRUE(world.space.state().restingPairs.empty());
    EXPECT_EQ(world.space.body(world.tower[0]).restTime(), S(0));
  }
}

TYPED_TEST(SleepTest, AnIslandSleepsWhenAllOfItHasBeenAtRestForTheTime) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> world(solver);
    world.step(31);
    EXPECT_TRUE(world.awake(world.tower)) << "half a second is 32 steps";
    world.rest();
    const std::uint32_t island = std::as_const(world.space).body(world.tower[0]).island();
    EXPECT_EQ(island, world.tower[0].index + 1);
    for (const BodyId id : world.tower) EXPECT_EQ(std::as_const(world.space).body(id).island(), island);
    EXPECT_NE(std::as_const(world.space).body(world.farTower[0]).island(), island);
    EXPECT_TRUE(world.space.state().pairs.empty());
  }
}

TYPED_TEST(SleepTest, ASleepingWorldChangesByItsClockAlone) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> world(solver);
    world.rest();
    WorldState<S> before = world.space.state();
    world.step(100);
    EXPECT_EQ(world.space.stamp(), before.stamp + 100);
    Space<S> other;
    before.stamp += 100;
    other.adopt(before);
    EXPECT_EQ(other.hash(), world.space.hash());
  }
}

/// Something done to a world at rest that leaves the tower, or part of it, without what held it.
template <Scalar S>
struct Loss {
  const char* name;
  void (*happens)(Towers<S>& world);
  int falls;  ///< Number of the box of the tower that is lower soon.
};

template <Scalar S>
std::vector<Loss<S>> losses() {
  using World = Towers<S>;
  const auto refuse = [](World& w) {
    CollisionHandler<S> handler;
    handler.preSolve = [](Arbiter<S>&, Space<S>&, void*) { return false; };
    w.space.registerHandler(1, handler);
    w.space.addDefaultCollisionHandler(1);
  };
  return {
      {"the floor is removed", [](World& w) { w.space.removeWithShapes(w.floorBody); }, 0},
      {"the shape of the floor is removed", [](World& w) { w.space.remove(w.floor); }, 0},
      {"the floor is teleported",
       [](World& w) {
         w.space.body(w.floorBody).setPosition({S(0), S(-5)});
       },
       0},
      {"the floor is teleported aside",
       [](World& w) {
         w.space.body(w.floorBody).setPosition({S(50), S(0)});
       },
       0},
      {"the floor is tilted", [](World& w) { w.space.body(w.floorBody).setAngle(S(-1)); }, 0},
      {"the floor is filtered out",
       [](World& w) { w.space.change(w.floor, [](Shape<S>& s) {
                        s.setFilter({0, 1, 0});
                      }); }, 0},
      {"the box is filtered out",
       [](World& w) { w.space.change(w.shapeOf(w.tower[0]), [](Shape<S>& s) {
                        s.setFilter({0, 1, 0});
                      }); },
       0},
      {"the floor becomes a sensor",
       [](World& w) { w.space.change(w.floor, [](Shape<S>& s) { s.setSensor(true); }); }, 0},
      {"the box becomes a sensor",
       [](World& w) { w.space.change(w.shapeOf(w.tower[0]), [](Shape<S>& s) { s.setSensor(true); }); }, 0},
      {"the box in the middle becomes a sensor",
       [](World& w) { w.space.change(w.shapeOf(w.tower[1]), [](Shape<S>& s) { s.setSensor(true); }); }, 2},
      {"the floor shrinks",
       [](World& w) {
         w.space.replace(w.floor, circleShape(w.floorBody, ratio<S>(1, 8), {S(0), S(-2)}));
       },
       0},
      {"the floor becomes dynamic",
       [](World& w) {
         w.space.setType(w.floorBody, BodyType::dynamicBody);
         w.space.body(w.floorBody).setMass(S(9));
         w.space.body(w.floorBody).setMoment(S(9));
       },
       0},
      {"the floor becomes kinematic and moves down",
       [](World& w) {
         w.space.setType(w.floorBody, BodyType::kinematicBody);
         w.space.body(w.floorBody).setVelocity({S(0), S(-2)});
       },
       0},
      {"a box is removed", [](World& w) { w.space.removeWithShapes(w.tower[0]); }, 1},
      {"the shape of a box is removed",
       [](World& w) {
         w.space.remove(w.shapeOf(w.tower[1]));
         w.space.body(w.tower[1]).setMass(S(1));
         w.space.body(w.tower[1]).setMoment(S(1));
       },
       2},
      {"a box is teleported aside",
       [](World& w) {
         w.space.body(w.tower[0]).setPosition({S(40), S(9)});
       },
       1},
      {"a box is teleported up, and falls",
       [](World& w) {
         w.space.body(w.tower[2]).setPosition({S(0), S(9)});
       },
       2},
      {"a box is shot away",
       [](World& w) {
         w.space.body(w.tower[0]).setVelocity({S(60), S(0)});
       },
       2},
      {"a box becomes kinematic and moves away",
       [](World& w) {
         w.space.setType(w.tower[0], BodyType::kinematicBody);
         w.space.body(w.tower[0]).setVelocity({S(9), S(0)});
       },
       2},
      {"gravity points down more to the right",
       [](World& w) {
         w.space.setGravity({S(60), S(-10)});
       },
       2},
      {"contacts are forgotten and a handler refuses them", refuse, 0},
      {"contacts are ignored in a visit",
       [](World& w) {
         w.space.eachArbiter(w.tower[0], [](Arbiter<S>& arbiter) {
           if (!arbiter.bodyDataA().isDynamic() || !arbiter.bodyDataB().isDynamic()) arbiter.ignore();
         });
       },
       0},
  };
}

TYPED_TEST(SleepTest, ASleeperNeverHovers) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    for (const Loss<S>& loss : losses<S>()) {
      Towers<S> world(solver);
      world.rest();
      loss.happens(world);
      const BodyId falls = world.tower[static_cast<std::size_t>(loss.falls)];
      const double before = world.height(falls);
      world.step(1);
      EXPECT_TRUE(world.awake(world.tower)) << loss.name;
      world.step(100);
      EXPECT_LT(world.height(falls), before - 0.25) << loss.name;
    }
  }
}

// A game that builds its level on one static body changes a tile, and only what lies there wakes.
TYPED_TEST(SleepTest, WhatLiesElsewhereSleepsOn) {
  using S = TypeParam;
  using Change = void (*)(Towers<S>&);
  const std::pair<const char*, Change> changes[] = {
      {"a tile is removed", [](Towers<S>& w) { w.space.remove(w.floor); }},
      {"a tile is changed",
       [](Towers<S>& w) { w.space.change(w.floor, [](Shape<S>& s) { s.setSensor(true); }); }},
      {"a tile is added", [](Towers<S>& w) { w.space.add(boxShape(w.floorBody, S(3), S(3))); }},
      {"a box is pushed",
       [](Towers<S>& w) {
         w.space.body(w.tower[1]).setVelocity({S(3), S(0)});
       }},
      {"a box is removed", [](Towers<S>& w) { w.space.removeWithShapes(w.tower[1]); }},
      {"a ball falls on it",
       [](Towers<S>& w) {
         addDisc<S>(w.space, {S(0), S(4)}, ratio<S>(1, 2), S(1));
       }},
  };
  for (const SolverKind solver : kBothSolvers) {
    for (const auto& [name, change] : changes) {
      Towers<S> world(solver);
      world.rest();
      change(world);
      bool woke = false;
      for (int i = 0; i < 60; ++i) {
        world.step(1);
        woke |= world.awake(world.tower);
        ASSERT_TRUE(world.asleep(world.farTower)) << name;
      }
      EXPECT_TRUE(woke) << name;
    }
  }
}

TYPED_TEST(SleepTest, WhatChangesNothingWakesNobody) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> world(solver);
    world.rest();
    Space<S>& space = world.space;
    for (const BodyId id : {world.tower[0], world.floorBody}) {
      Body<S>& body = space.body(id);
      body.setUserData(7);
      body.setVelocity({});
      body.setAngularVelocity(S(0));
      body.setForce({});
      body.setTorque(S(0));
      body.setAngle(body.angle());
      body.applyForce({}, {});
      body.applyImpulse({}, {});
    }
    for (const ShapeId shape : {world.floor, world.shapeOf(world.tower[0])}) {
      space.change(shape, [](Shape<S>& s) { s.setUserData(9); });
    }
    space.setSettings(space.settings());
    space.setType(world.tower[0], BodyType::dynamicBody);
    space.add(boxShape(world.floorBody, BB<S>::forExtents({S(0), S(-30)}, S(1), S(1))));
    const ShapeId away = addDisc<S>(space, {S(50), S(50)}, S(1), S(1));
    space.eachArbiter([](Arbiter<S>& arbiter) { arbiter.totalImpulse(); });
    std::vector<ShapeId> hits;
    space.boxQuery(BB<S>::forExtents({}, S(9), S(9)), {}, hits);
    EXPECT_EQ(hits.size(), 4u);
    world.step(3);
    EXPECT_TRUE(world.asleep(world.tower));
    EXPECT_TRUE(world.asleep(world.farTower));
    space.removeWithShapes(bodyOf(space, away));
    world.step(3);
    EXPECT_TRUE(world.asleep(world.tower));
  }
}

TYPED_TEST(SleepTest, EachSetterThatChangesSomethingWakes) {
  using S = TypeParam;
  using Change = void (*)(Towers<S>&);
  const std::pair<const char*, Change> changes[] = {
      {"velocity",
       [](Towers<S>& w) {
         w.space.body(w.tower[1]).setVelocity({ratio<S>(1, 100), S(0)});
       }},
      {"spin", [](Towers<S>& w) { w.space.body(w.tower[1]).setAngularVelocity(ratio<S>(1, 100)); }},
      {"force",
       [](Towers<S>& w) {
         w.space.body(w.tower[1]).setForce({ratio<S>(1, 100), S(0)});
       }},
      {"torque", [](Towers<S>& w) { w.space.body(w.tower[1]).setTorque(ratio<S>(1, 100)); }},
      {"force at a point",
       [](Towers<S>& w) {
         w.space.body(w.tower[1]).applyForce({S(0), S(1)}, {});
       }},
      {"impulse",
       [](Towers<S>& w) {
         w.space.body(w.tower[1]).applyImpulse({S(0), ratio<S>(1, 100)}, {});
       }},
      {"bias",
       [](Towers<S>& w) {
         w.space.body(w.tower[1]).applyBiasImpulse({S(0), S(1)}, {});
       }},
      {"position",
       [](Towers<S>& w) {
         w.space.body(w.tower[1]).setPosition({ratio<S>(1, 100), S(1)});
       }},
      {"angle", [](Towers<S>& w) { w.space.body(w.tower[1]).setAngle(ratio<S>(1, 100)); }},
      {"mass", [](Towers<S>& w) { w.space.body(w.tower[1]).setMass(S(2)); }},
      {"moment", [](Towers<S>& w) { w.space.body(w.tower[1]).setMoment(S(2)); }},
      {"centre",
       [](Towers<S>& w) {
         w.space.body(w.tower[1]).setCenterOfMass({ratio<S>(1, 100), S(0)});
       }},
      {"activate", [](Towers<S>& w) { w.space.body(w.tower[1]).activate(); }},
      {"may not sleep", [](Towers<S>& w) { w.space.body(w.tower[1]).setMaySleep(false); }},
      {"update of position",
       [](Towers<S>& w) {
         w.space.body(w.tower[1]).setVelocity({S(1), S(0)});
         w.space.body(w.tower[1]).updatePosition(ratio<S>(1, 64));
       }},
      {"update of velocity",
       [](Towers<S>& w) {
         w.space.body(w.tower[1]).updateVelocity({S(0), S(1)}, S(1));
       }},
      {"friction", [](Towers<S>& w) { w.space.change(w.floor, [](Shape<S>& s) { s.setFriction(S(0)); }); }},
      {"elasticity",
       [](Towers<S>& w) { w.space.change(w.floor, [](Shape<S>& s) { s.setElasticity(S(1)); }); }},
      {"belt",
       [](Towers<S>& w) {
         w.space.change(w.floor, [](Shape<S>& s) { s.setSurfaceVelocity({S(1), S(0)}); });
       }},
      {"collision type",
       [](Towers<S>& w) { w.space.change(w.floor, [](Shape<S>& s) { s.setCollisionType(3); }); }},
      {"a shape more", [](Towers<S>& w) { w.space.add(circleShape(w.tower[1], ratio<S>(1, 4))); }},
      {"a filter that lets in what is near",
       [](Towers<S>& w) {
         w.space.change(w.shapeOf(w.tower[1]), [](Shape<S>& s) { s.setFilter({5, ~0u, ~0u}); });
       }},
      {"contacts forgotten", [](Towers<S>& w) { w.space.filterArbiters(w.tower[1]); }},
      {"contacts of a tile forgotten", [](Towers<S>& w) { w.space.filterArbiters(w.floorBody, w.floor); }},
      {"iterations", [](Towers<S>& w) { w.space.setIterations(20); }},
      {"margin", [](Towers<S>& w) { w.space.setContactMargin(ratio<S>(1, 40)); }},
      {"solver",
       [](Towers<S>& w) {
         const bool soft = w.space.settings().solver == SolverKind::softStep;
         w.space.setSolver(soft ? SolverKind::sequentialImpulses : SolverKind::softStep);
       }},
      {"threshold", [](Towers<S>& w) { w.space.setIdleSpeedThreshold(S(1)); }},
      {"no sleeping any more", [](Towers<S>& w) { w.space.setSleepTimeThreshold(S(0)); }},
      {"a static body put there",
       [](Towers<S>& w) {
         const BodyId wall = w.space.add(Body<S>::fixedInPlace());
         w.space.add(boxShape(wall, S(1), S(1)));
         w.space.body(wall).setPosition({ratio<S>(9, 10), S(1)});
       }},
      {"a static shape put there",
       [](Towers<S>& w) { w.space.add(boxShape(w.space.staticBody(), S(2), S(2))); }},
  };
  for (const SolverKind solver : kBothSolvers) {
    for (const auto& [name, change] : changes) {
      Towers<S> world(solver);
      world.rest();
      change(world);
      world.step(1);
      EXPECT_TRUE(world.awake(world.tower)) << name;
      // No pair is left behind, whatever else it did.
      for (const Pair<S>& pair : world.space.state().restingPairs) {
        for (const ShapeId shape : {ShapeId(pair.a), ShapeId(pair.b)}) {
          const BodyId body = world.space.shape(world.space.state().shapes.idAt(shape.index)).body();
          EXPECT_EQ(std::as_const(world.space).body(body).activity(), Activity::asleep) << name;
        }
      }
    }
  }
}

TYPED_TEST(SleepTest, AKinematicBodyThatStartsWakesWhatItTouchesAndCarries) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setGravity({S(0), S(-10)});
    space.setSleepTimeThreshold(ratio<S>(1, 2));
    const BodyId lift = space.add(Body<S>::kinematic());
    space.add(boxShape(lift, BB<S>::forExtents({S(0), S(-1)}, S(4), S(1))));
    const BodyId rider = bodyOf(space, addBox<S>(space, {S(0), ratio<S>(1, 2)}, S(1), S(1), S(1)));
    for (int i = 0; i < kLongEnough; ++i) space.step(kTick<S>);
    ASSERT_TRUE(space.body(rider).isSleeping());
    ASSERT_EQ(space.body(lift).activity(), Activity::asleep);
    space.body(lift).setVelocity({S(0), S(1)});
    for (int i = 0; i < 64; ++i) space.step(kTick<S>);
    EXPECT_FALSE(space.body(rider).isSleeping());
    EXPECT_NEAR(double(space.body(rider).position().y), 1.5, 0.05);
    // It never sleeps on what moves, however slowly.
    space.body(lift).setVelocity({S(0), ratio<S>(1, 100)});
    for (int i = 0; i < kLongEnough; ++i) space.step(kTick<S>);
    EXPECT_FALSE(space.body(rider).isSleeping());
    space.body(lift).setVelocity({});
    for (int i = 0; i < kLongEnough; ++i) space.step(kTick<S>);
    EXPECT_TRUE(space.body(rider).isSleeping());
    // One that comes from afar.
    const BodyId ram = space.add(Body<S>::kinematic());
    space.add(boxShape(ram, S(1), S(1)));
    space.body(ram).setPosition({S(-4), space.body(rider).position().y});
    space.body(ram).setVelocity({S(2), S(0)});
    for (int i = 0; i < 90; ++i) space.step(kTick<S>);
    EXPECT_LT(double(space.body(ram).position().x), 0.0);
    EXPECT_TRUE(space.body(rider).isSleeping()) << "it is not there yet";
    for (int i = 0; i < 64; ++i) space.step(kTick<S>);
    EXPECT_GT(double(space.body(rider).position().x), 1.0);
  }
}

// At the top of its way a body is slow, and held by nothing.
TYPED_TEST(SleepTest, NothingSleepsInTheAir) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    for (const S pull : {S(10), ratio<S>(1, 100)}) {
      Space<S> space;
      space.setSolver(solver);
      space.setGravity({S(0), -pull});
      space.setSleepTimeThreshold(kTick<S>);
      space.setIdleSpeedThreshold(S(1));
      addWall<S>(space, {S(0), S(-9)}, {S(0), S(99)});
      // One alone, two together, one that slides along a wall.
      const S half = ratio<S>(1, 2);
      std::vector<BodyId> all = {
          bodyOf(space, addDisc<S>(space, {S(9), S(0)}, half, S(1), {S(0), half})),
          bodyOf(space, addBox<S>(space, {S(5), S(0)}, S(1), S(1), S(1), {S(0), half})),
          bodyOf(space, addBox<S>(space, {S(5), S(1)}, S(1), S(1), S(1), {S(0), half})),
          bodyOf(space, addBox<S>(space, {half, S(0)}, S(1), S(1), S(1), {S(0), half}))};
      for (int i = 0; i < 300; ++i) {
        space.step(kTick<S>);
        for (const BodyId id : all) ASSERT_FALSE(space.body(id).isSleeping()) << i;
      }
    }
  }
}

// A slack rope holds nothing; once it hangs in it, the body sleeps.
TYPED_TEST(SleepTest, OnARopeABodySleepsWhenTheRopeHoldsIt) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setGravity({S(0), -ratio<S>(1, 50)});
    space.setSleepTimeThreshold(ratio<S>(1, 4));
    space.setIdleSpeedThreshold(ratio<S>(1, 4));
    const BodyId disc = bodyOf(space, addDisc<S>(space, {}, ratio<S>(1, 2), S(1), {S(0), ratio<S>(1, 8)}));
    space.add(ropeJoint<S>(space.staticBody(), disc, {}, {}, S(0), S(1)));
    double lowest = 0;
    for (int i = 0; i < 64 * 24; ++i) {
      space.step(kTick<S>);
      const Body<S>& body = std::as_const(space).body(disc);
      lowest = std::min(lowest, double(body.position().y));
      ASSERT_FALSE(body.isSleeping() && double(body.position().y) > -0.95) << "in step " << i;
    }
    EXPECT_LT(lowest, -0.5);
    space.setGravity({S(0), S(-10)});
    for (int i = 0; i < 64 * 20; ++i) space.step(kTick<S>);
    EXPECT_TRUE(std::as_const(space).body(disc).isSleeping());
    EXPECT_NEAR(double(std::as_const(space).body(disc).position().y), -1.0, 0.05);
  }
}

TYPED_TEST(SleepTest, WithoutGravityWhatIsSlowStopsAndSleeps) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setSleepTimeThreshold(ratio<S>(1, 2));
    const BodyId slow = bodyOf(space, addDisc<S>(space, {}, S(1), S(1), {ratio<S>(1, 25), S(0)}));
    const BodyId fast = bodyOf(space, addDisc<S>(space, {S(9), S(0)}, S(1), S(1), {ratio<S>(1, 15), S(0)}));
    const BodyId spins = bodyOf(space, addBox<S>(space, {S(20), S(0)}, S(8), S(1), S(1)));
    space.body(spins).setAngularVelocity(ratio<S>(1, 50));
    for (int i = 0; i < 100; ++i) space.step(kTick<S>);
    EXPECT_TRUE(space.body(slow).isSleeping());
    EXPECT_EQ(space.body(slow).velocity(), Vector<S>());
    EXPECT_FALSE(space.body(fast).isSleeping());
    EXPECT_FALSE(space.body(spins).isSleeping()) << "its ends move at 8 cm/s";
  }
}

TYPED_TEST(SleepTest, WhoMayNotSleepKeepsItsIslandAwake) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> world(solver);
    world.space.body(world.tower[1]).setMaySleep(false);
    world.step(kLongEnough);
    EXPECT_TRUE(world.awake(world.tower));
    EXPECT_TRUE(world.asleep(world.farTower));
    world.space.body(world.tower[1]).setMaySleep(true);
    world.step(1);
    EXPECT_TRUE(world.asleep(world.tower)) << "it has been at rest for long";
  }
}

TYPED_TEST(SleepTest, SleepSparesTheWaitAndNothingElse) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> world(solver);
    world.space.setSleepTimeThreshold(S(100));
    world.step(100);
    for (const BodyId id : world.tower) world.space.body(id).sleep();
    world.step(1);
    EXPECT_TRUE(world.asleep(world.tower));
    EXPECT_TRUE(world.awake(world.farTower));
    const BodyId falls = bodyOf(world.space, addDisc<S>(world.space, {S(50), S(50)}, S(1), S(1)));
    world.space.body(falls).sleep();
    world.step(20);
    EXPECT_LT(world.height(falls), 49.9);
  }
}

// A body that is woken goes on from its impulses. Asleep it misses what it would have crept meanwhile: less
// than 1 mm a second, measured at rest, far from the 5 cm/s that count as rest.
TYPED_TEST(SleepTest, AWorldThatSleptGoesOnAsOneThatDidNot) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> slept(solver, 6), never(solver, 6, false);
    slept.rest();
    never.step(kLongEnough);
    slept.step(10 * 64);
    never.step(10 * 64);
    ASSERT_TRUE(slept.asleep(slept.tower));
    std::vector<double> before;
    for (const BodyId id : slept.tower) before.push_back(slept.height(id));
    slept.space.body(slept.tower[3]).activate();
    slept.step(1);
    never.step(1);
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_NEAR(slept.height(slept.tower[i]), before[i], 1e-4);
    slept.step(20);
    never.step(20);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const auto& a = std::as_const(slept.space).body(slept.tower[i]);
      const auto& b = std::as_const(never.space).body(never.tower[i]);
      EXPECT_NEAR(double(a.position().x), double(b.position().x), 0.01);
      EXPECT_NEAR(double(a.position().y), double(b.position().y), 0.01);
      EXPECT_NEAR(double(a.position().y), before[i], 1e-3) << "no jump";
      EXPECT_NEAR(double(a.angle()), double(b.angle()), 0.01);
    }
  }
}

TYPED_TEST(SleepTest, SleepersAreSeenAndTheirContactsToo) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> world(solver);
    world.rest();
    int pairs = 0;
    ShapeId lastA, lastB;
    world.space.eachArbiter([&](Arbiter<S>& arbiter) {
      EXPECT_TRUE(pairs == 0 || std::pair(lastA, lastB) < std::pair(arbiter.shapeA(), arbiter.shapeB()));
      lastA = arbiter.shapeA();
      lastB = arbiter.shapeB();
      ++pairs;
      EXPECT_GT(arbiter.count(), 0);
      EXPECT_EQ(arbiter.totalImpulse(), Vector<S>());
    });
    EXPECT_EQ(pairs, 6);
    pairs = 0;
    world.space.eachArbiter(world.tower[1], [&](Arbiter<S>&) { ++pairs; });
    EXPECT_EQ(pairs, 2);
    std::vector<PointHit<S>> points;
    world.space.pointQuery({S(0), S(1)}, S(0), {}, points);
    EXPECT_FALSE(points.empty());
    std::vector<SegmentHit<S>> hits;
    world.space.segmentQuery({S(-9), S(1)}, {S(9), S(1)}, S(0), {}, hits);
    EXPECT_FALSE(hits.empty());
  }
}

/// Words that handlers and lists were told.
template <Scalar S>
struct Told {
  int begins = 0, ends = 0, removals = 0;

  static bool begin(Arbiter<S>&, Space<S>&, void* to) {
    ++static_cast<Told*>(to)->begins;
    return true;
  }
  static void separate(Arbiter<S>& arbiter, Space<S>&, void* to) {
    ++static_cast<Told*>(to)->ends;
    static_cast<Told*>(to)->removals += arbiter.isRemoval() ? 1 : 0;
  }
};

TYPED_TEST(SleepTest, BeginAndSeparateAreToldOnceHoweverLongAContactSleeps) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Told<S> told;
    Towers<S> world(solver);
    CollisionHandler<S> handler;
    handler.begin = Told<S>::begin;
    handler.separate = Told<S>::separate;
    handler.data = &told;
    world.space.registerHandler(1, handler);
    world.space.addDefaultCollisionHandler(1);
    world.space.setEventListing({true, false, S(0)});
    std::size_t begins = 0, ends = 0;
    const auto step = [&](int steps) {
      for (int i = 0; i < steps; ++i) {
        world.step(1);
        begins += world.space.contactEvents().begins.size();
        ends += world.space.contactEvents().ends.size();
      }
    };
    step(kLongEnough);
    ASSERT_TRUE(world.asleep(world.tower));
    EXPECT_EQ(told.begins, 6);
    EXPECT_EQ(begins, 6u);
    // Woken by hand, and by what touches it in a step.
    world.space.body(world.tower[0]).activate();
    step(kLongEnough);
    const ShapeId ball = addDisc<S>(world.space, {S(0), S(4)}, ratio<S>(1, 2), S(1));
    step(kLongEnough);
    EXPECT_GE(told.begins, 7);
    EXPECT_EQ(begins, static_cast<std::size_t>(told.begins));
    EXPECT_EQ(ends, static_cast<std::size_t>(told.ends));
    const int before = told.ends;
    world.space.removeWithShapes(bodyOf(world.space, ball));
    step(kLongEnough);
    ASSERT_TRUE(world.asleep(world.tower));
    world.space.remove(world.farFloor);
    EXPECT_GT(told.removals, 0);
    step(1);
    EXPECT_EQ(ends, static_cast<std::size_t>(told.ends));
    EXPECT_GE(told.ends, before + 1);
  }
}

// A sensor does not wake, and is told.
TYPED_TEST(SleepTest, ASensorThatPassesIsToldAndWakesNobody) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> world(solver);
    world.rest();
    const BodyId ghost = world.space.add(Body<S>::kinematic());
    Shape<S> shape = circleShape(ghost, ratio<S>(1, 2));
    shape.setSensor(true);
    world.space.add(shape);
    world.space.body(ghost).setPosition({S(-4), S(1)});
    world.space.body(ghost).setVelocity({S(4), S(0)});
    world.space.setEventListing({true, false, S(0)});
    std::size_t begins = 0, ends = 0;
    for (int i = 0; i < 128; ++i) {
      world.step(1);
      begins += world.space.contactEvents().begins.size();
      ends += world.space.contactEvents().ends.size();
      ASSERT_TRUE(world.asleep(world.tower));
    }
    EXPECT_EQ(begins, 2u);
    EXPECT_EQ(ends, 2u);
  }
}

TYPED_TEST(SleepTest, ThresholdsAreChecked) {
  using S = TypeParam;
  Space<S> space;
  expectRefused<ValueOutOfRange>(space, [&] { space.setSleepTimeThreshold(S(-1)); });
  expectRefused<ValueOutOfRange>(space, [&] { space.setSleepTimeThreshold(S(1025)); });
  expectRefused<ValueOutOfRange>(space, [&] { space.setIdleSpeedThreshold(S(-1)); });
  expectRefused<ValueOutOfRange>(space, [&] { space.setIdleSpeedThreshold(S(1025)); });
  space.setSleepTimeThreshold(S(1024));
  space.setIdleSpeedThreshold(S(0));
}

// With a threshold of nothing only what stands still is at rest.
TYPED_TEST(SleepTest, WithAThresholdOfZeroOnlyWhatStandsStillSleeps) {
  using S = TypeParam;
  Space<S> space;
  space.setSleepTimeThreshold(ratio<S>(1, 4));
  space.setIdleSpeedThreshold(S(0));
  const BodyId still = bodyOf(space, addDisc<S>(space, {}, S(1), S(1)));
  const BodyId creeps =
      bodyOf(space, addDisc<S>(space, {S(9), S(0)}, S(1), S(1), {ratio<S>(1, 1 << 20), S(0)}));
  for (int i = 0; i < 64; ++i) space.step(kTick<S>);
  EXPECT_TRUE(space.body(still).isSleeping());
  EXPECT_FALSE(space.body(creeps).isSleeping());
}

TYPED_TEST(SleepTest, AStepThatIsRefusedWakesNobody) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> world(solver);
    world.rest();
    world.space.setMaxPairs(6);
    for (int i = 0; i < 6; ++i) addDisc<S>(world.space, {S(50), S(0)}, S(1), S(1));
    world.space.body(world.tower[0]).activate();
    world.space.body(world.floorBody).setPosition({S(0), S(-1)});
    expectRefused<TooManyPairs>(world.space, [&] { world.step(1); });
    EXPECT_EQ(world.space.body(world.tower[1]).activity(), Activity::asleep);
    world.space.setMaxPairs(1000);
    world.step(30);
    EXPECT_TRUE(world.awake(world.tower));
    EXPECT_LT(world.height(world.tower[2]), 2.0);
    EXPECT_TRUE(world.awake(world.farTower));
  }
}

// A callback may wake: what it changes moves from the next step on.
TYPED_TEST(SleepTest, ACallbackOfAStepMayWakeWhoSleeps) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> world(solver);
    world.rest();
    CollisionHandler<S> handler;
    handler.begin = [](Arbiter<S>&, Space<S>& space, void* data) {
      auto& towers = *static_cast<Towers<S>*>(data);
      space.body(towers.tower[0]).setVelocity({S(30), S(0)});
      space.body(towers.floorBody).setForce({S(1), S(0)});
      return true;
    };
    handler.data = &world;
    world.space.registerHandler(1, handler);
    world.space.addCollisionHandler(1, 1, 1);
    world.step(kLongEnough);
    ASSERT_TRUE(world.asleep(world.tower));
    for (const S x : {S(50), S(51)}) {
      const ShapeId disc = addDisc<S>(world.space, {x, S(9)}, S(1), S(1));
      world.space.change(disc, [](Shape<S>& s) { s.setCollisionType(1); });
    }
    world.step(2);
    EXPECT_TRUE(world.awake(world.tower));
    EXPECT_TRUE(world.asleep(world.farTower));
    world.step(20);
    EXPECT_GT(double(world.space.body(world.tower[0]).position().x), 1.0);
    EXPECT_EQ(world.space.body(world.floorBody).force(), Vector<S>());
  }
}

// A position function rouses before contacts are known, or after they were solved; either way the next step
// wakes, and what the body touches in between wakes by that.
TYPED_TEST(SleepTest, APositionFunctionMayRouseWhoSleeps) {
  using S = TypeParam;
  for (const SolverKind solver : kBothSolvers) {
    Towers<S> world(solver);
    const auto rousing = [](Body<S>& body, S dt, void* data) {
      auto& towers = *static_cast<Towers<S>*>(data);
      body.updatePosition(dt);
      towers.space.body(towers.tower[1]).activate();
      if (towers.height(towers.farTower[2]) < 9.0) towers.space.body(towers.farTower[0]).activate();
    };
    world.space.registerPositionFunc(1, rousing, &world);
    world.rest();
    const ShapeId ball = addDisc<S>(world.space, {S(0), S(4)}, ratio<S>(1, 2), S(1), {S(0), S(-9)});
    world.space.body(bodyOf(world.space, ball)).setPositionFunc(1);
    SavedSpace<S> saved;
    std::vector<std::uint64_t> hashes;
    world.space.save(saved);
    for (int i = 0; i < 60; ++i) {
      world.step(1);
      hashes.push_back(world.space.hash());
    }
    EXPECT_TRUE(world.awake(world.tower));
    EXPECT_TRUE(world.awake(world.farTower));
    EXPECT_GT(world.height(world.tower[0]), 0.4);
    world.space.restore(saved);
    for (int i = 0; i < 60; ++i) {
      world.space.dropCache();
      world.step(1);
      ASSERT_EQ(world.space.hash(), hashes[static_cast<std::size_t>(i)]) << i;
    }
  }
}

}  // namespace
}  // namespace samestep
