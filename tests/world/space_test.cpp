// SPDX-License-Identifier: MIT
#include <samestep/snapshot.h>
#include <samestep/space.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class SpaceTest : public ::testing::Test {
 protected:
  using V = Vector<S>;

  /// Numbers that no setter may take.
  static std::vector<S> wild() {
    std::vector<S> values = {std::numeric_limits<S>::max(), std::numeric_limits<S>::lowest()};
    if constexpr (std::numeric_limits<S>::has_infinity) {
      values.push_back(std::numeric_limits<S>::infinity());
      values.push_back(-std::numeric_limits<S>::infinity());
      values.push_back(std::numeric_limits<S>::quiet_NaN());
    }
    return values;
  }

  Space<S> space_;
};
TYPED_TEST_SUITE(SpaceTest, AllScalarsAndChecked);

TYPED_TEST(SpaceTest, NewSpaceHasOneStaticBodyAndTheDefaultsOfTheSpecification) {
  using S = TypeParam;
  auto& space = this->space_;
  EXPECT_EQ(space.bodyCount(), 1u);
  EXPECT_EQ(space.shapeCount(), 0u);
  ASSERT_TRUE(space.contains(space.staticBody()));
  EXPECT_EQ(space.body(space.staticBody()).type(), BodyType::staticBody);
  EXPECT_EQ(space.iterations(), 10);
  EXPECT_EQ(space.gravity(), Vector<S>());
  EXPECT_EQ(space.damping(), S(1));
  EXPECT_EQ(space.collisionPersistence(), 3u);
  EXPECT_EQ(space.worldExtent(), S(1 << 15));
  EXPECT_EQ(space.currentTimeStep(), S(0));
  EXPECT_EQ(space.stamp(), 0u);
  EXPECT_FALSE(space.isLocked());
  EXPECT_TRUE(space.rangeEvents().empty());
}

TYPED_TEST(SpaceTest, SettingsAreKept) {
  using S = TypeParam;
  auto& space = this->space_;
  space.setIterations(25);
  space.setGravity({S(1), S(-2)});
  space.setDamping(ratio<S>(1, 2));
  space.setCollisionSlop(ratio<S>(1, 4));
  space.setCollisionBias(ratio<S>(1, 8));
  space.setCollisionPersistence(7);
  space.setWorldExtent(S(100));

  EXPECT_EQ(space.iterations(), 25);
  EXPECT_EQ(space.gravity(), Vector<S>(S(1), S(-2)));
  EXPECT_EQ(space.damping(), ratio<S>(1, 2));
  EXPECT_EQ(space.collisionSlop(), ratio<S>(1, 4));
  EXPECT_EQ(space.collisionBias(), ratio<S>(1, 8));
  EXPECT_EQ(space.collisionPersistence(), 7u);
  EXPECT_EQ(space.worldExtent(), S(100));
}

TYPED_TEST(SpaceTest, SettingsOutOfRangeAreRefused) {
  using S = TypeParam;
  auto& space = this->space_;
  const S more = ratio<S>(1, 1024);
  for (const int bad : {0, -1, 1001, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
    expectRefused<InvalidIter>(space, [&] { space.setIterations(bad); });
  }
  for (const S bad : this->wild()) {
    expectRefused<ValueOutOfRange>(space, [&] { space.setGravity({bad, S(0)}); });
    expectRefused<ValueOutOfRange>(space, [&] { space.setGravity({S(0), bad}); });
    expectRefused<ValueOutOfRange>(space, [&] { space.setDamping(bad); });
    expectRefused<ValueOutOfRange>(space, [&] { space.setCollisionSlop(bad); });
    expectRefused<ValueOutOfRange>(space, [&] { space.setCollisionBias(bad); });
    expectRefused<ValueOutOfRange>(space, [&] { space.setWorldExtent(bad); });
    expectRefused<ValueOutOfRange>(space, [&] { space.step(bad); });
  }
  expectRefused<ValueOutOfRange>(space, [&] { space.setGravity({kMaxAcceleration<S> + more, S(0)}); });
  expectRefused<ValueOutOfRange>(space, [&] { space.setDamping(S(1) + more); });
  expectRefused<ValueOutOfRange>(space, [&] { space.setDamping(-more); });
  expectRefused<ValueOutOfRange>(space, [&] { space.setCollisionSlop(-more); });
  expectRefused<ValueOutOfRange>(space, [&] { space.setCollisionBias(S(1) + more); });
  expectRefused<ValueOutOfRange>(space, [&] { space.setWorldExtent(S(0)); });
  expectRefused<ValueOutOfRange>(space, [&] { space.setWorldExtent(kMaxWorldExtent<S> + more); });
  expectRefused<ValueOutOfRange>(space, [&] { space.step(S(1) + more); });
  expectRefused<ValueOutOfRange>(space, [&] { space.step(-more); });
}

// Bodies.

TYPED_TEST(SpaceTest, AddedBodyIsACopyWithAnId) {
  using S = TypeParam;
  auto& space = this->space_;
  Body<S> body(S(2), S(3));
  body.setPosition({S(4), S(5)});

  const BodyId id = space.add(body);
  body.setPosition({S(0), S(0)});

  EXPECT_TRUE(id.valid());
  EXPECT_TRUE(space.contains(id));
  EXPECT_EQ(space.body(id).id(), id);
  EXPECT_EQ(space.body(id).position(), Vector<S>(S(4), S(5)));
  EXPECT_FALSE(body.id().valid());
}

TYPED_TEST(SpaceTest, BodyOfThisSpaceIsADuplicateOfAnotherAttached) {
  using S = TypeParam;
  auto& space = this->space_;
  Space<S> other;
  const BodyId here = space.add(Body<S>(S(1), S(1)));
  const BodyId there = other.add(Body<S>(S(1), S(1)));

  expectRefused<DuplicateBody>(space, [&] { space.add(space.body(here)); });
  expectRefused<AttachedBody>(space, [&] { space.add(other.body(there)); });
  EXPECT_NO_THROW(space.add(other.body(there).detached()));
  EXPECT_EQ(space.bodyCount(), 3u);
}

TYPED_TEST(SpaceTest, BodyOutsideTheWorldIsNotTakenIn) {
  using S = TypeParam;
  auto& space = this->space_;
  space.setWorldExtent(S(10));
  Body<S> body(S(1), S(1));
  body.setPosition({S(11), S(0)});
  expectRefused<IllegalBody>(space, [&] { space.add(body); });
  body.setPosition({S(-10), S(10)});
  EXPECT_NO_THROW(space.add(body));
}

TYPED_TEST(SpaceTest, StaleIdsNameNothing) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId first = space.add(Body<S>(S(1), S(1)));
  const ShapeId shape = space.add(circleShape(first, S(1)));
  space.remove(shape);
  space.remove(first);
  const BodyId second = space.add(Body<S>(S(1), S(1)));
  const ShapeId next = space.add(circleShape(second, S(1)));
  ASSERT_EQ(second.index, first.index);
  ASSERT_EQ(next.index, shape.index);

  EXPECT_FALSE(space.contains(first));
  EXPECT_FALSE(space.contains(shape));
  EXPECT_FALSE(space.contains(BodyId{}));
  EXPECT_FALSE(space.contains(ShapeId{}));
  for (const BodyId stale : {first, BodyId{}, BodyId{1000000, 1}, BodyId{second.index, 0}}) {
    expectRefused<BodyNotFound>(space, [&] { space.body(stale); });
    expectRefused<BodyNotFound>(space, [&] { std::as_const(space).body(stale); });
    expectRefused<BodyNotFound>(space, [&] { space.remove(stale); });
    expectRefused<BodyNotFound>(space, [&] { space.removeWithShapes(stale); });
    expectRefused<BodyNotFound>(space, [&] { space.setType(stale, BodyType::staticBody); });
    expectRefused<BodyNotFound>(space, [&] { space.accumulateMassFromShapes(stale); });
    expectRefused<BodyNotFound>(space, [&] { space.add(circleShape(stale, S(1))); });
    expectRefused<BodyNotFound>(space, [&] { space.reindexShapesForBody(stale); });
    expectRefused<BodyNotFound>(space, [&] { space.filterArbiters(stale); });
    expectRefused<BodyNotFound>(space, [&] { space.eachShape(stale, [](const Shape<S>&) {}); });
    expectRefused<BodyNotFound>(space, [&] { space.eachArbiter(stale, [](Arbiter<S>&) {}); });
    expectRefused<BodyNotFound>(space, [&] { space.hash(stale); });
  }
  for (const ShapeId stale : {shape, ShapeId{}, ShapeId{1000000, 1}, ShapeId{next.index, 0}}) {
    expectRefused<ShapeNotFound>(space, [&] { space.shape(stale); });
    expectRefused<ShapeNotFound>(space, [&] { space.remove(stale); });
    expectRefused<ShapeNotFound>(space, [&] { space.replace(stale, circleShape(second, S(1))); });
    expectRefused<ShapeNotFound>(space, [&] { space.change(stale, [](Shape<S>&) {}); });
    expectRefused<ShapeNotFound>(space, [&] { space.reindexShape(stale); });
    expectRefused<ShapeNotFound>(space, [&] { space.boundingBox(stale); });
    expectRefused<ShapeNotFound>(space, [&] { space.hash(stale); });
    if (stale.valid()) expectRefused<ShapeNotFound>(space, [&] { space.filterArbiters(second, stale); });
  }
}

