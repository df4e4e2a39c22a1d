// SPDX-License-Identifier: MIT
// What a body weighs, and that its material moves on when its centre of mass moves.
#include <samestep/space.h>

#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class SpaceMassTest : public ::testing::Test {
 protected:
  /// A disc of a metre and a mass, its centre at (x, 0) of the body.
  static Shape<S> disc(BodyId body, int x, int mass) {
    Shape<S> shape = circleShape(body, S(1), {S(x), S(0)});
    shape.setMass(S(mass));
    return shape;
  }
  void expectWeight(BodyId id, S mass, S moment) {
    EXPECT_EQ(space_.body(id).mass(), mass);
    EXPECT_EQ(space_.body(id).moment(), moment);
  }
  void setMassOfShape(ShapeId id, int mass) {
    space_.change(id, [&](Shape<S>& shape) { shape.setMass(S(mass)); });
  }

  Space<S> space_;
};
TYPED_TEST_SUITE(SpaceMassTest, AllScalarsAndChecked);

TYPED_TEST(SpaceMassTest, AMassSetByHandStaysWhateverAShapeWithoutMassBecomes) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId id = space.add(Body<S>(S(5), S(7)));
  const ShapeId shape = space.add(circleShape(id, S(2)));
  const std::vector<std::function<void(Shape<S>&)>> changes = {
      [](Shape<S>& s) { CircleShape<S>(s).setRadius(S(3)); },
      [](Shape<S>& s) {
        CircleShape<S>(s).setOffset({S(1), S(2)});
      },
      [&](Shape<S>& s) { s = boxShape(id, S(2), S(4)); },
      [&](Shape<S>& s) { s = segmentShape(id, Vector<S>(S(-1), S(0)), Vector<S>(S(4), S(1))); },
      [](Shape<S>& s) { s.setSensor(true); },
      [](Shape<S>& s) { s.setDensity(S(0)); },
      [](Shape<S>& s) { s.setMass(S(0)); }};
  for (const auto& change : changes) {
    space.change(shape, change);
    this->expectWeight(id, S(5), S(7));
    EXPECT_EQ(space.body(id).centerOfMass(), Vector<S>());
    EXPECT_NO_THROW(space.step(kTick<S>));
  }
  space.remove(shape);
  this->expectWeight(id, S(5), S(7));
}

TYPED_TEST(SpaceMassTest, AShapeThatGetsMassTakesThePlaceOfAMassSetByHandAndLeavesNone) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId id = space.add(Body<S>(S(5), S(7)));
  const ShapeId shape = space.add(circleShape(id, S(2)));

  this->setMassOfShape(shape, 3);
  this->expectWeight(id, S(3), S(6));
  this->setMassOfShape(shape, 0);
  this->expectWeight(id, S(0), S(0));
}

