// SPDX-License-Identifier: MIT
#include "contacts/contact_geometry.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <samestep/space.h>
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class ContactGeometryTest : public ::testing::Test {
 public:
  /// A box of 1 m at rest on a floor, in the soft step.
  ContactGeometryTest() {
    space_.setSolver(SolverKind::softStep);
    space_.setGravity({S(0), S(-10)});
    floor_ = space_.add(boxShape<S>(space_.staticBody(), BB<S>(S(-20), S(-1), S(20), S(0))));
    box_ = addBox<S>(space_, {S(0), ratio<S>(1, 2)}, S(1), S(1), S(1));
    for (int i = 0; i < 60; ++i) space_.step(kTick<S>);
  }

  Body<S>& box() { return space_.body(bodyOf(space_, box_)); }
  const Pair<S>& pair() const { return space_.state().pairs.at(0); }
  /// Anchors of the contacts on the floor, which has its body's origin in that of the world.
  std::vector<Vector<S>> anchors() const {
    std::vector<Vector<S>> all;
    for (int i = 0; i < pair().count; ++i) all.push_back(pair().contacts[i].anchorA);
    return all;
  }
  void handle(bool (*preSolve)(Arbiter<S>&, Space<S>&, void*)) {
    CollisionHandler<S> handler;
    handler.data = this;
    handler.preSolve = preSolve;
    space_.registerHandler(1, handler);
    space_.addDefaultCollisionHandler(1);
  }
  S frictionSeen() {
    S seen(-1);
    space_.eachArbiter([&](Arbiter<S>& arbiter) { seen = arbiter.friction(); });
    return seen;
  }

  Space<S> space_;
  ShapeId floor_, box_;
  int calls_ = 0;
};
TYPED_TEST_SUITE(ContactGeometryTest, AllScalarsAndChecked);

TYPED_TEST(ContactGeometryTest, TheRelativePoseIsThatOfTheMirrorImage) {
  using S = TypeParam;
  const Frame<S> a{{ratio<S>(7, 3), S(-2)}, forAngle(ratio<S>(2, 7))};
  const Frame<S> b{{ratio<S>(22, 7), ratio<S>(-8, 3)}, forAngle(S(2))};
  const auto image = [](const Frame<S>& f) {
    return Frame<S>{{-f.origin.x, f.origin.y}, {f.rotation.x, -f.rotation.y}};
  };
  const RelativePose pose = relativePose(a, b), mirrored = relativePose(image(a), image(b));
  EXPECT_EQ(mirrored.x, -pose.x);
  EXPECT_EQ(mirrored.y, pose.y);
  // The cosine is the smaller one, and the sine has another sign.
  EXPECT_EQ(mirrored.turn, pose.turn ^ 1);
  const Frame<S> near{b.origin, forAngle(S(1))}, nearImage = image(near);
  const auto sine = [](std::uint32_t turn) { return static_cast<std::int32_t>(turn) >> 2; };
  EXPECT_EQ(sine(relativePose(image(a), nearImage).turn), -sine(relativePose(a, near).turn));
}

TYPED_TEST(ContactGeometryTest, SteadyMeansThatNoPointMovedByMoreThanAMillimetre) {
  using S = TypeParam;
  const S unit = ratio<S>(1, kPoseUnits);
  const int most = kSteadyUnits;
  EXPECT_LT(most * double(unit), 1e-3);
  const auto isSteady = [&](int x, int y, int angle, int reach) {
    const Frame<S> still{{S(3), S(4)}, {S(1), S(0)}};
    const Frame<S> moved{{S(3) + unit * S(x), S(4) + unit * S(y)}, forAngle(unit * S(angle))};
    return steady(relativePose(Frame<S>{}, moved), relativePose(Frame<S>{}, still), reach * kReachUnits);
  };
  EXPECT_TRUE(isSteady(0, 0, 0, 1));
  EXPECT_TRUE(isSteady(most / 2, -most / 2, 0, 1));
  EXPECT_TRUE(isSteady(most - 3, 0, 0, 1));
  EXPECT_FALSE(isSteady(most, 0, 0, 1));
  EXPECT_FALSE(isSteady(0, -most, 0, 1));
  EXPECT_FALSE(isSteady(3 * most / 4, 3 * most / 4, 0, 1));
  EXPECT_TRUE(isSteady(0, 0, most / 2, 1));
  EXPECT_FALSE(isSteady(0, 0, most / 2, 2));
  EXPECT_FALSE(isSteady(0, 0, -most, 1));
  EXPECT_FALSE(isSteady(most / 2, 0, -most / 2, 1));
  EXPECT_FALSE(isSteady(0, 0, 3 * kPoseUnits, 1));
}