TYPED_TEST(SpaceTest, BodiesLeaveEmptyAndNeverTheDesignatedOne) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId id = space.add(Body<S>(S(1), S(1)));
  space.add(circleShape(id, S(1)));
  space.add(circleShape(id, S(2)));
  expectRefused<BodyHasShapes>(space, [&] { space.remove(id); });
  expectRefused<MainStaticBody>(space, [&] { space.remove(space.staticBody()); });
  expectRefused<MainStaticBody>(space, [&] { space.removeWithShapes(space.staticBody()); });

  space.removeWithShapes(id);

  EXPECT_FALSE(space.contains(id));
  EXPECT_EQ(space.shapeCount(), 0u);
  EXPECT_EQ(space.bodyCount(), 1u);
}

TYPED_TEST(SpaceTest, AFrictionThatChangesInEveryStepIsThatOfItsShapeAloneAndTakesNoMemory) {
  using S = TypeParam;
  Space<S> space;
  space.setGravity({S(0), S(-10)});
  const ShapeId floor = addWall<S>(space, {S(-20), S(0)}, {S(20), S(0)});
  space.change(floor, [](Shape<S>& shape) { shape.setFriction(S(1)); });
  std::vector<ShapeId> boxes;
  for (int i = 0; i < 3; ++i) {
    boxes.push_back(addBox<S>(space, {S(4 * i), ratio<S>(1, 2)}, S(1), S(1), S(1)));
    space.change(boxes.back(), [](Shape<S>& shape) { shape.setFriction(ratio<S>(1, 2)); });
  }
  std::uint64_t bytes = 0;
  for (int step = 0; step < 400; ++step) {
    const S friction = ratio<S>(step, 400);
    space.change(boxes[1], [&](Shape<S>& shape) { shape.setFriction(friction); });
    space.step(kTick<S>);
    ASSERT_EQ(space.state().pairs.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(space.state().pairs[i].friction, i == 1 ? friction : ratio<S>(1, 2));
    }
    if (step == 200) bytes = space.save().bytes();
  }
  EXPECT_LE(space.save().bytes(), bytes + bytes / 2);
}

TYPED_TEST(SpaceTest, AShapeThatChangesOrGoesLeavesItsEqualsAsTheyAre) {
  using S = TypeParam;
  Space<S> space;
  std::vector<ShapeId> boxes;
  for (int i = 0; i < 4; ++i) boxes.push_back(addBox<S>(space, {S(4 * i), S(0)}, S(1), S(1), S(1)));
  const auto boxAt = [](int i, int half) {
    return BB<S>(S(4 * i - half), S(-half), S(4 * i + half), S(half));
  };
  const auto halfBoxAt = [](int i) {
    const S half = ratio<S>(1, 2);
    return BB<S>(S(4 * i) - half, -half, S(4 * i) + half, half);
  };
  for (int i = 0; i < 4; ++i) ASSERT_EQ(space.boundingBox(boxes[static_cast<std::size_t>(i)]), halfBoxAt(i));

  Shape<S> larger = boxShape<S>(space.shape(boxes[0]).body(), S(2), S(2));
  larger.setMass(S(1));
  space.replace(boxes[0], larger);
  EXPECT_EQ(space.boundingBox(boxes[0]), boxAt(0, 1));
  for (int i = 1; i < 4; ++i) EXPECT_EQ(space.boundingBox(boxes[static_cast<std::size_t>(i)]), halfBoxAt(i));
  space.removeWithShapes(bodyOf(space, boxes[1]));
  boxes[1] = addBox<S>(space, {S(4), S(0)}, S(2), S(2), S(1));
  space.replace(boxes[2], larger);
  space.step(kTick<S>);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(space.boundingBox(boxes[static_cast<std::size_t>(i)]), boxAt(i, 1));
  EXPECT_EQ(space.boundingBox(boxes[3]), halfBoxAt(3));
}

TYPED_TEST(SpaceTest, StaticBodyIsReplacedWhenItHasNoShapes) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId before = space.staticBody();
  const ShapeId wall = addWall<S>(space, {S(0), S(0)}, {S(1), S(0)});
  expectRefused<AttachedStaticBody>(space, [&] { space.setStaticBody(Body<S>::fixedInPlace()); });
  space.remove(wall);
  expectRefused<IllegalBody>(space, [&] { space.setStaticBody(Body<S>(S(1), S(1))); });
  expectRefused<IllegalBody>(space, [&] { space.setStaticBody(Body<S>::kinematic()); });
  Space<S> other;
  expectRefused<AttachedBody>(space, [&] { space.setStaticBody(other.body(other.staticBody())); });
  expectRefused<DuplicateBody>(space, [&] { space.setStaticBody(space.body(space.staticBody())); });

  Body<S> body = Body<S>::fixedInPlace();
  body.setPosition({S(5), S(0)});
  const BodyId after = space.setStaticBody(body);

  EXPECT_EQ(space.staticBody(), after);
  EXPECT_FALSE(space.contains(before));
  EXPECT_EQ(space.bodyCount(), 1u);
  EXPECT_EQ(space.body(after).position(), Vector<S>(S(5), S(0)));
}