// A body that is of another type meanwhile ends with the mass of one that was dynamic all along, whatever
// happens to its shapes.
TYPED_TEST(SpaceMassTest, ChangesOfShapesCountWhateverTheTypeOfTheBodyMeanwhile) {
  using S = TypeParam;
  using Fixture = TestFixture;
  auto& space = this->space_;
  struct Parts {
    BodyId body;
    ShapeId heavy, light, none;
  };
  const std::vector<std::function<void(const Parts&)>> changes = {
      [&](const Parts& of) { space.remove(of.heavy); },
      [&](const Parts& of) { space.remove(of.none); },
      [&](const Parts& of) {
        space.remove(of.heavy);
        space.remove(of.light);
      },
      [&](const Parts& of) { this->setMassOfShape(of.heavy, 1); },
      [&](const Parts& of) {
        this->setMassOfShape(of.heavy, 0);
        this->setMassOfShape(of.light, 0);
      },
      [&](const Parts& of) { space.add(Fixture::disc(of.body, 5, 2)); },
      [&](const Parts& of) { space.remove(space.add(Fixture::disc(of.body, 5, 2))); },
      [&](const Parts& of) { space.replace(of.heavy, boxShape(of.body, S(1), S(1))); },
      [&](const Parts& of) {
        space.change(of.light, [](Shape<S>& s) { CircleShape<S>(s).setRadius(S(2)); });
      },
      [&](const Parts& of) { space.change(of.none, [](Shape<S>& s) { CircleShape<S>(s).setRadius(S(2)); }); },
      [&](const Parts& of) { space.accumulateMassFromShapes(of.body); },
      [](const Parts&) {}};
  const auto build = [&] {
    Parts of;
    of.body = space.add(Body<S>(S(5), S(7)));
    of.heavy = space.add(Fixture::disc(of.body, 2, 4));
    of.light = space.add(Fixture::disc(of.body, -2, 2));
    of.none = space.add(circleShape(of.body, S(1)));
    space.body(of.body).setMass(S(9));
    return of;
  };
  for (const BodyType meanwhile : {BodyType::staticBody, BodyType::kinematicBody}) {
    for (const auto& change : changes) {
      const Parts always = build(), now = build();
      space.setType(now.body, meanwhile);
      for (const Parts& of : {always, now}) change(of);
      EXPECT_EQ(space.body(now.body).mass(), S(0));
      space.setType(now.body, BodyType::dynamicBody);
      EXPECT_EQ(space.body(now.body).mass(), space.body(always.body).mass());
      EXPECT_EQ(space.body(now.body).moment(), space.body(always.body).moment());
      EXPECT_EQ(space.body(now.body).centerOfMass(), space.body(always.body).centerOfMass());
      EXPECT_EQ(space.body(now.body).position(), space.body(always.body).position());
    }
  }
}

TYPED_TEST(SpaceMassTest, ABodyMadeWhatItIsKeepsItsMass) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId id = space.add(Body<S>());
  space.add(TestFixture::disc(id, 0, 2));
  space.body(id).setMass(S(9));

  space.setType(id, BodyType::dynamicBody);

  EXPECT_EQ(space.body(id).mass(), S(9));
}

TYPED_TEST(SpaceMassTest, WhatMovesTheCentreOfMassLeavesTheMotionOfTheMaterial) {
  using S = TypeParam;
  using Fixture = TestFixture;
  auto& space = this->space_;
  // A dumb-bell that spins at 10 rad/s about the origin: its right end goes up at 20 m/s.
  const auto build = [&](ShapeId* left) {
    const BodyId id = space.add(Body<S>());
    *left = space.add(Fixture::disc(id, -2, 1));
    space.add(Fixture::disc(id, 2, 1));
    space.body(id).setAngularVelocity(S(10));
    return id;
  };
  const Vector<S> end(S(2), S(0)), up(S(0), S(20)), still;
  const std::vector<std::function<void(BodyId, ShapeId)>> losses = {
      [&](BodyId, ShapeId left) { space.remove(left); },
      [&](BodyId, ShapeId left) { this->setMassOfShape(left, 0); },
      [&](BodyId body, ShapeId left) { space.replace(left, circleShape(body, S(1))); },
      [&](BodyId body, ShapeId) { space.body(body).setCenterOfMass(Vector<S>(S(2), S(0))); },
      [&](BodyId body, ShapeId) {
        space.body(body).setMassProperties({S(1), toScaled(S(1)), Vector<S>(S(2), S(0))});
      },
      [&](BodyId body, ShapeId left) {
        space.setType(body, BodyType::kinematicBody);
        space.remove(left);
        space.setType(body, BodyType::dynamicBody);
      }};
  for (const auto& lose : losses) {
    ShapeId left;
    const BodyId id = build(&left);
    lose(id, left);
    EXPECT_EQ(space.body(id).worldCenter(), end);
    EXPECT_EQ(space.body(id).velocity(), up);
    EXPECT_EQ(space.body(id).angularVelocity(), S(10));
    EXPECT_EQ(space.body(id).velocityAt(Vector<S>()), still);
  }
  // Gained on the way back.
  ShapeId left;
  const BodyId id = build(&left);
  space.remove(left);
  space.add(Fixture::disc(id, -2, 1));
  EXPECT_EQ(space.body(id).worldCenter(), Vector<S>());
  EXPECT_EQ(space.body(id).velocity(), still);
}

