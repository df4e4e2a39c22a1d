// SPDX-License-Identifier: MIT
#include <samestep/space.h>
#include <samestep/workers.h>

#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "support/midway.h"
#include "support/scalars.h"

namespace samestep {
namespace {

/// Trap that throws, or wants the call to end, when it is asked for the nth time.
struct Trap {
  int left = -1;
  bool sprung = false;

  bool springs() {
    if (left < 0 || left-- > 0) return false;
    sprung = true;
    return true;
  }
  void step() {
    if (springs()) throw std::runtime_error("out of a callback");
  }
  static Trap& of(void* data) { return *static_cast<Trap*>(data); }
};

enum class Kind { begin, preSolve, postSolve, separate, position, velocity, observer, interrupt };

template <Scalar S>
class SpaceMidwayTest : public ::testing::Test {
 protected:
  /// A world of which each kind of callback is asked.
  static void fill(Space<S>& space, Kind kind, Trap& trap, SolverKind solver) {
    space.setSolver(solver);
    CollisionHandler<S> handler;
    handler.data = &trap;
    const auto yes = [](Arbiter<S>&, Space<S>&, void* data) {
      Trap::of(data).step();
      return true;
    };
    const auto note = [](Arbiter<S>&, Space<S>&, void* data) { Trap::of(data).step(); };
    if (kind == Kind::begin) handler.begin = yes;
    if (kind == Kind::preSolve) handler.preSolve = yes;
    if (kind == Kind::postSolve) handler.postSolve = note;
    if (kind == Kind::separate) handler.separate = note;
    space.registerHandler(1, handler);
    space.addDefaultCollisionHandler(1);
    space.registerPositionFunc(
        2,
        [](Body<S>& body, S dt, void* data) {
          Trap::of(data).step();
          body.setPosition(body.position() + body.velocity() * dt);
        },
        &trap);
    space.registerVelocityFunc(
        3,
        [](Body<S>& body, const Vector<S>& gravity, S, S dt, void* data) {
          Trap::of(data).step();
          body.setVelocity(body.velocity() + gravity * dt);
        },
        &trap);
    fillAtRandom(space, 7);
    for (int i = 0; i < 3; ++i) {
      const BodyId body = bodyOf(space, addDisc<S>(space, {S(4 * i - 4), S(3)}, S(1), S(1)));
      if (kind == Kind::position) space.body(body).setPositionFunc(2);
      if (kind == Kind::velocity) space.body(body).setVelocityFunc(3);
    }
    if (kind == Kind::observer) {
      space.setStageObserver([](const Space<S>&, Stage, void* data) { Trap::of(data).step(); }, &trap);
    }
    if (kind == Kind::interrupt) {
      space.setInterrupt({[](void* data) { return Trap::of(data).springs(); }, &trap});
    }
  }