// Shapes.

TYPED_TEST(SpaceTest, ShapeOfThisSpaceIsADuplicateOfAnotherAttached) {
  using S = TypeParam;
  auto& space = this->space_;
  Space<S> other;
  const ShapeId here = addDisc<S>(space, {}, S(1), S(1));
  const ShapeId there = addDisc<S>(other, {}, S(1), S(1));

  expectRefused<DuplicateShape>(space, [&] { space.add(space.shape(here)); });
  expectRefused<AttachedShape>(space, [&] { space.add(other.shape(there)); });
  Shape<S> free = other.shape(there).detached();
  free.setBody(space.shape(here).body());
  EXPECT_NO_THROW(space.add(free));
}

TYPED_TEST(SpaceTest, ShapesOfMovingBodiesAreHeldToTheDynamicExtent) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId dynamic = space.add(Body<S>(S(1), S(1)));
  const BodyId kinematic = space.add(Body<S>::kinematic());
  const BodyId resting = space.add(Body<S>::fixedInPlace());
  const auto large = [](BodyId id) { return circleShape(id, S(kMaxDynamicExtent) + S(1)); };

  expectRefused<SizeOutOfRange>(space, [&] { space.add(large(dynamic)); });
  expectRefused<SizeOutOfRange>(space, [&] { space.add(large(kinematic)); });
  const ShapeId id = space.add(large(resting));
  expectRefused<SizeOutOfRange>(space, [&] { space.setType(resting, BodyType::dynamicBody); });
  expectRefused<SizeOutOfRange>(space, [&] { space.setType(resting, BodyType::kinematicBody); });
  space.remove(id);
  const ShapeId small = space.add(circleShape(dynamic, S(1)));
  expectRefused<SizeOutOfRange>(space, [&] {
    space.change(small,
                 [](Shape<S>& shape) { CircleShape<S>(shape).setRadius(S(kMaxDynamicExtent) + S(1)); });
  });
}

TYPED_TEST(SpaceTest, MassComesFromTheShapes) {
  using S = TypeParam;
  auto& space = this->space_;
  Body<S> body;
  body.setPosition({S(10), S(20)});
  const BodyId id = space.add(body);

  // Two boxes of 2 m by 2 m, 3 kg and 1 kg, with centres at (0, 0) and (4, 0).
  Shape<S> left = boxShape(id, S(2), S(2));
  left.setMass(S(3));
  const ShapeId leftId = space.add(left);
  EXPECT_EQ(space.body(id).mass(), S(3));
  EXPECT_NEAR(double(space.body(id).moment()), 2, 1e-9);
  Shape<S> right = boxShape(id, BB<S>(S(3), S(-1), S(5), S(1)));
  right.setMass(S(1));
  const ShapeId rightId = space.add(right);

  EXPECT_EQ(space.body(id).mass(), S(4));
  EXPECT_EQ(space.body(id).centerOfMass(), Vector<S>(S(1), S(0)));
  EXPECT_EQ(space.body(id).position(), Vector<S>(S(10), S(20)));
  EXPECT_EQ(space.body(id).worldCenter(), Vector<S>(S(11), S(20)));
  // 2 + 2/3 about the boxes' own centres, and 3 * 1^2 + 1 * 3^2 for their places.
  const double moment = 2 + 2.0 / 3 + 12;
  EXPECT_NEAR(double(space.body(id).moment()), moment, 1e-9);

  space.remove(leftId);
  EXPECT_EQ(space.body(id).mass(), S(1));
  EXPECT_EQ(space.body(id).centerOfMass(), Vector<S>(S(4), S(0)));
  EXPECT_NEAR(double(space.body(id).moment()), 2.0 / 3, 1e-9);

  space.change(rightId, [](Shape<S>& shape) { shape.setMass(S(6)); });
  EXPECT_EQ(space.body(id).mass(), S(6));
  EXPECT_NEAR(double(space.body(id).moment()), 4, 1e-9);
  EXPECT_EQ(space.body(id).position(), Vector<S>(S(10), S(20)));

  space.remove(rightId);
  EXPECT_EQ(space.body(id).mass(), S(0));
  EXPECT_EQ(space.body(id).moment(), S(0));
  EXPECT_EQ(space.body(id).centerOfMass(), Vector<S>());
  EXPECT_EQ(space.body(id).position(), Vector<S>(S(10), S(20)));
}

TYPED_TEST(SpaceTest, MassOfShapesDoesNotDependOnMasslessOnes) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId id = space.add(Body<S>(S(5), S(7)));

  const ShapeId shape = space.add(circleShape(id, S(2)));
  EXPECT_EQ(space.body(id).mass(), S(5));
  EXPECT_EQ(space.body(id).moment(), S(7));
  space.change(shape, [](Shape<S>& s) { s.setFriction(S(1)); });
  space.remove(shape);
  EXPECT_EQ(space.body(id).mass(), S(5));

  space.accumulateMassFromShapes(id);
  EXPECT_EQ(space.body(id).mass(), S(0));
}

TYPED_TEST(SpaceTest, MassBeyondTheRangeIsRefusedAndNothingChanges) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId id = space.add(Body<S>());
  Shape<S> shape = circleShape(id, S(1));
  shape.setMass(S(600000));
  const ShapeId first = space.add(shape);

  expectRefused<IllegalBody>(space, [&] { space.add(shape); });
  EXPECT_EQ(space.shapeCount(), 1u);
  shape.setMass(S(400000));
  space.add(shape);
  expectRefused<IllegalBody>(space, [&] { space.change(first, [](Shape<S>& s) { s.setMass(S(700000)); }); });
  EXPECT_EQ(space.body(id).mass(), S(1000000));

  const BodyId kinematic = space.add(Body<S>::kinematic());
  Shape<S> heavy = circleShape(kinematic, S(1));
  heavy.setMass(S(1000000));
  space.add(heavy);
  space.add(heavy);
  expectRefused<IllegalBody>(space, [&] { space.setType(kinematic, BodyType::dynamicBody); });
}

TYPED_TEST(SpaceTest, NonRotatingBodyStaysSoWithMassFromItsShapes) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId id = space.add(Body<S>::nonRotating(S(1)));
  Shape<S> shape = circleShape(id, S(1), {S(1), S(0)});
  shape.setMass(S(4));
  space.add(shape);

  EXPECT_EQ(space.body(id).mass(), S(4));
  EXPECT_FALSE(space.body(id).rotates());
  EXPECT_EQ(space.body(id).inverseMoment(), Scaled<S>{});
  EXPECT_NO_THROW(space.step(kTick<S>));
}

TYPED_TEST(SpaceTest, ChangeKeepsIdAndBodyAndIsAllOrNothing) {
  using S = TypeParam;
  auto& space = this->space_;
  const ShapeId id = addDisc<S>(space, {}, S(1), S(1));
  const BodyId body = bodyOf(space, id);
  const ShapeId other = addDisc<S>(space, {S(5), S(0)}, S(1), S(1));

  space.replace(id, boxShape(bodyOf(space, other), S(2), S(2)));

  EXPECT_EQ(space.shape(id).type(), ShapeType::poly);
  EXPECT_EQ(space.shape(id).id(), id);
  EXPECT_EQ(space.shape(id).body(), body);
  EXPECT_EQ(space.body(body).mass(), S(0));
  expectRefused<std::runtime_error>(space, [&] {
    space.change(id, [](Shape<S>& shape) {
      shape.setFriction(S(1));
      throw std::runtime_error("changed my mind");
    });
  });
  EXPECT_EQ(space.shape(id).friction(), S(0));
  expectRefused<NegativeFriction>(
      space, [&] { space.change(id, [](Shape<S>& shape) { shape.setFriction(S(-1)); }); });
}

