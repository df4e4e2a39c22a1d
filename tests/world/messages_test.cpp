// SPDX-License-Identifier: MIT
// What errors say: what was asked for, the value, and what is allowed.
#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>
#include <samestep/snapshot.h>
#include <samestep/space.h>

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

using ::testing::HasSubstr;

template <class Call>
std::string messageOf(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing is thrown";
}

template <class S>
class MessagesTest : public ::testing::Test {};
TYPED_TEST_SUITE(MessagesTest, AllScalarsAndChecked);

TYPED_TEST(MessagesTest, AStepNamesItsTime) {
  using S = TypeParam;
  Space<S> space;
  EXPECT_EQ(messageOf([&] { space.step(S(-1)); }),
            "Space::step: dt is -1 s, allowed are 0, which does nothing, to 1 s");
  EXPECT_EQ(messageOf([&] { space.step(S(2)); }),
            "Space::step: dt is 2 s, allowed are 0, which does nothing, to 1 s");
}

TYPED_TEST(MessagesTest, AStepNamesTheBodyItCannotMove) {
  using S = TypeParam;
  Space<S> space;
  space.add(Body<S>(S(1), S(0)));
  EXPECT_THAT(messageOf([&] { space.step(kTick<S>); }),
              HasSubstr("Space::step: body 1 (generation 1): its moment is 0"));
  space.removeWithShapes(BodyId{1, 1});
  space.add(Body<S>());
  EXPECT_THAT(messageOf([&] { space.step(kTick<S>); }),
              HasSubstr("Space::step: body 1 (generation 3): its mass is 0"));
}

TYPED_TEST(MessagesTest, SettersNameValueAndLimit) {
  using S = TypeParam;
  Space<S> space;
  Shape<S> shape = circleShape<S>({}, S(1));
  Body<S> body(S(1), S(1)), kinematic = Body<S>::kinematic(), fixed = Body<S>::fixedInPlace();
  const std::pair<std::string, std::string> cases[] = {
      {messageOf([&] { shape.setFriction(S(-1)); }),
       "Shape::setFriction: friction is -1, allowed are 0 to 1024"},
      {messageOf([&] { shape.setElasticity(S(2000)); }),
       "Shape::setElasticity: elasticity is 2000, allowed are 0 to 1024"},
      {messageOf([&] { shape.setMass(S(-3)); }),
       "Shape::setMass: mass is -3 kg, allowed are 0 and 0.001 to 1000000 kg"},
      {messageOf([&] {
         shape.setSurfaceVelocity({S(0), S(5000)});
       }),
       "Shape::setSurfaceVelocity: velocity is (0, 5000) m/s, allowed are up to 1024 m/s along each axis"},
      {messageOf([&] {
         body.setVelocity({S(0), S(2000)});
       }),
       "Body::setVelocity: velocity is (0, 2000) m/s, allowed are -1024 to 1024 m/s"},
      {messageOf([&] {
         fixed.setVelocity({S(0), S(2)});
       }),
       "Body::setVelocity: velocity is (0, 2) m/s, allowed is 0 for a static body"},
      {messageOf([&] { body.setMass(S(-5)); }),
       "Body::setMass: mass is -5 kg, allowed are 0 and 0.001 to 1000000 kg"},
      {messageOf([&] { kinematic.setMass(S(5)); }),
       "Body::setMass to 5 kg: the body is kinematic, only a dynamic one has a mass"},
      {messageOf([&] { fixed.setMoment(S(5)); }),
       "Body::setMoment to 5 kg m^2: the body is static, only a dynamic one has a moment"},
      {messageOf([&] { space.setIterations(0); }),
       "settings of a Space: iterations are 0, allowed are 1 to 1000"},
      {messageOf([&] { space.setSubsteps(101); }),
       "settings of a Space: substeps are 101, allowed are 1 to 100"},
      {messageOf([&] { space.setDamping(S(2)); }), "settings of a Space: damping is 2, allowed are 0 to 1"},
      {messageOf([&] { space.setMaxPairs(1u << 30); }),
       "Space::setMaxPairs: pairs are 1073741824, allowed are 0 to 268435456"},
      {messageOf([&] { space.addCollisionHandler(1, 2, 77); }),
       "Space::addCollisionHandler: no handler is registered under 77; see Space::registerHandler"},
      {messageOf([&] { space.addDefaultCollisionHandler(78); }),
       "Space::addDefaultCollisionHandler: no handler is registered under 78; see Space::registerHandler"},
  };
  for (const auto& [said, expected] : cases) EXPECT_EQ(said, expected);
}