  /// Plays on after each place where `act` may be ended, and compares with a match in which it was not.
  template <class Act>
  static int endEverywhere(Kind kind, SolverKind solver, TaskRunner* workers, Act&& act) {
    Trap trap;
    Space<S> model;
    fill(model, kind, trap, solver);
    model.setWorkers(workers, Sharing::always);
    hashesOf(model, 30);
    const SavedSpace<S> before = model.save();
    const std::uint64_t hashBefore = model.hash();
    act(model);
    const std::vector<std::uint64_t> after = hashesOf(model, 3);
    int ended = 0;
    for (int place = 0;; ++place) {
      model.restore(before);
      trap = {place, false};
      try {
        act(model);
      } catch (const std::exception&) {
        EXPECT_TRUE(trap.sprung);
        ++ended;
      }
      const bool sprung = trap.sprung;
      trap = {};
      if (!sprung) return ended;
      expectAsItWasOrUnusable(model, before, hashBefore);
      act(model);
      EXPECT_EQ(hashesOf(model, 3), after) << "place " << place;
    }
  }
};
TYPED_TEST_SUITE(SpaceMidwayTest, AllScalars);

TYPED_TEST(SpaceMidwayTest, AStepThatACallbackEndsLeavesNoWorldUntilOneIsRestored) {
  using S = TypeParam;
  WorkerPool pool(2);
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    for (const Kind kind : {Kind::begin, Kind::preSolve, Kind::postSolve, Kind::separate, Kind::position,
                            Kind::velocity, Kind::observer, Kind::interrupt}) {
      // Begin and separate are rare.
      const int steps = kind == Kind::begin || kind == Kind::separate ? 60 : 1;
      const int ended = this->endEverywhere(kind, solver, &pool, [&](Space<S>& space) {
        for (int i = 0; i < steps; ++i) space.step(kTick<S>);
      });
      EXPECT_GT(ended, 0) << static_cast<int>(kind) << ' ' << static_cast<int>(solver);
    }
  }
}

TYPED_TEST(SpaceMidwayTest, ARemovalThatSeparateEndsLeavesNoWorldUntilOneIsRestored) {
  using S = TypeParam;
  const auto remove = [](Space<S>& space) {
    for (std::uint32_t i = 3; i < 6; ++i) space.removeWithShapes(space.state().bodies.idAt(i));
  };
  const auto removeShape = [](Space<S>& space) { space.remove(space.state().shapes.idAt(3)); };
  const auto filter = [](Space<S>& space) { space.filterArbiters(space.staticBody()); };
  int ended = 0;
  ended += this->endEverywhere(Kind::separate, SolverKind::softStep, nullptr, filter);
  EXPECT_GT(ended, 0);
  this->endEverywhere(Kind::separate, SolverKind::softStep, nullptr, remove);
  this->endEverywhere(Kind::separate, SolverKind::softStep, nullptr, removeShape);
}

TYPED_TEST(SpaceMidwayTest, AVisitorOrAPostStepCallbackThatThrowsLeavesTheWorldWhole) {
  using S = TypeParam;
  Space<S> space;
  fillAtRandom(space, 4);
  hashesOf(space, 30);
  const std::uint64_t hash = space.hash();
  const auto stop = [](auto&&...) { throw std::runtime_error("stop"); };
  const auto expectWhole = [&](auto&& call) {
    EXPECT_THROW(call(), std::runtime_error);
    EXPECT_TRUE(space.isUsable());
    EXPECT_FALSE(space.isLocked());
    EXPECT_EQ(space.hash(), hash);
  };
  expectWhole([&] { space.eachBody(stop); });
  expectWhole([&] { space.eachShape(stop); });
  expectWhole([&] { space.eachShape(space.staticBody(), stop); });
  expectWhole([&] { space.eachArbiter(stop); });
  expectWhole([&] { space.eachArbiter(space.staticBody(), stop); });
  expectWhole([&] { space.change(space.state().shapes.idAt(0), stop); });
  expectWhole([&] {
    space.addPostStepCallback([](Space<S>&, std::uint64_t, void*) { throw std::runtime_error("stop"); }, 1);
  });
}

TYPED_TEST(SpaceMidwayTest, AStepIsInterruptedBetweenManyPairsAndPasses) {
  using S = TypeParam;
  WorkerPool pool(2);
  for (TaskRunner* workers : {static_cast<TaskRunner*>(nullptr), static_cast<TaskRunner*>(&pool)}) {
    for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
      Space<S> space;
      space.setSolver(solver);
      space.setSubsteps(20);
      space.setIterations(20);
      space.setWorkers(workers, Sharing::always);
      for (int i = 0; i < 200; ++i) addDisc<S>(space, {}, S(1), S(1));
      space.step(kTick<S>);
      ASSERT_EQ(space.state().pairs.size(), 200u * 199u / 2u);
      struct Count {
        int asked = 0;
      } count;
      space.setInterrupt({[](void* data) {
                            ++static_cast<Count*>(data)->asked;
                            return false;
                          },
                          &count});
      space.step(kTick<S>);
      // Eight stages, twenty passes or more, and several parts of the pairs.
      EXPECT_GE(count.asked, 8 + 20 + 2);
    }
  }
}