TYPED_TEST(SpaceTest, TypesChangeInAllDirectionsWithShapesAttached) {
  using S = TypeParam;
  auto& space = this->space_;
  space.setGravity({S(0), S(-10)});
  const ShapeId shape = addDisc<S>(space, {S(0), S(5)}, S(1), S(2));
  const BodyId id = bodyOf(space, shape);
  const BodyType types[] = {BodyType::dynamicBody, BodyType::kinematicBody, BodyType::staticBody};
  for (const BodyType from : types) {
    for (const BodyType to : types) {
      space.setType(id, from);
      space.step(kTick<S>);
      space.setType(id, to);
      EXPECT_EQ(space.body(id).type(), to);
      EXPECT_EQ(space.body(id).id(), id);
      EXPECT_EQ(space.body(id).mass(), to == BodyType::dynamicBody ? S(2) : S(0));
      const Vector<S> before = space.body(id).velocity();
      space.step(kTick<S>);
      if (to == BodyType::dynamicBody) {
        EXPECT_EQ(space.body(id).velocity().y, before.y - S(10) * kTick<S>);
      } else {
        EXPECT_EQ(space.body(id).velocity(), to == BodyType::staticBody ? Vector<S>() : before);
      }
    }
  }
  expectRefused<MainStaticBody>(space, [&] { space.setType(space.staticBody(), BodyType::dynamicBody); });
  EXPECT_NO_THROW(space.setType(space.staticBody(), BodyType::staticBody));
  EXPECT_THROW(space.body(id).setType(BodyType::staticBody), AttachedBody);
}

TYPED_TEST(SpaceTest, ABodyMadeDynamicFallsOntoWhatIsBelow) {
  using S = TypeParam;
  auto& space = this->space_;
  space.setGravity({S(0), S(-10)});
  addWall<S>(space, {S(-5), S(0)}, {S(5), S(0)});
  const ShapeId shape = addDisc<S>(space, {S(0), S(2)}, S(1), S(2));
  const BodyId id = bodyOf(space, shape);
  space.setType(id, BodyType::staticBody);
  for (int i = 0; i < 10; ++i) space.step(kTick<S>);
  EXPECT_EQ(space.body(id).position(), Vector<S>(S(0), S(2)));

  space.setType(id, BodyType::dynamicBody);
  for (int i = 0; i < 200; ++i) space.step(kTick<S>);

  // It rests within the slop.
  EXPECT_NEAR(double(space.body(id).position().y), 1, 0.01);
}

TYPED_TEST(SpaceTest, StaticBodyMovedByHandTakesItsShapesAlongWithoutReindexing) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId platform = space.add(Body<S>::fixedInPlace());
  const ShapeId wall = space.add(segmentShape(platform, Vector<S>(S(-5), S(0)), Vector<S>(S(5), S(0)), S(0)));
  const ShapeId disc = addDisc<S>(space, {S(100), S(50)}, S(1), S(1));
  space.step(kTick<S>);

  // Farther than the margin within which shapes count as touching.
  space.body(platform).setPosition({S(100), S(48)});
  EXPECT_EQ(space.boundingBox(wall), BB<S>(S(95), S(48), S(105), S(48)));
  space.step(kTick<S>);

  int touching = 0;
  space.eachArbiter(bodyOf(space, disc), [&](Arbiter<S>&) { ++touching; });
  EXPECT_EQ(touching, 0);
  space.body(platform).setPosition({S(100), S(49) + ratio<S>(1, 4)});
  space.step(kTick<S>);
  space.eachArbiter(bodyOf(space, disc), [&](Arbiter<S>&) { ++touching; });
  EXPECT_EQ(touching, 1);
}

TYPED_TEST(SpaceTest, ReindexingChangesNothing) {
  using S = TypeParam;
  auto& space = this->space_;
  fillAtRandom(space, 1);
  space.step(kTick<S>);
  const std::uint64_t before = space.hash();

  space.reindexStatic();
  space.eachShape([&](const Shape<S>&) {});
  space.reindexShape(space.state().shapes.idAt(0));
  space.reindexShapesForBody(space.staticBody());

  EXPECT_EQ(space.hash(), before);
}

TYPED_TEST(SpaceTest, VisitsGoByRisingId) {
  using S = TypeParam;
  auto& space = this->space_;
  std::vector<BodyId> bodies = {space.staticBody()};
  for (int i = 0; i < 4; ++i) bodies.push_back(space.add(Body<S>(S(1), S(1))));
  std::vector<ShapeId> shapes;
  for (int i = 0; i < 5; ++i) shapes.push_back(space.add(circleShape(bodies[2], S(1))));
  space.remove(bodies[1]);
  bodies[1] = space.add(Body<S>(S(1), S(1)));
  space.remove(shapes[0]);
  shapes[0] = space.add(circleShape(bodies[2], S(2)));

  std::vector<BodyId> seen;
  space.eachBody([&](const Body<S>& body) {
    EXPECT_TRUE(space.isLocked());
    seen.push_back(body.id());
  });
  EXPECT_EQ(seen, bodies);
  EXPECT_FALSE(space.isLocked());
  std::vector<ShapeId> found;
  space.eachShape([&](const Shape<S>& shape) { found.push_back(shape.id()); });
  EXPECT_EQ(found, shapes);
  found.clear();
  space.eachShape(bodies[2], [&](const Shape<S>& shape) { found.push_back(shape.id()); });
  EXPECT_EQ(found, shapes);
  found.clear();
  std::as_const(space).eachShape([&](const Shape<S>& shape) { found.push_back(shape.id()); });
  EXPECT_EQ(found, shapes);
}

TYPED_TEST(SpaceTest, ShapesOfABodyStayInOrderThroughRemovals) {
  using S = TypeParam;
  auto& space = this->space_;
  Random random(5);
  const BodyId holders[] = {space.add(Body<S>(S(1), S(1))), space.add(Body<S>(S(1), S(1)))};
  std::vector<ShapeId> alive;
  for (int round = 0; round < 300; ++round) {
    if (!alive.empty() && random.oneIn(3)) {
      const std::size_t victim = random.below(static_cast<std::uint32_t>(alive.size()));
      space.remove(alive[victim]);
      alive.erase(alive.begin() + static_cast<std::ptrdiff_t>(victim));
    } else {
      alive.push_back(space.add(circleShape(holders[random.below(2)], S(1))));
    }
    if (random.oneIn(20)) space.dropCache();
    for (const BodyId holder : holders) {
      std::vector<ShapeId> expected;
      space.eachShape([&](const Shape<S>& shape) {
        if (shape.body() == holder) expected.push_back(shape.id());
      });
      std::vector<ShapeId> found;
      space.eachShape(holder, [&](const Shape<S>& shape) { found.push_back(shape.id()); });
      ASSERT_EQ(found, expected) << round;
    }
  }
}

