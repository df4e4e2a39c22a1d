// SPDX-License-Identifier: MIT
// Whose an id is, and what becomes of ids where an earlier world is brought back.
#include <samestep/circle_shape.h>
#include <samestep/snapshot.h>
#include <samestep/space.h>

#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <class S>
class IdsTest : public ::testing::Test {
 protected:
  /// Two worlds with the same slots and generations.
  IdsTest() {
    for (Space<S>* space : {&space_, &other_}) addDisc<S>(*space, {}, S(1), S(1));
  }
  static std::vector<std::uint8_t> snapshotOf(const Space<S>& space) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(saveSnapshot(space, {})));
    saveSnapshot(space, bytes);
    return bytes;
  }
  static BodyId bodyOf(const Space<S>& space) { return space.state().bodies.idAt(1); }
  static ShapeId shapeOf(const Space<S>& space) { return space.state().shapes.idAt(0); }

  Space<S> space_, other_;
};
TYPED_TEST_SUITE(IdsTest, AllScalarsAndChecked);

TYPED_TEST(IdsTest, AnIdOfAnotherSpaceIsRefusedThoughItsSlotIsInUse) {
  using S = TypeParam;
  auto &space = this->space_, &other = this->other_;
  const BodyId body = this->bodyOf(other);
  const ShapeId shape = this->shapeOf(other);
  ASSERT_EQ(body, this->bodyOf(space));
  EXPECT_FALSE(space.contains(body));
  EXPECT_FALSE(space.contains(shape));
  EXPECT_TRUE(other.contains(body));
  expectRefused<BodyNotFound>(space, [&] { space.body(body); });
  expectRefused<BodyNotFound>(space, [&] { space.remove(body); });
  expectRefused<BodyNotFound>(space, [&] { space.removeWithShapes(body); });
  expectRefused<BodyNotFound>(space, [&] { space.setType(body, BodyType::staticBody); });
  expectRefused<BodyNotFound>(space, [&] { space.accumulateMassFromShapes(body); });
  expectRefused<BodyNotFound>(space, [&] { space.add(circleShape<S>(body, S(1))); });
  expectRefused<BodyNotFound>(space, [&] { space.add(circleShape<S>(other.staticBody(), S(1))); });
  expectRefused<BodyNotFound>(space, [&] { space.add(other.shape(shape).detached()); });
  expectRefused<BodyNotFound>(space, [&] { space.eachArbiter(body, [](Arbiter<S>&) {}); });
  expectRefused<BodyNotFound>(space, [&] { space.filterArbiters(body, {}); });
  expectRefused<BodyNotFound>(space, [&] { space.hash(body); });
  expectRefused<ShapeNotFound>(space, [&] { space.shape(shape); });
  expectRefused<ShapeNotFound>(space, [&] { space.remove(shape); });
  expectRefused<ShapeNotFound>(space, [&] { space.replace(shape, circleShape<S>({}, S(1))); });
  expectRefused<ShapeNotFound>(space, [&] { space.boundingBox(shape); });
  expectRefused<ShapeNotFound>(space, [&] { space.reindexShape(shape); });
  try {
    space.body(body);
    ADD_FAILURE();
  } catch (const BodyNotFound& error) {
    EXPECT_STREQ(error.what(), "Space::body: id 1 (generation 1) is of another Space");
  }
}

TYPED_TEST(IdsTest, WhatASpaceGivesOutIsItsOwn) {
  using S = TypeParam;
  auto &space = this->space_, &other = this->other_;
  const BodyId given = other.add(Body<S>(S(1), S(1)), BodyId{7, 1});
  const ShapeId givenShape = other.add(circleShape<S>(given, S(1)), ShapeId{9, 1});
  other.remove(givenShape);
  EXPECT_EQ(given.space, other.staticBody().space);
  EXPECT_EQ(givenShape.space, given.space);
  EXPECT_FALSE(space.contains(other.staticBody()));
  other.eachBody([&](const Body<S>& body) { EXPECT_FALSE(space.contains(body.id())); });
  other.eachShape([&](const Shape<S>& shape) {
    EXPECT_FALSE(space.contains(shape.id()));
    EXPECT_FALSE(space.contains(shape.body()));
  });
  addDisc<S>(other, {S(1), S(0)}, S(1), S(1));
  other.step(kTick<S>);
  int seen = 0;
  other.eachArbiter([&](Arbiter<S>& arbiter) {
    for (const ShapeId id : {arbiter.shapeA(), arbiter.shapeB()}) EXPECT_FALSE(space.contains(id));
    for (const BodyId id : {arbiter.bodyA(), arbiter.bodyB()}) EXPECT_FALSE(space.contains(id));
    ++seen;
  });
  EXPECT_EQ(seen, 1);
  std::vector<PointHit<S>> hits;
  other.pointQuery({}, S(0), {}, hits);
  ASSERT_FALSE(hits.empty());
  EXPECT_FALSE(space.contains(hits[0].shape));
}