TYPED_TEST(SpaceMassTest, ACentreOfMassMovedFarOnASpinningBodyIsHeldAtTheSpeedLimit) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  body.setAngularVelocity(kMaxAngularSpeed<S>);
  body.setCenterOfMass({kMaxCenterOfMass<S>, S(0)});
  EXPECT_EQ(body.velocity(), Vector<S>(S(0), kMaxSpeed<S>));
  EXPECT_TRUE(body.wellFormed());
}

TYPED_TEST(SpaceMassTest, ABodyAtRestStaysAtRestWhenItsCentreOfMassMoves) {
  using S = TypeParam;
  auto& space = this->space_;
  const BodyId id = space.add(Body<S>());
  space.add(TestFixture::disc(id, 2, 3));
  EXPECT_EQ(space.body(id).velocity(), Vector<S>());
  EXPECT_EQ(space.body(id).worldCenter(), Vector<S>(S(2), S(0)));
}

/// Two discs deep in each other, which sequential impulses push apart by a bias in the step after.
template <Scalar S>
ShapeId addOverlap(Space<S>& space) {
  space.setSolver(SolverKind::sequentialImpulses);
  space.setCollisionBias(S(0));
  const ShapeId pushed = addDisc<S>(space, {S(0), S(0)}, S(1), S(1));
  addDisc<S>(space, {S(1), S(0)}, S(1), S(1));
  space.step(kTick<S>);
  return pushed;
}

TYPED_TEST(SpaceMassTest, NoBodyMovesByAPushFromWhereItNoLongerIs) {
  using S = TypeParam;
  const Vector<S> far(S(0), S(50));
  using Call = std::function<void(Space<S>&, BodyId)>;
  const std::vector<Call> moves = {
      [&](Space<S>& space, BodyId id) { space.body(id).setPosition(far); },
      [&](Space<S>& space, BodyId id) {
        space.setType(id, BodyType::staticBody);
        space.setType(id, BodyType::dynamicBody);
      },
      [&](Space<S>& space, BodyId id) { space.setType(id, BodyType::kinematicBody); },
      [&](Space<S>& space, BodyId id) { space.body(id).setAngle(S(1)); },
      [&](Space<S>& space, BodyId) {
        space.setSolver(SolverKind::softStep);
        space.setSolver(SolverKind::sequentialImpulses);
      },
      [&](Space<S>& space, BodyId) {
        Settings<S> other = space.settings();
        other.solver = SolverKind::softStep;
        space.setSettings(other);
        other.solver = SolverKind::sequentialImpulses;
        space.setSettings(other);
      }};
  for (const Call& move : moves) {
    Space<S> space;
    const BodyId id = bodyOf(space, addOverlap<S>(space));
    ASSERT_NE(space.body(id).velocityBias(), Vector<S>());
    move(space, id);
    EXPECT_EQ(space.body(id).velocityBias(), Vector<S>());
    EXPECT_EQ(space.body(id).angularVelocityBias(), S(0));
    const Vector<S> before = space.body(id).position();
    space.step(kTick<S>);
    EXPECT_EQ(space.body(id).position(), before);
  }
}

TYPED_TEST(SpaceMassTest, APushOfTheLastStepMovesWhatStaysInTheNext) {
  using S = TypeParam;
  Space<S> space;
  const BodyId id = bodyOf(space, addOverlap<S>(space));
  const Vector<S> before = space.body(id).position();
  space.step(kTick<S>);
  EXPECT_LT(space.body(id).position().x, before.x);
}

}  // namespace
}  // namespace samestep