// Locking.

template <Scalar S>
void expectAllRefusedWhileLocked(Space<S>& space, ShapeId shape) {
  const BodyId body = bodyOf(space, shape);
  const SavedSpace<S> none;
  EXPECT_TRUE(space.isLocked());
  expectRefused<SpaceLocked>(space, [&] { space.add(Body<S>(S(1), S(1))); });
  expectRefused<SpaceLocked>(space, [&] { space.add(circleShape(body, S(1))); });
  expectRefused<SpaceLocked>(space, [&] { space.setStaticBody(Body<S>::fixedInPlace()); });
  expectRefused<SpaceLocked>(space, [&] { space.remove(body); });
  expectRefused<SpaceLocked>(space, [&] { space.remove(shape); });
  expectRefused<SpaceLocked>(space, [&] { space.removeWithShapes(body); });
  expectRefused<SpaceLocked>(space, [&] { space.setType(body, BodyType::staticBody); });
  expectRefused<SpaceLocked>(space, [&] { space.change(shape, [](Shape<S>& s) { s.setMass(S(9)); }); });
  expectRefused<SpaceLocked>(
      space, [&] { space.change(shape, [](Shape<S>& s) { CircleShape<S>(s).setRadius(S(3)); }); });
  expectRefused<SpaceLocked>(space, [&] { space.addCollisionHandler(1, 2, 1); });
  expectRefused<SpaceLocked>(space, [&] { space.addWildcardHandler(1, 1); });
  expectRefused<SpaceLocked>(space, [&] { space.addDefaultCollisionHandler(1); });
  expectRefused<SpaceLocked>(space, [&] { space.registerHandler(1, {}); });
  expectRefused<SpaceLocked>(space, [&] { space.registerPositionFunc(1, [](Body<S>&, S, void*) {}); });
  expectRefused<SpaceLocked>(
      space, [&] { space.registerVelocityFunc(1, [](Body<S>&, const Vector<S>&, S, S, void*) {}); });
  expectRefused<SpaceLocked>(space, [&] { space.step(kTick<S>); });
  expectRefused<SpaceLocked>(space, [&] { space.step(S(0)); });
  expectRefused<SpaceLocked>(space, [&] { space.reindexStatic(); });
  expectRefused<SpaceLocked>(space, [&] { space.reindexShape(shape); });
  expectRefused<SpaceLocked>(space, [&] { space.reindexShapesForBody(body); });
  expectRefused<SpaceLocked>(space, [&] { space.filterArbiters(body); });
  expectRefused<SpaceLocked>(space, [&] { space.save(); });
  expectRefused<SpaceLocked>(space, [&] { space.restore(none); });
  expectRefused<SpaceLocked>(space, [&] { space.adopt(space.state()); });
  expectRefused<SpaceLocked>(space, [&] { space.dropCache(); });
}

TYPED_TEST(SpaceTest, WhileAVisitRunsNothingIsAddedRemovedOrReplaced) {
  using S = TypeParam;
  auto& space = this->space_;
  const ShapeId shape = addDisc<S>(space, {}, S(1), S(1));
  addDisc<S>(space, {S(1), S(0)}, S(1), S(1));
  space.step(kTick<S>);
  int visits = 0;
  const auto check = [&](auto&&) {
    ++visits;
    expectAllRefusedWhileLocked(space, shape);
  };
  space.eachBody(check);
  space.eachShape(check);
  space.eachArbiter(check);
  space.eachArbiter(bodyOf(space, shape), check);
  EXPECT_EQ(visits, 3 + 2 + 1 + 1);
  EXPECT_FALSE(space.isLocked());
  // Values that are neither geometry nor mass may change.
  space.eachBody([&](const Body<S>&) { space.change(shape, [](Shape<S>& s) { s.setFriction(S(1)); }); });
  EXPECT_EQ(space.shape(shape).friction(), S(1));
}

template <Scalar S>
struct StepProbe {
  ShapeId shape;
  int calls = 0;
};

TYPED_TEST(SpaceTest, WhileAStepRunsNothingIsAddedRemovedOrReplaced) {
  using S = TypeParam;
  auto& space = this->space_;
  const ShapeId shape = addDisc<S>(space, {}, S(1), S(1));
  addDisc<S>(space, {S(1), S(0)}, S(1), S(1));
  StepProbe<S> probe{shape};
  const auto check = [](Space<S>& of, void* data) {
    auto* p = static_cast<StepProbe<S>*>(data);
    ++p->calls;
    expectAllRefusedWhileLocked(of, p->shape);
  };
  CollisionHandler<S> handler;
  handler.data = &probe;
  static auto* const checking = +check;
  handler.begin = [](Arbiter<S>&, Space<S>& of, void* data) { return checking(of, data), true; };
  handler.preSolve = [](Arbiter<S>&, Space<S>& of, void* data) { return checking(of, data), true; };
  handler.postSolve = [](Arbiter<S>&, Space<S>& of, void* data) { checking(of, data); };
  handler.separate = [](Arbiter<S>&, Space<S>& of, void* data) { checking(of, data); };
  space.registerHandler(1, handler);
  space.addDefaultCollisionHandler(1);

  space.step(kTick<S>);
  EXPECT_EQ(probe.calls, 3);
  space.remove(shape);
  EXPECT_EQ(probe.calls, 4);
  EXPECT_FALSE(space.isLocked());
}

TYPED_TEST(SpaceTest, MessagesOfALockedSpaceSayWhatToDo) {
  using S = TypeParam;
  auto& space = this->space_;
  space.lock();
  try {
    space.reindexStatic();
    FAIL();
  } catch (const SpaceLocked& error) {
    EXPECT_STREQ(
        error.what(),
        "You cannot manually reindex objects while the space is locked. Wait until the current query "
        "or step is complete.");
  }
  try {
    space.add(Body<S>(S(1), S(1)));
    FAIL();
  } catch (const SpaceLocked& error) {
    EXPECT_STREQ(error.what(), message(Fault::SpaceLocked));
  }
  space.unlock(false);
}

TYPED_TEST(SpaceTest, LocksCountAndDoNotUnderflow) {
  auto& space = this->space_;
  expectRefused<SpaceLockUnderflow>(space, [&] { space.unlock(true); });
  space.lock();
  space.lock();
  space.unlock(true);
  EXPECT_TRUE(space.isLocked());
  space.unlock(true);
  EXPECT_FALSE(space.isLocked());
  EXPECT_THROW(space.unlock(false), SpaceLockUnderflow);
}

TYPED_TEST(SpaceTest, AVisitorThatThrowsLeavesTheSpaceUnlocked) {
  using S = TypeParam;
  auto& space = this->space_;
  EXPECT_THROW(space.eachBody([](const Body<S>&) { throw std::runtime_error("stop"); }), std::runtime_error);
  EXPECT_FALSE(space.isLocked());
  EXPECT_NO_THROW(space.step(kTick<S>));
}

// Post-step callbacks.