TYPED_TEST(IdsTest, BitsNameTheSameSlotInEverySpace) {
  auto &space = this->space_, &other = this->other_;
  const BodyId body = BodyId::fromBits(this->bodyOf(other).bits());
  EXPECT_EQ(body, this->bodyOf(other));
  EXPECT_EQ(body.space, 0u);
  EXPECT_TRUE(space.contains(body));
  EXPECT_TRUE(other.contains(body));
  EXPECT_EQ((BodyId{5, 7}.bits()), (std::uint64_t{7} << 32 | 5u));
  EXPECT_FALSE(BodyId::fromBits(BodyId().bits()).valid());
  EXPECT_TRUE(space.contains(this->bodyOf(other).anywhere()));
}

// It is the world whose objects they name, also where another Space goes on with it.
TYPED_TEST(IdsTest, IdsGoWithTheWorldThatIsRestored) {
  using S = TypeParam;
  auto &space = this->space_, &other = this->other_;
  const BodyId own = this->bodyOf(space), others = this->bodyOf(other);
  const SavedSpace<S> saved = other.save();
  space.restore(saved);
  EXPECT_TRUE(space.contains(others));
  EXPECT_TRUE(space.contains(this->shapeOf(other)));
  EXPECT_FALSE(space.contains(own));
  EXPECT_EQ(space.hash(), other.hash());
  other.restore(saved);
  EXPECT_TRUE(other.contains(others));
}

TYPED_TEST(IdsTest, AWorldOutOfBytesIsThatOfTheSpaceThatReadsIt) {
  using S = TypeParam;
  auto &space = this->space_, &other = this->other_;
  const BodyId own = this->bodyOf(space);
  loadSnapshot<S>(space, this->snapshotOf(other));
  EXPECT_TRUE(space.contains(own));
  EXPECT_FALSE(space.contains(this->bodyOf(other)));
  EXPECT_TRUE(space.contains(space.staticBody()));
  EXPECT_FALSE(other.contains(space.staticBody()));
  EXPECT_EQ(space.shape(this->shapeOf(space)).body().space, own.space);
}

TYPED_TEST(IdsTest, WhoseAnIdIsReachesNeitherHashNorBytes) {
  auto &space = this->space_, &other = this->other_;
  ASSERT_NE(this->bodyOf(space).space, this->bodyOf(other).space);
  EXPECT_EQ(space.hash(), other.hash());
  EXPECT_EQ(space.hash(this->bodyOf(space)), other.hash(this->bodyOf(other)));
  EXPECT_EQ(space.hash(this->shapeOf(space)), other.hash(this->shapeOf(other)));
  EXPECT_EQ(this->snapshotOf(space), this->snapshotOf(other));
}

// An id of what never came to be: the game sees by worldsBroughtIn that it must look.
TYPED_TEST(IdsTest, AfterARestoreAnIdOfTheDroppedFutureNamesWhatCameInstead) {
  using S = TypeParam;
  auto& space = this->space_;
  const SavedSpace<S> saved = space.save();
  const std::uint64_t before = space.worldsBroughtIn();
  const BodyId dropped = space.add(Body<S>(S(1), S(1)));
  EXPECT_EQ(space.worldsBroughtIn(), before);
  space.restore(saved);
  EXPECT_EQ(space.worldsBroughtIn(), before + 1);
  EXPECT_FALSE(space.contains(dropped));
  const BodyId instead = space.add(Body<S>(S(2), S(2)));
  EXPECT_EQ(dropped, instead);
  loadSnapshot<S>(space, this->snapshotOf(space));
  EXPECT_EQ(space.worldsBroughtIn(), before + 2);
  EXPECT_THROW(space.restore(SavedSpace<S>()), ForeignWorld);
  EXPECT_EQ(space.worldsBroughtIn(), before + 2);
}

}  // namespace
}  // namespace samestep