// The point that moved is the one that is farthest away, whatever the pose is and however long the shape.
TYPED_TEST(ContactGeometryTest, ALongShapeIsSteadyWithinAMillimetreToo) {
  using S = TypeParam;
  int held = 0, moved = 0;
  for (const int reach : {1, 2, 7, 30, 126, 1000}) {
    for (int i = 0; i < 200; ++i) {
      const S angle = ratio<S>(i, 31), turn = ratio<S>(i % 20 + 1, 10000 * reach);
      const Frame<S> still{{S(3), S(4)}, forAngle(angle)};
      const Frame<S> turned{{S(3) + ratio<S>(i % 3, 4096), S(4)}, forAngle(angle + turn)};
      const bool isSteady =
          steady(relativePose(Frame<S>{}, turned), relativePose(Frame<S>{}, still), reach * kReachUnits);
      const double way = double(turn) * reach + double(turned.origin.x - still.origin.x);
      EXPECT_TRUE(!isSteady || way <= 1e-3) << reach << " m, step " << i;
      held += isSteady && turn * S(reach) > ratio<S>(1, 4096);
      moved += !isSteady;
    }
  }
  // Small turns of long shapes are told from none.
  EXPECT_GT(held, 100);
  EXPECT_GT(moved, 100);
}

TYPED_TEST(ContactGeometryTest, AQuarterTurnIsNotSteady) {
  using S = TypeParam;
  for (const S turn : {kPi<S> * ratio<S>(1, 2), kPi<S>, -kPi<S> * ratio<S>(1, 2)}) {
    const Frame<S> still{{S(3), S(4)}, {S(1), S(0)}};
    const Frame<S> turned{{S(3), S(4)}, forAngle(turn)};
    EXPECT_FALSE(steady(relativePose(Frame<S>{}, turned), relativePose(Frame<S>{}, still), 1));
  }
}

// A box and the face of another, turned by an eighth, before its corner: their boxes overlap. It is moved
// towards the corner by less than a tolerance at a time.
TYPED_TEST(ContactGeometryTest, ShapesThatWereApartMeetInTime) {
  using S = TypeParam;
  Space<S> space;
  space.setSolver(SolverKind::softStep);
  space.setContactMargin(S(0));
  const ShapeId a = addBox<S>(space, {}, S(1), S(1), S(1));
  const S place = ratio<S>(875, 1024);
  const ShapeId b = addBox<S>(space, {place, place}, S(1), S(1), S(1));
  space.body(bodyOf(space, b)).setAngle(kPi<S> * ratio<S>(1, 4));
  const auto gap = [&] {
    const Vector<S> apart = space.body(bodyOf(space, b)).position() - space.body(bodyOf(space, a)).position();
    return (double(apart.x) + double(apart.y)) * std::sqrt(0.5) - std::sqrt(0.5) - 0.5;
  };
  space.step(kTick<S>);
  ASSERT_EQ(space.state().pairs.size(), 1u);
  const Pair<S>& pair = space.state().pairs[0];
  EXPECT_EQ(pair.manifold, Manifold::apart);
  EXPECT_NEAR(gap(), 1.3e-3, 1e-4);
  for (int i = 0; pair.manifold == Manifold::apart && i < 100; ++i) {
    Body<S>& body = space.body(bodyOf(space, b));
    body.setPosition(body.position() - Vector<S>(ratio<S>(1, 1 << 13), S(0)));
    EXPECT_GT(gap(), -1.1e-3);
    space.step(kTick<S>);
  }
  EXPECT_EQ(pair.manifold, Manifold::touching);
}

TYPED_TEST(ContactGeometryTest, ARestingContactStaysInItsPlaceToTheBit) {
  using S = TypeParam;
  ASSERT_EQ(this->pair().count, 2);
  EXPECT_EQ(this->pair().manifold, Manifold::touching);
  const std::vector<Vector<S>> before = this->anchors();
  this->space_.step(kTick<S>);
  EXPECT_EQ(this->anchors(), before);
  // Half a tolerance aside the points still are where they were found.
  this->box().setPosition(this->box().position() + Vector<S>(ratio<S>(1, 4096), S(0)));
  this->space_.step(kTick<S>);
  EXPECT_EQ(this->anchors(), before);
}

TYPED_TEST(ContactGeometryTest, WhatIsMovedByHandIsCollidedAnew) {
  using S = TypeParam;
  const std::vector<Vector<S>> before = this->anchors();
  const S step = ratio<S>(1, 512);
  this->box().setPosition(this->box().position() + Vector<S>(step, S(0)));
  this->space_.step(kTick<S>);
  ASSERT_EQ(this->pair().count, 2);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(double(this->anchors()[i].x - before[i].x), double(step), 1e-6);
}