template <Scalar S>
struct Log {
  std::vector<std::uint64_t> keys;
  static void note(Space<S>&, std::uint64_t key, void* data) { static_cast<Log*>(data)->keys.push_back(key); }
  static void noteAndAdd(Space<S>& space, std::uint64_t key, void* data) {
    note(space, key, data);
    EXPECT_FALSE(space.isLocked());
    if (key < 100) {
      EXPECT_TRUE(space.addPostStepCallback(noteAndAdd, key + 100, data));
    }
  }
};

TYPED_TEST(SpaceTest, PostStepCallbacksRunInOrderOncePerKey) {
  using S = TypeParam;
  auto& space = this->space_;
  Log<S> log;
  space.eachBody([&](const Body<S>&) {
    EXPECT_TRUE(space.addPostStepCallback(Log<S>::note, 5, &log));
    EXPECT_TRUE(space.addPostStepCallback(Log<S>::note, 3, &log));
    EXPECT_FALSE(space.addPostStepCallback(Log<S>::note, 5, &log));
    EXPECT_TRUE(space.addPostStepCallback(Log<S>::note, 9, &log));
    EXPECT_TRUE(log.keys.empty());
  });
  EXPECT_EQ(log.keys, (std::vector<std::uint64_t>{5, 3, 9}));
  space.step(kTick<S>);
  EXPECT_EQ(log.keys.size(), 3u);
}

TYPED_TEST(SpaceTest, PostStepCallbackRunsAtOnceWithoutALock) {
  using S = TypeParam;
  Log<S> log;
  EXPECT_TRUE(this->space_.addPostStepCallback(Log<S>::note, 1, &log));
  EXPECT_TRUE(this->space_.addPostStepCallback(Log<S>::note, 1, &log));
  EXPECT_EQ(log.keys, (std::vector<std::uint64_t>{1, 1}));
}

TYPED_TEST(SpaceTest, PostStepCallbacksMayAddMore) {
  using S = TypeParam;
  auto& space = this->space_;
  Log<S> log;
  space.lock();
  space.addPostStepCallback(Log<S>::noteAndAdd, 1, &log);
  space.addPostStepCallback(Log<S>::noteAndAdd, 2, &log);
  space.unlock(true);
  EXPECT_EQ(log.keys, (std::vector<std::uint64_t>{1, 2, 101, 102}));
}

TYPED_TEST(SpaceTest, PostStepCallbacksWaitForTheUnlockThatRunsThem) {
  using S = TypeParam;
  auto& space = this->space_;
  Log<S> log;
  space.lock();
  space.addPostStepCallback(Log<S>::note, 1, &log);
  space.unlock(false);
  EXPECT_TRUE(log.keys.empty());
  space.step(kTick<S>);
  EXPECT_EQ(log.keys.size(), 1u);
  expectRefused<ValueOutOfRange>(space, [&] { space.addPostStepCallback(nullptr, 1); });
}

TYPED_TEST(SpaceTest, PostStepCallbacksAddAndRemoveBodiesAndStep) {
  using S = TypeParam;
  auto& space = this->space_;
  struct Context {
    ShapeId victim;
    BodyId made{};
  } context{addDisc<S>(space, {}, S(1), S(1))};
  space.lock();
  space.addPostStepCallback(
      [](Space<S>& of, std::uint64_t, void* data) {
        auto* c = static_cast<Context*>(data);
        of.removeWithShapes(bodyOf(of, c->victim));
        c->made = of.add(Body<S>(S(1), S(1)));
        of.step(kTick<S>);
      },
      1, &context);
  space.unlock(true);
  EXPECT_FALSE(space.contains(context.victim));
  EXPECT_TRUE(space.contains(context.made));
  EXPECT_EQ(space.stamp(), 1u);
}

TYPED_TEST(SpaceTest, APostStepCallbackThatThrowsDelaysTheOthers) {
  using S = TypeParam;
  auto& space = this->space_;
  Log<S> log;
  space.lock();
  space.addPostStepCallback(Log<S>::note, 1, &log);
  space.addPostStepCallback([](Space<S>&, std::uint64_t, void*) { throw std::runtime_error("stop"); }, 2);
  space.addPostStepCallback(Log<S>::note, 3, &log);
  EXPECT_THROW(space.unlock(true), std::runtime_error);
  EXPECT_FALSE(space.isLocked());
  EXPECT_EQ(log.keys, (std::vector<std::uint64_t>{1}));

  space.step(kTick<S>);
  EXPECT_EQ(log.keys, (std::vector<std::uint64_t>{1, 3}));
}

/// A Space whose one callback waits: it was unlocked without running any.
template <class S>
void leaveWaiting(Space<S>& space, Log<S>& log) {
  space.lock();
  space.addPostStepCallback(Log<S>::note, 1, &log);
  space.unlock(false);
}

TYPED_TEST(SpaceTest, PostStepCallbacksThatWaitForAWorldThatIsReplacedAreDropped) {
  using S = TypeParam;
  auto& space = this->space_;
  const SavedSpace<S> saved = space.save();
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(saveSnapshot(space, {})));
  saveSnapshot(space, bytes);
  const auto expectDropped = [&](const char* how, auto&& replace) {
    Log<S> log;
    leaveWaiting(space, log);
    replace();
    space.step(kTick<S>);
    EXPECT_TRUE(log.keys.empty()) << how;
    space.lock();
    EXPECT_TRUE(space.addPostStepCallback(Log<S>::note, 1, &log)) << how;  // Its key is free again.
    space.unlock(true);
    EXPECT_EQ(log.keys, (std::vector<std::uint64_t>{1})) << how;
  };
  expectDropped("restore", [&] { space.restore(saved); });
  expectDropped("load", [&] { loadSnapshot<S>(space, bytes); });
  expectDropped("adopt a copy", [&] { space.adopt(saved.state()); });
  expectDropped("adopt", [&] { space.adopt(WorldState<S>(saved.state())); });
}

TYPED_TEST(SpaceTest, PostStepCallbacksWaitOnWhereAWorldIsNotReplaced) {
  using S = TypeParam;
  auto& space = this->space_;
  Log<S> log;
  leaveWaiting(space, log);
  EXPECT_THROW(space.restore(SavedSpace<S>()), ForeignWorld);
  EXPECT_THROW(loadSnapshot<S>(space, {}), FormatError);
  space.step(kTick<S>);
  EXPECT_EQ(log.keys, (std::vector<std::uint64_t>{1}));
}

TYPED_TEST(SpaceTest, APostStepCallbackThatRestoresDropsThoseAfterItAndMayAddOthers) {
  using S = TypeParam;
  auto& space = this->space_;
  struct Context {
    SavedSpace<S> saved;
    Log<S> log;
  } context{space.save(), {}};
  space.step(kTick<S>);
  space.lock();
  space.addPostStepCallback(Log<S>::note, 1, &context.log);
  space.addPostStepCallback(
      [](Space<S>& of, std::uint64_t, void* data) {
        auto* c = static_cast<Context*>(data);
        of.restore(c->saved);
        EXPECT_TRUE(of.addPostStepCallback(Log<S>::note, 3, &c->log));
        EXPECT_TRUE(of.addPostStepCallback(Log<S>::note, 5, &c->log));
      },
      2, &context);
  space.addPostStepCallback(Log<S>::note, 3, &context.log);
  space.addPostStepCallback(Log<S>::note, 4, &context.log);
  space.unlock(true);
  EXPECT_EQ(context.log.keys, (std::vector<std::uint64_t>{1, 3, 5}));
  EXPECT_EQ(space.stamp(), 0u);
  space.step(kTick<S>);
  EXPECT_EQ(context.log.keys.size(), 3u);
}

