// SPDX-License-Identifier: MIT
// Saved worlds continue as the original; forgetting the cache changes nothing.
#include <samestep/space.h>

#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

constexpr int kSteps = 60;
constexpr std::uint64_t kScenes = 6;

template <Scalar S>
class SpaceSaveTest : public ::testing::Test {
 public:
  /// A handler and functions that move things: they are wiring, so each Space registers them anew.
  static void wire(Space<S>& space) {
    CollisionHandler<S> handler;
    handler.preSolve = [](Arbiter<S>& arbiter, Space<S>&, void*) {
      arbiter.setFriction(ratio<S>(1, 2));
      return arbiter.shapeDataA().collisionType() != 2 || !arbiter.isFirstContact();
    };
    space.registerHandler(1, handler);
    space.registerVelocityFunc(1, [](Body<S>& body, const Vector<S>& gravity, S damping, S dt, void*) {
      body.updateVelocity(gravity * ratio<S>(1, 2), damping, dt);
    });
  }
  static void fill(Space<S>& space, std::uint64_t seed) {
    wire(space);
    space.addWildcardHandler(1, 1);
    space.addCollisionHandler(2, 0, 1);
    fillAtRandom(space, seed);
    space.setDamping(ratio<S>(15, 16));
    if (seed % 2 == 1) space.setSolver(SolverKind::softStep);
    Body<S> body(S(1), S(1));
    body.setVelocityFunc(1);
    space.add(circleShape(space.add(body), S(1)));
  }
  /// Plays what a game does between steps, by the number of the step: it adds, removes and pushes.
  static void play(Space<S>& space, int step) {
    if (step % 7 == 3) addDisc<S>(space, {S(step % 5), S(6)}, ratio<S>(1, 2), S(1));
    if (step % 11 == 5) {
      ShapeId victim{};
      space.eachShape([&](const Shape<S>& shape) {
        if (shape.body() != space.staticBody() && (!victim.valid() || shape.id().index % 5 == 2)) {
          victim = shape.id();
        }
      });
      if (victim.valid()) space.removeWithShapes(bodyOf(space, victim));
    }
    if (step % 5 == 0) {
      space.body(space.staticBody()).setPosition({ratio<S>(step % 3, 16), S(0)});
    }
  }
  static std::vector<std::uint64_t> run(Space<S>& space, int from, int to) {
    std::vector<std::uint64_t> hashes;
    for (int step = from; step < to; ++step) {
      play(space, step);
      space.step(kTick<S>);
      hashes.push_back(space.hash());
    }
    return hashes;
  }
};
TYPED_TEST_SUITE(SpaceSaveTest, AllScalars);

TYPED_TEST(SpaceSaveTest, RunTwiceGivesTheSameHashes) {
  for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
    Space<TypeParam> first, second;
    this->fill(first, seed);
    this->fill(second, seed);
    EXPECT_EQ(this->run(first, 0, 4 * kSteps), this->run(second, 0, 4 * kSteps));
  }
}

TYPED_TEST(SpaceSaveTest, RestoredAtEachTickItContinuesAsTheOriginal) {
  for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
    Space<TypeParam> original;
    this->fill(original, seed);
    std::vector<SavedSpace<TypeParam>> saved;
    std::vector<std::uint64_t> hashes;
    for (int step = 0; step < kSteps; ++step) {
      saved.push_back(original.save());
      EXPECT_EQ(saved.back().stamp(), static_cast<std::uint64_t>(step));
      hashes.push_back(this->run(original, step, step + 1)[0]);
    }
    Space<TypeParam> other;
    this->wire(other);
    fillAtRandom(other, seed + 77);  // The world that was there is gone after a restore.
    other.step(kTick<TypeParam>);
    for (int step = 0; step < kSteps; step += 1 + static_cast<int>(seed)) {
      Space<TypeParam>& into = step % 2 == 0 ? other : original;
      into.restore(saved[static_cast<std::size_t>(step)]);
      if (step % 3 == 0) into.dropCache();
      const std::vector<std::uint64_t> rest(hashes.begin() + step, hashes.end());
      ASSERT_EQ(this->run(into, step, kSteps), rest) << "scene " << seed << ", restored before step " << step;
    }
  }
}