TYPED_TEST(ContactGeometryTest, SmallMovesAddUpToACollision) {
  using S = TypeParam;
  const std::vector<Vector<S>> before = this->anchors();
  const S step = ratio<S>(1, 4096);
  for (int i = 0; i < 16; ++i) {
    this->box().setPosition(this->box().position() + Vector<S>(step, S(0)));
    this->space_.step(kTick<S>);
    for (const Vector<S>& anchor : this->anchors()) {
      double nearest = 1;
      for (const Vector<S>& old : before) {
        nearest = std::min(nearest, std::abs(double(anchor.x - old.x) - (i + 1) * double(step)));
      }
      EXPECT_LE(nearest, (kSteadyUnits + 1.0) / kPoseUnits);
    }
  }
}

TYPED_TEST(ContactGeometryTest, ANewShapeIsCollidedAtOnce) {
  using S = TypeParam;
  this->space_.change(this->box_, [](Shape<S>& shape) {
    PolyShape<S>(shape).setVerticesRaw(std::vector<Vector<S>>{{ratio<S>(1, 4), ratio<S>(-1, 2)},
                                                              {ratio<S>(1, 4), ratio<S>(1, 2)},
                                                              {ratio<S>(-1, 4), ratio<S>(1, 2)},
                                                              {ratio<S>(-1, 4), ratio<S>(-1, 2)}});
  });
  this->space_.step(kTick<S>);
  ASSERT_EQ(this->pair().count, 2);
  EXPECT_NEAR(std::abs(double(this->anchors()[0].x - this->anchors()[1].x)), 0.5, 1e-3);
}

TYPED_TEST(ContactGeometryTest, AnotherMarginCollidesAtOnce) {
  using S = TypeParam;
  this->space_.setContactMargin(ratio<S>(1, 100));
  EXPECT_EQ(this->pair().manifold, Manifold::unknown);
  this->space_.step(kTick<S>);
  EXPECT_EQ(this->pair().manifold, Manifold::touching);
}

TYPED_TEST(ContactGeometryTest, SurfacesAreAskedAtOnce) {
  using S = TypeParam;
  EXPECT_EQ(this->frictionSeen(), S(0));
  this->space_.change(this->box_, [](Shape<S>& shape) { shape.setFriction(ratio<S>(1, 2)); });
  this->space_.change(this->floor_, [](Shape<S>& shape) { shape.setFriction(ratio<S>(1, 2)); });
  this->space_.step(kTick<S>);
  EXPECT_EQ(this->frictionSeen(), ratio<S>(1, 4));
  // A value that a visit sets is gone after the next step.
  this->space_.eachArbiter([](Arbiter<S>& arbiter) { arbiter.setFriction(S(7)); });
  EXPECT_EQ(this->frictionSeen(), S(7));
  this->space_.step(kTick<S>);
  EXPECT_EQ(this->frictionSeen(), ratio<S>(1, 4));
  this->space_.change(this->floor_, [](Shape<S>& shape) { shape.setSensor(true); });
  this->space_.step(kTick<S>);
  EXPECT_EQ(this->pair().solved, 0);
}

TYPED_TEST(ContactGeometryTest, ACallbacksPointsAreForOneStep) {
  using S = TypeParam;
  const std::vector<Vector<S>> before = this->anchors();
  this->handle([](Arbiter<S>& arbiter, Space<S>&, void* data) {
    auto* test = static_cast<ContactGeometryTest<S>*>(data);
    if (test->calls_++ > 0) return true;
    ContactPointSet<S> set = arbiter.contactPointSet();
    for (int i = 0; i < set.count; ++i) {
      set.points[i].pointA += Vector<S>(S(1), S(0));
      set.points[i].pointB += Vector<S>(S(1), S(0));
    }
    arbiter.setContactPointSet(set);
    return false;
  });
  this->space_.step(kTick<S>);
  EXPECT_NEAR(double(this->anchors()[0].x - before[0].x), 1, 1e-3);
  this->space_.step(kTick<S>);
  EXPECT_NEAR(double(this->anchors()[0].x - before[0].x), 0, 1e-3);
}

// At a centimetre per second, a sixth of a millimetre per step: a point fixed to the disc would lag behind
// it.
TYPED_TEST(ContactGeometryTest, ARollingDiscIsNotDrivenOn) {
  using S = TypeParam;
  Space<S> space;
  space.setSolver(SolverKind::softStep);
  space.setGravity({S(0), S(-10)});
  const S speed = ratio<S>(1, 100), half = ratio<S>(1, 2);
  const ShapeId floor = space.add(boxShape<S>(space.staticBody(), BB<S>(S(-20), S(-1), S(20), S(0))));
  const ShapeId disc = addDisc<S>(space, {S(0), half}, half, S(1), {speed, S(0)});
  for (const ShapeId id : {floor, disc}) space.change(id, [](Shape<S>& shape) { shape.setFriction(S(1)); });
  Body<S>& body = space.body(bodyOf(space, disc));
  body.setAngularVelocity(-speed / half);
  for (int i = 0; i < 600; ++i) space.step(kTick<S>);
  EXPECT_NEAR(double(body.velocity().x), double(speed), 1e-4);
}