TYPED_TEST(SpaceTest, PostStepCallbacksOfARefusedStepAreDropped) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    Space<S> space;
    space.setSolver(solver);
    struct Context {
      Space<S>& space;
      Log<S> log;
    } context{space, {}};
    Log<S>& log = context.log;
    space.registerPositionFunc(
        1,
        [](Body<S>&, S, void* data) {
          auto* c = static_cast<Context*>(data);
          EXPECT_TRUE(c->space.addPostStepCallback(Log<S>::note, 2, &c->log));
        },
        &context);
    const ShapeId a = addDisc<S>(space, {}, S(1), S(1));
    addDisc<S>(space, {S(1), S(0)}, S(1), S(1));
    space.body(bodyOf(space, a)).setPositionFunc(1);
    leaveWaiting(space, log);  // This one was there before and stays.
    space.setMaxPairs(0);
    EXPECT_THROW(space.step(kTick<S>), TooManyPairs);
    EXPECT_TRUE(log.keys.empty());
    space.setMaxPairs(1);
    space.body(bodyOf(space, a)).setPositionFunc(0);
    space.step(kTick<S>);
    EXPECT_EQ(log.keys, (std::vector<std::uint64_t>{1}));
  }
}

// A callback of the removal wants to remove the same shape once more: it has to wait until it is gone.
TYPED_TEST(SpaceTest, CallbacksDuringARemovalRunAfterIt) {
  using S = TypeParam;
  auto& space = this->space_;
  struct Context {
    ShapeId shape;
    int gone = 0;
  } context;
  CollisionHandler<S> handler;
  handler.data = &context;
  handler.separate = [](Arbiter<S>&, Space<S>& of, void* data) {
    of.addPostStepCallback(
        [](Space<S>& later, std::uint64_t, void* d) {
          auto* c = static_cast<Context*>(d);
          if (!later.contains(c->shape)) ++c->gone;
        },
        1, data);
  };
  space.registerHandler(1, handler);
  space.addDefaultCollisionHandler(1);
  for (const bool withBody : {false, true}) {
    context.shape = addDisc<S>(space, {}, S(1), S(1));
    addDisc<S>(space, {S(1), S(0)}, S(1), S(1));
    space.step(kTick<S>);
    if (withBody) {
      space.removeWithShapes(bodyOf(space, context.shape));
    } else {
      const BodyId body = bodyOf(space, context.shape);
      space.remove(context.shape);
      space.remove(body);
    }
  }
  EXPECT_EQ(context.gone, 2);
}

// Stepping.

TYPED_TEST(SpaceTest, AStepOfNoTimeDoesNothing) {
  using S = TypeParam;
  auto& space = this->space_;
  space.add(Body<S>());  // One that could not be stepped.
  const std::uint64_t before = space.hash();
  EXPECT_NO_THROW(space.step(S(0)));
  EXPECT_EQ(space.hash(), before);
  EXPECT_EQ(space.stamp(), 0u);
}

TYPED_TEST(SpaceTest, AStepCountsAndKeepsItsTime) {
  using S = TypeParam;
  this->space_.step(kTick<S>);
  this->space_.step(S(1));
  EXPECT_EQ(this->space_.stamp(), 2u);
  EXPECT_EQ(this->space_.currentTimeStep(), S(1));
}

TYPED_TEST(SpaceTest, ABodyThatCannotBeSteppedStopsTheStepBeforeItBegins) {
  using S = TypeParam;
  auto& space = this->space_;
  const ShapeId disc = addDisc<S>(space, {}, S(1), S(1), {S(1), S(0)});
  const BodyId massless = space.add(Body<S>());
  expectRefused<IllegalBody>(space, [&] { space.step(kTick<S>); });
  space.body(massless).setMass(S(1));
  expectRefused<IllegalBody>(space, [&] { space.step(kTick<S>); });
  space.body(massless).setMoment(S(1));
  EXPECT_NO_THROW(space.step(kTick<S>));
  EXPECT_EQ(space.body(bodyOf(space, disc)).position().x, kTick<S>);
}

TYPED_TEST(SpaceTest, AMissingFunctionStopsTheStepBeforeItBegins) {
  using S = TypeParam;
  auto& space = this->space_;
  Body<S> body(S(1), S(1));
  body.setPositionFunc(4);
  const BodyId id = space.add(body);
  expectRefused<MissingCallback>(space, [&] { space.step(kTick<S>); });
  space.body(id).setPositionFunc(0);
  space.body(id).setVelocityFunc(4);
  expectRefused<MissingCallback>(space, [&] { space.step(kTick<S>); });
  space.registerVelocityFunc(4, [](Body<S>&, const Vector<S>&, S, S, void*) {});
  EXPECT_NO_THROW(space.step(kTick<S>));
  expectRefused<ValueOutOfRange>(space, [&] { space.registerVelocityFunc(0, nullptr); });
  expectRefused<ValueOutOfRange>(space, [&] { space.registerVelocityFunc(5, nullptr); });
  expectRefused<ValueOutOfRange>(space, [&] { space.registerPositionFunc(5, nullptr); });
  expectRefused<ValueOutOfRange>(space, [&] { space.registerHandler(0, {}); });
  expectRefused<MissingCallback>(space, [&] { space.addCollisionHandler(1, 2, 9); });
  expectRefused<MissingCallback>(space, [&] { space.addWildcardHandler(1, 9); });
  expectRefused<MissingCallback>(space, [&] { space.addDefaultCollisionHandler(9); });
}

TYPED_TEST(SpaceTest, PositionAndVelocityFunctionsReplaceTheBuiltInOnes) {
  using S = TypeParam;
  auto& space = this->space_;
  space.setSolver(SolverKind::sequentialImpulses);
  space.setGravity({S(0), S(-8)});
  struct Seen {
    std::vector<std::uint64_t> order;
  } seen;
  space.registerPositionFunc(
      1,
      [](Body<S>& body, S dt, void* data) {
        static_cast<Seen*>(data)->order.push_back(body.userData());
        body.updatePosition(dt + dt);
      },
      &seen);
  space.registerVelocityFunc(
      2,
      [](Body<S>& body, const Vector<S>& gravity, S damping, S dt, void* data) {
        static_cast<Seen*>(data)->order.push_back(body.userData() + 10);
        body.updateVelocity(-gravity, damping, dt);
      },
      &seen);
  std::vector<BodyId> ids;
  for (std::uint64_t i = 0; i < 3; ++i) {
    Body<S> body = i == 1 ? Body<S>::fixedInPlace() : Body<S>(S(1), S(1));
    body.setUserData(i);
    if (i != 1) body.setVelocity({S(4), S(0)});
    body.setPositionFunc(1);
    body.setVelocityFunc(2);
    ids.push_back(space.add(body));
  }
  space.step(S(1) / S(8));

  // The order is by rising body; a static body is not asked.
  EXPECT_EQ(seen.order, (std::vector<std::uint64_t>{0, 2, 10, 12}));
  EXPECT_EQ(space.body(ids[0]).position(), Vector<S>(S(1), S(0)));
  EXPECT_EQ(space.body(ids[0]).velocity(), Vector<S>(S(4), S(1)));
}