TYPED_TEST(SpaceSaveTest, AStateAdoptedAtEachTickContinuesAsTheOriginal) {
  for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
    Space<TypeParam> original, adopting;
    this->fill(original, seed);
    this->wire(adopting);
    for (int step = 0; step < 3 * kSteps; ++step) {
      adopting.adopt(original.state());
      ASSERT_EQ(this->run(adopting, step, step + 1), this->run(original, step, step + 1))
          << "scene " << seed << ", step " << step;
    }
  }
}

// It holds what the Space had computed, by pointers into itself.
TYPED_TEST(SpaceSaveTest, CopiesOfASavedWorldOutliveItAndItsSpace) {
  using S = TypeParam;
  SavedSpace<S> kept, moved, assigned;
  std::vector<std::uint64_t> rest;
  {
    Space<S> space;
    this->fill(space, 3);
    this->run(space, 0, kSteps);
    SavedSpace<S> saved = space.save();
    kept = saved;
    SavedSpace<S> copy(saved);
    moved = std::move(copy);
    copy = saved;
    assigned = SavedSpace<S>(copy);
    EXPECT_EQ(assigned.bytes(), saved.bytes());
    EXPECT_GT(saved.bytes(), space.state().shapes.size() * sizeof(Shape<S>));
    EXPECT_EQ(saved.state().pairs.size(), space.state().pairs.size());
    rest = this->run(space, kSteps, 2 * kSteps);
  }
  Space<S> other;
  this->wire(other);
  for (const SavedSpace<S>* saved : {&kept, &moved, &assigned}) {
    other.restore(*saved);
    EXPECT_EQ(this->run(other, kSteps, 2 * kSteps), rest);
  }
}

TYPED_TEST(SpaceSaveTest, DroppingTheCacheAtEachTickChangesNothing) {
  for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
    Space<TypeParam> kept, dropped;
    this->fill(kept, seed);
    this->fill(dropped, seed);
    for (int step = 0; step < 3 * kSteps; ++step) {
      dropped.dropCache();
      ASSERT_EQ(this->run(dropped, step, step + 1), this->run(kept, step, step + 1))
          << "scene " << seed << ", step " << step;
    }
  }
}

TYPED_TEST(SpaceSaveTest, ResultsOfAStepComeOnlyWithTheNextOne) {
  using S = TypeParam;
  Space<S> space;
  space.setGravity({S(0), S(-10)});
  Shape<S> floor = segmentShape<S>(space.staticBody(), {S(-8), S(0)}, {S(8), S(0)});
  floor.setFriction(ratio<S>(1, 2));
  floor.setElasticity(ratio<S>(1, 2));
  space.add(floor);
  const ShapeId box = addBox<S>(space, {S(0), ratio<S>(1, 2)}, S(1), S(1), S(1));
  space.change(box, [](Shape<S>& shape) {
    shape.setFriction(ratio<S>(1, 4));
    shape.setElasticity(ratio<S>(1, 4));
  });
  for (int i = 0; i < 10; ++i) space.step(kTick<S>);
  const SavedSpace<S> saved = space.save();
  const auto seen = [](Space<S>& in) {
    Vector<S> impulse{};
    int visits = 0;
    in.eachArbiter([&](Arbiter<S>& arbiter) {
      ++visits;
      impulse = arbiter.totalImpulse();
      EXPECT_EQ(arbiter.friction(), ratio<S>(1, 8));
      EXPECT_EQ(arbiter.restitution(), ratio<S>(1, 8));
    });
    EXPECT_EQ(visits, 1);
    return impulse;
  };
  EXPECT_NE(seen(space), Vector<S>());
  space.step(kTick<S>);
  const Vector<S> next = seen(space);
  space.restore(saved);
  EXPECT_EQ(seen(space), Vector<S>());
  space.step(kTick<S>);
  EXPECT_EQ(seen(space), next);
}

