// SPDX-License-Identifier: MIT
// How many pairs a Space may hold.
#include <samestep/space.h>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <class S>
class SpacePairsTest : public ::testing::Test {
 protected:
  static constexpr auto kStep = ratio<S>(1, 60);

  /// Discs, each of which touches all others.
  static void addHeap(Space<S>& space, int discs) {
    for (int i = 0; i < discs; ++i) {
      addDisc(space, {ratio<S>(i, 10), S(i % 2)}, S(2), S(1), {S(i), S(0)});
    }
  }
};
TYPED_TEST_SUITE(SpacePairsTest, AllScalarsAndChecked);

TYPED_TEST(SpacePairsTest, AStepThatFindsMoreIsRefusedBeforeAnythingChanges) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    Space<S> space, free;
    for (Space<S>* each : {&space, &free}) {
      each->setSolver(solver);
      this->addHeap(*each, 2);
      each->step(this->kStep);
      this->addHeap(*each, 4);
    }
    EXPECT_EQ(space.maxPairs(), kDefaultMaxPairs);
    const std::uint64_t before = space.hash();

    space.setMaxPairs(14);  // of six discs there are 15
    for (int i = 0; i < 2; ++i) {
      EXPECT_THROW(space.step(this->kStep), TooManyPairs);
      EXPECT_EQ(space.hash(), before);
      EXPECT_FALSE(space.isLocked());
    }
    space.setMaxPairs(15);
    for (int i = 0; i < 10; ++i) {
      space.step(this->kStep);
      free.step(this->kStep);
      EXPECT_EQ(space.hash(), free.hash()) << i;
    }
  }
}

// Shapes are asked about where their bodies are.
TYPED_TEST(SpacePairsTest, AfterARefusalQueriesFindWhatIsThere) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    Space<S> space;
    space.setSolver(solver);
    const ShapeId fast = addDisc<S>(space, {}, S(1), S(1), {S(600), S(0)});
    // Sequential impulses move bodies before they look for pairs.
    addDisc<S>(space, {solver == SolverKind::softStep ? ratio<S>(3, 2) : S(10), S(0)}, S(1), S(1));
    space.setMaxPairs(0);
    EXPECT_THROW(space.step(this->kStep), TooManyPairs);

    std::vector<PointHit<S>> hits;
    space.pointQuery({ratio<S>(-1, 2), S(0)}, S(0), ShapeFilter(), hits);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_EQ(hits[0].shape, fast);
  }
}

TYPED_TEST(SpacePairsTest, ShapesThatAreNoPairsAreLookedAtEightTimesAsOften) {
  using S = TypeParam;
  Space<S> space;
  space.setMaxPairs(1);
  const BodyId body = space.add(Body<S>(S(1), S(1)));
  for (int i = 0; i < 4; ++i) space.add(circleShape<S>(body, S(1)));
  space.step(this->kStep);  // six of them are near each other
  EXPECT_TRUE(space.state().pairs.empty());

  space.add(circleShape<S>(body, S(1)));
  EXPECT_THROW(space.step(this->kStep), TooManyPairs);  // ten
  space.setMaxPairs(2);
  space.step(this->kStep);
}

// Boxes of what moves fast are given room to move in, in some worlds more than in others of the same state.
TYPED_TEST(SpacePairsTest, WhatTheTreeRemembersRefusesNothing) {
  using S = TypeParam;
  Space<S> space;
  space.setMaxPairs(1);
  for (int i = 0; i < 6; ++i) addDisc<S>(space, {S(3 * i), S(0)}, S(1), S(1), {S(200), S(0)});
  for (int i = 0; i < 30; ++i) space.step(this->kStep);
  EXPECT_TRUE(space.state().pairs.empty());
  const SavedSpace<S> saved = space.save();

  Space<S> slow;
  slow.setMaxPairs(1);
  slow.restore(saved);
  for (Space<S>* each : {&space, &slow}) {
    each->eachBody([&](const Body<S>& body) {
      if (body.isDynamic()) each->body(body.id()).setVelocity({});
    });
  }
  slow.dropCache();
  for (int i = 0; i < 3; ++i) {
    space.step(this->kStep);
    slow.step(this->kStep);
    EXPECT_EQ(space.hash(), slow.hash());
  }
}

TYPED_TEST(SpacePairsTest, TheLimitIsWiringAndHasOneOfItsOwn) {
  using S = TypeParam;
  Space<S> space;
  const SavedSpace<S> saved = space.save();
  space.setMaxPairs(0);
  space.restore(saved);
  EXPECT_EQ(space.maxPairs(), 0u);
  this->addHeap(space, 1);
  space.step(this->kStep);
  EXPECT_THROW(space.setMaxPairs(kMostPairs + 1), ValueOutOfRange);
  EXPECT_EQ(space.maxPairs(), 0u);
  space.setMaxPairs(kMostPairs);
  space.lock();
  EXPECT_THROW(space.setMaxPairs(1), SpaceLocked);
  space.unlock(true);
}

}  // namespace
}  // namespace samestep