TYPED_TEST(ContactGeometryTest, ASeparationIsExactWhereAContactIsKept) {
  using S = TypeParam;
  const auto depth = [&] {
    S found{};
    this->space_.eachArbiter([&](Arbiter<S>& arbiter) { found = arbiter.depth(0); });
    return found;
  };
  const S before = depth(), lift = ratio<S>(1, 8192);
  this->box().setPosition(this->box().position() + Vector<S>(S(0), lift));
  EXPECT_NEAR(double(depth() - before), double(lift), 1e-9);
}

TYPED_TEST(ContactGeometryTest, AKeptRotationIsThatOfTheBodyToABillionth) {
  using S = TypeParam;
  for (const S angle : {S(0), ratio<S>(1, 3), S(2), S(-3)}) {
    const Vector<S> rotation = forAngle(angle);
    const Vector<S> kept = rotationOf<S>(keptRotation(rotation));
    EXPECT_NEAR(static_cast<double>(kept.x), static_cast<double>(rotation.x), 0x1p-30);
    EXPECT_NEAR(static_cast<double>(kept.y), static_cast<double>(rotation.y), 0x1p-30);
    EXPECT_EQ(keptRotation(Vector<S>(rotation.x, -rotation.y)).y, -keptRotation(rotation).y);
  }
  EXPECT_EQ(rotationOf<S>(keptRotation(Vector<S>(S(1), S(0)))), Vector<S>(S(1), S(0)));
}

// A reach of 4 m: half of 1/128 m in a turn of 1/1024.
TYPED_TEST(ContactGeometryTest, RotationsAreKeptWhileNoPointMovesByMoreThanEightMillimetres) {
  using S = TypeParam;
  const Frame<S> still;
  for (const S sign : {S(1), S(-1)}) {
    for (const bool first : {true, false}) {
      Pair<S> pair;
      const auto follow = [&](S angle) {
        const Frame<S> turned{{}, forAngle(sign * angle)};
        followRotations(pair, first ? turned : still, first ? still : turned, 4 * kReachUnits);
      };
      follow(S(0));
      const Pair<S> before = pair;
      follow(ratio<S>(1, 1024));
      EXPECT_EQ(pair.rotationA, before.rotationA);
      EXPECT_EQ(pair.rotationB, before.rotationB);
      follow(ratio<S>(3, 1024));
      EXPECT_EQ(pair.rotationA, keptRotation(forAngle(first ? sign * ratio<S>(3, 1024) : S(0))));
      EXPECT_EQ(pair.rotationB, keptRotation(forAngle(first ? S(0) : sign * ratio<S>(3, 1024))));
      // By half a turn, whose sine is small again.
      follow(S(3));
      EXPECT_NE(pair.rotationA == before.rotationA, pair.rotationB == before.rotationB);
    }
  }
}

// The board turns by 0.2 rad/s about its middle; its friction and that of the box make a coefficient of 0.36,
// whose angle is 0.3456 rad.
TYPED_TEST(ContactGeometryTest, ABoxOnATiltingBoardSlidesAtItsAngleOfFriction) {
  using S = TypeParam;
  Space<S> space;
  space.setGravity({S(0), S(-10)});
  Body<S> tilting = Body<S>::kinematic();
  tilting.setAngularVelocity(ratio<S>(1, 5));
  const BodyId board = space.add(tilting);
  Shape<S> plate = boxShape<S>(board, S(8), S(1));
  plate.setFriction(ratio<S>(3, 5));
  space.add(plate);
  const ShapeId box = addBox<S>(space, {S(0), ratio<S>(3, 4)}, S(1), ratio<S>(1, 2), S(1));
  space.change(box, [](Shape<S>& shape) { shape.setFriction(ratio<S>(3, 5)); });
  const auto along = [&] {
    return static_cast<double>(space.body(board).toLocal(space.body(bodyOf(space, box)).position()).x);
  };
  for (int i = 0; i < 98; ++i) space.step(kTick<S>);
  EXPECT_NEAR(along(), 0, 0.004);
  for (int i = 0; i < 42; ++i) space.step(kTick<S>);
  EXPECT_LT(along(), -0.02);
}

}  // namespace
}  // namespace samestep