TYPED_TEST(MessagesTest, ShapesThatAreNoneSayWhatIsWrong) {
  using S = TypeParam;
  using V = Vector<S>;
  const auto polygon = [](std::vector<V> points) { return messageOf([&] { polyShapeRaw<S>({}, points); }); };
  EXPECT_EQ(messageOf([&] {
              segmentShape<S>({}, {S(2), S(1)}, {S(2), S(1)}, S(0));
            }),
            "a segment: both ends are (2, 1), it has no length");
  EXPECT_EQ(polygon({{S(0), S(0)}, {S(0), S(1)}, {S(1), S(0)}}),
            "a polygon: its corners go clockwise, counter-clockwise is wanted");
  EXPECT_THAT(polygon({{S(0), S(0)}, {S(4), S(0)}, {S(1), S(1)}, {S(0), S(4)}}),
              HasSubstr("it does not turn left at corner 2, (1, 1)"));
  EXPECT_THAT(polygon({{S(0), S(0)}, {S(1), S(0)}, {S(2), S(0)}}),
              HasSubstr("it does not turn left at corner 0"));
  EXPECT_EQ(polygon({{S(0), S(0)}, {S(1), S(0)}}), "a polygon: there are 2 corners, allowed are 3 to 32");
  // A star with five points turns left everywhere.
  EXPECT_EQ(polygon({{S(0), S(10)}, {S(-6), S(-8)}, {S(9), S(3)}, {S(-9), S(3)}, {S(6), S(-8)}}),
            "a polygon: its 5 corners go round more than once");
  EXPECT_EQ(messageOf([&] { boxShape<S>({}, S(-1), S(2)); }),
            "a box: width is -1 m and height 2 m, allowed are 0 and above");
  EXPECT_EQ(messageOf([&] { circleShape<S>({}, S(-1)); }),
            "a circle: radius is -1 m, allowed are 0 and above");
  EXPECT_THAT(messageOf([&] {
                circleShape<S>({}, S(1), {S(100000), S(0)});
              }),
              HasSubstr("a circle: a point is (100000, 0) m, allowed are up to "));
}

TYPED_TEST(MessagesTest, WhatIsTooLargeForABodyThatMovesIsNamed) {
  using S = TypeParam;
  Space<S> space;
  const BodyId id = space.add(Body<S>(S(1), S(1)));
  EXPECT_EQ(
      messageOf([&] { space.add(circleShape<S>(id, S(300))); }),
      "a shape reaches 300 m from the origin of its body, allowed are up to 256 m for a body that moves");
}