TYPED_TEST(SpaceMidwayTest, WorkIsTheSameWhoeverComputesAndWhoeverIsAsked) {
  using S = TypeParam;
  WorkerPool pool(3);
  std::vector<std::uint64_t> work;
  for (const bool watched : {false, true}) {
    for (TaskRunner* workers : {static_cast<TaskRunner*>(nullptr), static_cast<TaskRunner*>(&pool)}) {
      Space<S> space;
      space.setWorkers(workers, Sharing::always);
      if (watched) space.setInterrupt({[](void*) { return false; }, nullptr});
      for (std::uint64_t seed = 0; seed < 4; ++seed) fillAtRandom(space, seed);
      hashesOf(space, 60);
      work.push_back(space.work());
    }
  }
  EXPECT_GT(work[0], 1000u);
  EXPECT_THAT(work, ::testing::Each(work[0]));
}

TYPED_TEST(SpaceMidwayTest, ASpaceDoesNoMoreWorkThanItMay) {
  using S = TypeParam;
  Space<S> model, space;
  for (Space<S>* each : {&model, &space}) {
    fillAtRandom(*each, 5);
    hashesOf(*each, 10);
  }
  const SavedSpace<S> before = space.save();
  const std::uint64_t start = model.work();
  model.step(kTick<S>);
  const std::uint64_t ofStep = model.work() - start;
  ASSERT_GT(ofStep, 100u);

  space.setMaxWork(start + ofStep);
  space.step(kTick<S>);
  EXPECT_EQ(space.hash(), model.hash());
  const SavedSpace<S> after = space.save();
  EXPECT_THROW(space.step(kTick<S>), Interrupted);
  expectUnusable(space);
  space.restore(after);
  // The work left over is not enough.
  EXPECT_THROW(space.step(kTick<S>), Interrupted);
  EXPECT_TRUE(space.isUsable());
  EXPECT_EQ(space.hash(), model.hash());
  space.setMaxWork(~std::uint64_t{0});
  EXPECT_EQ(hashesOf(space, 5), hashesOf(model, 5));
}

// docs/formats.md, "From strangers". Nearly all pairs share bodies, so that each is alone in its block.
TYPED_TEST(SpaceMidwayTest, AStepDoesNoMoreWorkForAPairThanIsDocumented) {
  using S = TypeParam;
  constexpr int kPasses = 7;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    Space<S> space;
    space.setSolver(solver);
    space.setSubsteps(kPasses);
    space.setIterations(kPasses);
    for (int i = 0; i < 200; ++i) addBox<S>(space, {}, S(1), S(1), S(i % 2 == 0 ? 1000000 : 1));
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t before = space.work();
      space.step(kTick<S>);
      const std::uint64_t pairs = space.state().pairs.size();
      ASSERT_EQ(pairs, 200u * 199u / 2u);
      const std::uint64_t ofPasses = (solver == SolverKind::softStep ? 160 : 8) * kPasses;
      EXPECT_LE(space.work() - before, pairs * (100 + ofPasses)) << i;
      EXPECT_GE(space.work() - before, pairs * 32) << i;
    }
  }
}

TYPED_TEST(SpaceMidwayTest, TheRemovalOfABodyOfManyShapesIsInterrupted) {
  using S = TypeParam;
  Space<S> space;
  const BodyId body = space.add(Body<S>(S(1), S(1)));
  for (int i = 0; i < 5000; ++i) {
    space.add(circleShape<S>(body, ratio<S>(1, 8), {ratio<S>(i % 100, 2), ratio<S>(i / 100, 2)}));
  }
  const SavedSpace<S> before = space.save();
  const std::uint64_t hash = space.hash();
  int left = 3;
  space.setInterrupt({[](void* data) { return --*static_cast<int*>(data) == 0; }, &left});

  EXPECT_THROW(space.removeWithShapes(body), Interrupted);
  expectUnusable(space);
  space.setInterrupt({});
  space.restore(before);
  EXPECT_EQ(space.hash(), hash);
  space.removeWithShapes(body);
  EXPECT_EQ(space.shapeCount(), 0u);
}

}  // namespace
}  // namespace samestep