// A handler that goes by what it is shown would else undo the promise that a restored world continues alike.
TYPED_TEST(SpaceSaveTest, CallbacksAreShownTheSameAfterARestore) {
  using S = TypeParam;
  using Shown = std::vector<std::tuple<char, S, S, Vector<S>>>;
  CollisionHandler<S> handler;
  const auto note = [](char what, const Arbiter<S>& arbiter, void* data) {
    static_cast<Shown*>(data)->emplace_back(what, arbiter.friction(), arbiter.restitution(),
                                            arbiter.totalImpulse());
  };
  static constexpr auto kNote = note;
  handler.begin = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
    kNote('b', arbiter, data);
    return true;
  };
  handler.preSolve = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
    kNote('p', arbiter, data);
    arbiter.setFriction(S(3));
    return true;
  };
  handler.postSolve = [](Arbiter<S>& arbiter, Space<S>&, void* data) { kNote('s', arbiter, data); };
  handler.separate = [](Arbiter<S>& arbiter, Space<S>&, void* data) { kNote('e', arbiter, data); };
  for (const SolverKind solver : {SolverKind::sequentialImpulses, SolverKind::softStep}) {
    Shown shown;
    handler.data = &shown;
    Space<S> space;
    space.setSolver(solver);
    space.registerHandler(1, handler);
    space.addDefaultCollisionHandler(1);
    fillAtRandom(space, 5);
    const auto play = [&] {
      shown.clear();
      for (int i = 0; i < 20; ++i) space.step(kTick<S>);
      return shown;
    };
    play();
    for (int round = 0; round < 6; ++round) {
      const SavedSpace<S> saved = space.save();
      const Shown first = play();
      space.restore(saved);
      EXPECT_EQ(play(), first) << round;
      EXPECT_FALSE(first.empty());
    }
  }
}

TYPED_TEST(SpaceSaveTest, WhatFollowsFromTheMassComesBackWhateverWasThere) {
  using S = TypeParam;
  Space<S> space;
  const BodyId turning = space.add(Body<S>(S(2), S(3)));
  const BodyId upright = space.add(Body<S>::nonRotating(S(5)));
  const BodyId free = space.add(Body<S>(S(1), S(1)));
  space.body(turning).setAngle(S(1));
  const SavedSpace<S> saved = space.save();
  const Body<S> before[] = {space.body(turning), space.body(upright), space.body(free)};
  space.body(turning).setMass(S(7));
  space.body(turning).setMoment(S(9));
  space.body(turning).setAngle(S(2));
  space.setType(upright, BodyType::kinematicBody);
  space.remove(free);
  Space<S> other;
  for (Space<S>* into : {&space, &other}) {
    into->restore(saved);
    for (const Body<S>& was : before) {
      const Body<S>& body = into->body(was.id());
      EXPECT_EQ(body.inverseMass(), was.inverseMass());
      EXPECT_EQ(body.inverseMoment(), was.inverseMoment());
      EXPECT_EQ(body.rotation(), was.rotation());
    }
  }
}

// The copy of what was computed does not hold where shapes were placed, but whether their body stands there.
TYPED_TEST(SpaceSaveTest, ABodyMovedByHandIsFoundWhereItIsAfterARestore) {
  using S = TypeParam;
  Space<S> space;
  const ShapeId moved = addDisc<S>(space, {}, S(1), S(1));
  const ShapeId still = addDisc<S>(space, {S(50), S(0)}, S(1), S(1));
  space.step(kTick<S>);
  space.body(bodyOf(space, moved)).setPosition({S(10), S(0)});
  const SavedSpace<S> saved = space.save();
  space.body(bodyOf(space, moved)).setPosition({S(20), S(0)});
  space.body(bodyOf(space, still)).setPosition({S(60), S(0)});
  space.step(kTick<S>);
  Space<S> other;
  std::vector<ShapeId> found;
  for (Space<S>* into : {&space, &other}) {
    into->restore(saved);
    into->boxQuery({S(9), S(-1), S(11), S(1)}, {}, found);
    EXPECT_EQ(found, std::vector<ShapeId>{moved});
    into->boxQuery({S(49), S(-1), S(51), S(1)}, {}, found);
    EXPECT_EQ(found, std::vector<ShapeId>{still});
    into->boxQuery({S(19), S(-1), S(21), S(1)}, {}, found);
    EXPECT_TRUE(found.empty());
  }
}

// Queries move trees about; they may not move anything else.
TYPED_TEST(SpaceSaveTest, AskingBetweenStepsChangesNothing) {
  using S = TypeParam;
  Space<S> quiet, asked;
  this->fill(quiet, 1);
  this->fill(asked, 1);
  std::vector<ShapeId> found;
  std::vector<PointHit<S>> hits;
  for (int step = 0; step < kSteps; ++step) {
    asked.boxQuery({S(-9), S(-9), S(9), S(9)}, {}, found);
    asked.pointQuery({}, S(3), {}, hits);
    asked.eachArbiter([](Arbiter<S>&) {});
    asked.reindexStatic();
    ASSERT_EQ(this->run(asked, step, step + 1), this->run(quiet, step, step + 1));
  }
}