TYPED_TEST(MessagesTest, AnIdIsNamedWithWhatWasAsked) {
  using S = TypeParam;
  Space<S> space;
  const BodyId gone = space.add(Body<S>(S(1), S(1)));
  const ShapeId shapeGone = space.add(circleShape<S>(gone, S(1)));
  const Shape<S> late = circleShape<S>(gone, S(1));
  space.removeWithShapes(gone);
  const char* const stale = "1 (generation 1) names nothing any more: its slot is at generation 2, free";
  EXPECT_EQ(messageOf([&] { space.body(gone); }), std::string("Space::body: id ") + stale);
  EXPECT_EQ(messageOf([&] { space.add(late); }),
            std::string("Space::add: the body of the shape: id ") + stale);
  EXPECT_EQ(messageOf([&] { space.setType(gone, BodyType::staticBody); }),
            std::string("Space::setType: id ") + stale);
  EXPECT_EQ(messageOf([&] { space.remove(gone); }), std::string("Space::remove: id ") + stale);
  EXPECT_THAT(messageOf([&] { space.shape(shapeGone); }),
              HasSubstr("Space::shape: id 0 (generation 1) names nothing any more"));
  EXPECT_THAT(messageOf([&] { space.remove(shapeGone); }), HasSubstr("Space::remove: id 0 (generation 1)"));
  space.add(Body<S>(S(1), S(1)));
  EXPECT_EQ(messageOf([&] { space.body(gone); }),
            "Space::body: id 1 (generation 1) names nothing any more: its slot is at generation 3, in use");
  EXPECT_EQ(messageOf([&] {
              space.body(BodyId{9, 1});
            }),
            "Space::body: no id 9 (generation 1) was given out here, of slots there are 2");
  EXPECT_EQ(messageOf([&] { space.body(BodyId()); }), "Space::body: the id names nothing");
  EXPECT_EQ(messageOf([&] { space.remove(space.staticBody()); }),
            "Space::remove: body 0 (generation 1) is the static body of the Space, which stays");
  EXPECT_THAT(messageOf([&] {
                space.add(Body<S>(S(1), S(1)), BodyId{4, 2});
              }),
              HasSubstr("given id 4 (generation 2): allowed are odd generations"));
}

TYPED_TEST(MessagesTest, APlaceOutsideOfTheWorldIsRefusedWhereItIsSet) {
  using S = TypeParam;
  Space<S> space;
  const BodyId id = space.add(Body<S>(S(1), S(1)));
  const auto setFar = [&] { space.body(id).setPosition({S(50000), S(0)}); };
  EXPECT_EQ(messageOf(setFar), "Body::setPosition: position is (50000, 0) m, allowed are -32768 to 32768 m");
  EXPECT_EQ(space.body(id).position(), Vector<S>());
  // The Space may have become anything meanwhile.
  const SavedSpace<S> saved = space.save();
  space.setWorldExtent(S(60000));
  EXPECT_EQ(messageOf(setFar), "nothing is thrown");
  space.restore(saved);
  EXPECT_THAT(messageOf(setFar), HasSubstr("allowed are -32768 to 32768 m"));
  space.setType(id, BodyType::kinematicBody);
  EXPECT_THAT(messageOf(setFar), HasSubstr("allowed are -32768 to 32768 m"));
  Body<S> free = space.body(id).detached();
  free.setPosition({S(50000), S(0)});
  EXPECT_EQ(messageOf([&] { space.add(free); }),
            "Space::add: the centre of mass is at (50000, 0) m, allowed are -32768 to 32768 m");
}

// A body that a step carries out of the world is held at its border, and told: see RangeEvent.
TYPED_TEST(MessagesTest, AStepHoldsABodyAtTheBorderOfTheWorld) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    Space<S> space;
    space.setSolver(solver);
    Body<S> fast(S(1), S(1));
    fast.setPosition({S(32760), S(0)});
    fast.setVelocity({S(1000), S(0)});
    const BodyId id = space.add(fast);
    space.registerPositionFunc(1, [](Body<S>& body, S, void*) { body.setPosition({S(50000), S(0)}); });
    space.step(S(1));
    EXPECT_EQ(space.body(id).position(), Vector<S>(S(32768), S(0)));
    ASSERT_EQ(space.rangeEvents().size(), 1u);
    EXPECT_EQ(space.rangeEvents()[0].body, id);
    space.body(id).setPosition({});
    space.body(id).setPositionFunc(1);
    space.step(kTick<S>);
    EXPECT_EQ(space.body(id).position(), Vector<S>(S(32768), S(0)));
    EXPECT_EQ(space.rangeEvents().size(), 1u);
  }
}

}  // namespace
}  // namespace samestep