// Values leaving the range during a step.

TYPED_TEST(SpaceTest, SpeedAndSpinAreHeldAtTheirLimitsAndListed) {
  using S = TypeParam;
  auto& space = this->space_;
  space.setGravity({S(0), -kMaxAcceleration<S>});
  const BodyId calm = space.add(Body<S>::kinematic());
  const BodyId fast = space.add(Body<S>(S(1), S(1)));
  const BodyId spinning = space.add(Body<S>(S(1), S(1)));
  space.body(spinning).setTorque(kMaxForce<S>);

  space.step(ratio<S>(1, 8));

  EXPECT_EQ(space.body(fast).velocity(), Vector<S>(S(0), -kMaxSpeed<S>));
  EXPECT_EQ(space.body(spinning).angularVelocity(), kMaxAngularSpeed<S>);
  ASSERT_EQ(space.rangeEvents().size(), 2u);
  EXPECT_EQ(space.rangeEvents()[0].body, fast);
  EXPECT_EQ(space.rangeEvents()[0].held, Body<S>::kHeldSpeed);
  EXPECT_EQ(space.rangeEvents()[1].body, spinning);
  EXPECT_EQ(space.rangeEvents()[1].held, Body<S>::kHeldSpeed | Body<S>::kHeldSpin);
  EXPECT_EQ(space.body(calm).velocity(), Vector<S>());

  space.setGravity({});
  space.step(ratio<S>(1, 8));
  EXPECT_TRUE(space.rangeEvents().empty());
}

TYPED_TEST(SpaceTest, BodiesAreHeldAtTheBorderWithTheOutwardVelocityZeroed) {
  using S = TypeParam;
  auto& space = this->space_;
  space.setWorldExtent(S(100));
  Body<S> body(S(1), S(1));
  body.setPosition({S(99), S(-99)});
  body.setVelocity({S(2), S(1)});
  const BodyId id = space.add(body);

  space.step(S(1));

  EXPECT_EQ(space.body(id).position(), Vector<S>(S(100), S(-98)));
  EXPECT_EQ(space.body(id).velocity(), Vector<S>(S(0), S(1)));
  ASSERT_EQ(space.rangeEvents().size(), 1u);
  EXPECT_EQ(space.rangeEvents()[0].held, Body<S>::kHeldAtBorder);
}

TYPED_TEST(SpaceTest, FunctionsThatLeaveTheRangeAreHeldTooNotThrown) {
  using S = TypeParam;
  auto& space = this->space_;
  space.setWorldExtent(kMaxWorldExtent<S>);
  space.setGravity({S(0), -kMaxAcceleration<S>});
  space.registerPositionFunc(1, [](Body<S>& body, S dt, void*) { body.updatePosition(dt); });
  space.registerVelocityFunc(1, [](Body<S>& body, const Vector<S>& gravity, S damping, S dt, void*) {
    body.updateVelocity(gravity, damping, dt);
  });
  Body<S> body(S(1), S(1));
  body.setPosition({kMaxWorldExtent<S>, S(0)});
  body.setVelocity({S(5), S(0)});
  body.setPositionFunc(1);
  body.setVelocityFunc(1);
  const BodyId id = space.add(body);

  ASSERT_NO_THROW(space.step(S(1)));

  EXPECT_EQ(space.body(id).position().x, kMaxWorldExtent<S>);
  EXPECT_EQ(space.body(id).velocity(), Vector<S>(S(0), -kMaxSpeed<S>));
  ASSERT_EQ(space.rangeEvents().size(), 1u);
  EXPECT_EQ(space.rangeEvents()[0].held, Body<S>::kHeldAtBorder | Body<S>::kHeldSpeed);
  // A value set by hand, after the step, is refused again.
  space.body(id).setVelocity({S(5), S(0)});
  EXPECT_THROW(space.body(id).updatePosition(S(1)), IllegalBody);
}

// Numbers that both scalars hold exactly: the same events and the same values.
#ifndef SAMESTEP_FIXED_ONLY
TEST(RangeEventsTest, AreTheSameInDoubleAndFixed) {
  Space<double> inDouble;
  Space<Fixed> inFixed;
  const auto fill = [](auto& space) {
    using S = std::remove_cvref_t<decltype(space.damping())>;
    Random random(11);
    space.setWorldExtent(S(64));
    space.setGravity({S(256), S(-512)});
    for (int i = 0; i < 20; ++i) {
      Body<S> body(S(1 << random.below(3)), S(1 << random.below(3)));
      body.setPosition({random.number<S>(-60, 60), random.number<S>(-60, 60)});
      body.setVelocity({random.number<S>(-1000, 1000), random.number<S>(-1000, 1000)});
      body.setAngularVelocity(random.number<S>(-250, 250));
      body.setTorque(random.number<S>(-100, 100));
      space.add(body);
    }
  };
  fill(inDouble);
  fill(inFixed);
  std::size_t events = 0;
  for (int step = 0; step < 50; ++step) {
    inDouble.step(1.0 / 16);
    inFixed.step(Fixed(1) / Fixed(16));
    const auto a = inDouble.rangeEvents();
    const auto b = inFixed.rangeEvents();
    ASSERT_EQ(a.size(), b.size()) << step;
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].body, b[i].body);
      EXPECT_EQ(a[i].held, b[i].held);
    }
    events += a.size();
    inDouble.eachBody([&](const Body<double>& body) {
      const Body<Fixed>& other = inFixed.body(body.id().anywhere());
      EXPECT_EQ(body.velocity().x, double(other.velocity().x));
      EXPECT_EQ(body.worldCenter().y, double(other.worldCenter().y));
    });
  }
  EXPECT_GT(events, 20u);
}
#endif

TYPED_TEST(SpaceTest, StagesAreObservedInTheirOrder) {
  using S = TypeParam;
  auto& space = this->space_;
  space.setSolver(SolverKind::sequentialImpulses);
  std::vector<Stage> stages;
  space.setStageObserver(
      [](const Space<S>& of, Stage stage, void* data) {
        EXPECT_TRUE(of.isLocked());
        static_cast<std::vector<Stage>*>(data)->push_back(stage);
      },
      &stages);
  space.step(kTick<S>);
  EXPECT_EQ(stages, (std::vector<Stage>{Stage::integratePositions, Stage::updateShapes, Stage::findPairs,
                                        Stage::collide, Stage::preStep, Stage::integrateVelocities,
                                        Stage::solve, Stage::callbacks}));
  for (const Stage stage : stages) EXPECT_STRNE(stageName(stage), "unknown");
  space.setStageObserver(nullptr);
  space.step(kTick<S>);
  EXPECT_EQ(stages.size(), 8u);
}

// A value that names no solver is refused like any other setting, and nothing changes.
TYPED_TEST(SpaceTest, SetSolverRefusesWhatNamesNoSolver) {
  Space<TypeParam> space;
  space.setSolver(SolverKind::softStep);

  EXPECT_THROW(space.setSolver(static_cast<SolverKind>(2)), ValueOutOfRange);

  EXPECT_EQ(space.settings().solver, SolverKind::softStep);
}

}  // namespace
}  // namespace samestep