TYPED_TEST(SpaceSaveTest, IdsMintedAfterARestoreAreTheSame) {
  using S = TypeParam;
  Space<S> space;
  std::vector<BodyId> ids;
  for (int i = 0; i < 6; ++i) ids.push_back(space.add(Body<S>(S(1), S(1))));
  for (const int gone : {4, 1, 3}) space.remove(ids[static_cast<std::size_t>(gone)]);
  const SavedSpace<S> saved = space.save();
  const auto mint = [](Space<S>& in) {
    std::vector<BodyId> minted;
    for (int i = 0; i < 5; ++i) minted.push_back(in.add(Body<S>(S(2), S(2))));
    return minted;
  };
  const std::vector<BodyId> first = mint(space);
  space.restore(saved);
  for (const BodyId later : first) EXPECT_FALSE(space.contains(later));
  for (const BodyId later : first) EXPECT_THROW(space.body(later), BodyNotFound);
  EXPECT_EQ(mint(space), first);
  Space<S> other;
  other.restore(saved);
  EXPECT_EQ(mint(other), first);
}

TYPED_TEST(SpaceSaveTest, ObjectsOfARestoredWorldBelongToTheSpaceThatRestoredIt) {
  using S = TypeParam;
  Space<S> space, other;
  const ShapeId disc = addDisc<S>(space, {}, S(1), S(1));
  other.restore(space.save());
  EXPECT_EQ(other.hash(), space.hash());
  EXPECT_THROW(other.add(other.shape(disc)), DuplicateShape);
  EXPECT_THROW(space.add(other.shape(disc)), DuplicateShape);
  EXPECT_THROW(other.add(other.body(bodyOf(other, disc))), DuplicateBody);
  EXPECT_THROW(space.add(other.body(bodyOf(other, disc))), DuplicateBody);
}

TYPED_TEST(SpaceSaveTest, RestoreRefusesWhatItHasNoFunctionsFor) {
  using S = TypeParam;
  Space<S> space;
  this->fill(space, 2);
  const SavedSpace<S> saved = space.save();
  Space<S> bare;
  addDisc<S>(bare, {}, S(1), S(1));
  expectRefused<MissingCallback>(bare, [&] { bare.restore(saved); });
  bare.registerHandler(1, {});
  expectRefused<MissingCallback>(bare, [&] { bare.restore(saved); });
  this->wire(bare);
  EXPECT_NO_THROW(bare.restore(saved));
  EXPECT_EQ(bare.hash(), space.hash());
}

TYPED_TEST(SpaceSaveTest, RestoringNothingIsRefused) {
  using S = TypeParam;
  Space<S> space;
  addDisc<S>(space, {}, S(1), S(1));
  expectRefused<ForeignWorld>(space, [&] { space.restore(SavedSpace<S>()); });
  expectRefused<ForeignWorld>(space, [&] { space.adopt(WorldState<S>()); });
}

TYPED_TEST(SpaceSaveTest, SavingReusesItsRoomAndSettingsComeBack) {
  using S = TypeParam;
  Space<S> space;
  space.setGravity({S(1), S(2)});
  space.setIterations(7);
  SavedSpace<S> saved;
  space.save(saved);
  space.setGravity({});
  space.setIterations(3);
  space.step(kTick<S>);
  space.restore(saved);
  EXPECT_EQ(space.gravity(), Vector<S>(S(1), S(2)));
  EXPECT_EQ(space.iterations(), 7);
  EXPECT_EQ(space.stamp(), 0u);
  EXPECT_EQ(space.currentTimeStep(), S(0));
  EXPECT_EQ(saved.state().settings.iterations, 7);
  space.adopt(space.state());
  EXPECT_EQ(space.iterations(), 7);
}

TYPED_TEST(SpaceSaveTest, RemovingAndAddingAgainIsReproduced) {
  using S = TypeParam;
  const auto churn = [](Space<S>& space) {
    fillAtRandom(space, 9);
    std::vector<std::uint64_t> hashes;
    for (int step = 0; step < kSteps; ++step) {
      std::vector<ShapeId> shapes;
      space.eachShape([&](const Shape<S>& shape) { shapes.push_back(shape.id()); });
      const ShapeId moved = shapes[static_cast<std::size_t>(step) % shapes.size()];
      const Shape<S> copy = space.shape(moved).detached();
      space.remove(moved);
      space.add(copy);
      space.step(kTick<S>);
      hashes.push_back(space.hash());
    }
    return hashes;
  };
  Space<S> first, second;
  EXPECT_EQ(churn(first), churn(second));
}

}  // namespace
}  // namespace samestep
