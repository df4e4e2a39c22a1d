// SPDX-License-Identifier: MIT
#include <samestep/shape.h>

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/error.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "support/random.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class ShapeTest : public ::testing::Test {
 protected:
  static Vector<S> at(int x, int y) { return {S(x), S(y)}; }
  static Shape<S> box() { return boxShape<S>(BodyId{3, 1}, S(2), S(4)); }
};
TYPED_TEST_SUITE(ShapeTest, AllScalarsAndChecked);

TYPED_TEST(ShapeTest, NewShapeHasNoMassNoSurfaceAndMeetsEverything) {
  using S = TypeParam;
  const Shape<S> shape = TestFixture::box();
  EXPECT_EQ(shape.body(), (BodyId{3, 1}));
  EXPECT_FALSE(shape.id().valid());
  EXPECT_EQ(shape.id().space, 0u);
  EXPECT_EQ(shape.mass(), S(0));
  EXPECT_EQ(shape.elasticity(), S(0));
  EXPECT_EQ(shape.friction(), S(0));
  EXPECT_EQ(shape.surfaceVelocity(), Vector<S>());
  EXPECT_EQ(shape.collisionType(), kWildcardCollisionType);
  EXPECT_EQ(shape.filter(), ShapeFilter());
  EXPECT_FALSE(shape.sensor());
  EXPECT_EQ(shape.userData(), 0u);
}

// MIS section 5, shapeSetMass.
TYPED_TEST(ShapeTest, SetMassGivesMomentAndDensity) {
  using S = TypeParam;
  Shape<S> shape = TestFixture::box();
  shape.setMass(S(6));
  EXPECT_EQ(shape.mass(), S(6));
  EXPECT_EQ(shape.area(), S(8));
  EXPECT_EQ(shape.density(), ratio<S>(3, 4));
  EXPECT_EQ(momentForBox<S>(S(6), S(2), S(4)), S(10));
  EXPECT_LE(abs(shape.moment() - S(10)), S(0x1p-32));  // A sum over triangles: not exact in double.
  EXPECT_EQ(shape.centerOfMass(), Vector<S>());
}

TYPED_TEST(ShapeTest, SetMassRefusesWhatIsOutOfRangeAndKeepsTheOldMass) {
  using S = TypeParam;
  Shape<S> shape = TestFixture::box();
  shape.setMass(S(1));
  EXPECT_THROW(shape.setMass(S(-1)), NegativeMass);
  EXPECT_THROW(shape.setMass(ratio<S>(1, 2000)), MassOutOfRange);
  EXPECT_THROW(shape.setMass(S(1000001)), MassOutOfRange);
  EXPECT_EQ(shape.mass(), S(1));
  shape.setMass(S(1000000));
  shape.setMass(S(0));
  EXPECT_EQ(shape.mass(), S(0));
}

TYPED_TEST(ShapeTest, SetDensityGivesTheMassOfTheArea) {
  using S = TypeParam;
  Shape<S> shape = TestFixture::box();
  shape.setDensity(S(3));
  EXPECT_EQ(shape.mass(), S(24));
  EXPECT_THROW(shape.setDensity(S(-3)), NegativeMass);
  EXPECT_THROW(shape.setDensity(S(1000000)), MassOutOfRange);
  EXPECT_EQ(shape.mass(), S(24));

  Shape<S> line = segmentShape<S>(BodyId(), Vector<S>(), TestFixture::at(1, 0));
  line.setDensity(S(3));
  EXPECT_EQ(line.mass(), S(0));
  EXPECT_EQ(line.density(), S(0));
}

TYPED_TEST(ShapeTest, SetElasticityRefusesNegativeAndKeepsTheOld) {
  using S = TypeParam;
  Shape<S> shape = TestFixture::box();
  shape.setElasticity(ratio<S>(1, 2));
  EXPECT_THROW(shape.setElasticity(S(-1)), NegativeElasticity);
  EXPECT_THROW(shape.setElasticity(S(kMaxMaterial + 1)), ValueOutOfRange);
  EXPECT_EQ(shape.elasticity(), ratio<S>(1, 2));
}

TYPED_TEST(ShapeTest, SetFrictionRefusesNegativeAndKeepsTheOld) {
  using S = TypeParam;
  Shape<S> shape = TestFixture::box();
  shape.setFriction(ratio<S>(3, 4));
  EXPECT_THROW(shape.setFriction(S(-1)), NegativeFriction);
  EXPECT_THROW(shape.setFriction(S(kMaxMaterial + 1)), ValueOutOfRange);
  EXPECT_EQ(shape.friction(), ratio<S>(3, 4));
}

TYPED_TEST(ShapeTest, SetSurfaceVelocityRefusesAboveTheSpeedLimit) {
  using S = TypeParam;
  Shape<S> shape = TestFixture::box();
  shape.setSurfaceVelocity(TestFixture::at(1024, -1024));
  EXPECT_THROW(shape.setSurfaceVelocity(TestFixture::at(0, 1025)), ValueOutOfRange);
  EXPECT_EQ(shape.surfaceVelocity(), TestFixture::at(1024, -1024));
}

TYPED_TEST(ShapeTest, PlainSettersKeepWhatTheyAreGiven) {
  using S = TypeParam;
  Shape<S> shape = TestFixture::box();
  shape.setCollisionType(7);
  shape.setFilter({1, 2, 4});
  shape.setSensor(true);
  shape.setUserData(~std::uint64_t{0});
  shape.setBody(BodyId{9, 9});
  EXPECT_EQ(shape.collisionType(), 7u);
  EXPECT_EQ(shape.filter(), (ShapeFilter{1, 2, 4}));
  EXPECT_TRUE(shape.sensor());
  EXPECT_EQ(shape.userData(), ~std::uint64_t{0});
  EXPECT_EQ(shape.body(), (BodyId{9, 9}));
}

TEST(ShapeFilterTest, GroupsCategoriesAndMasksDecideBothWays) {
  const ShapeFilter all;
  EXPECT_TRUE(accepts(all, all));
  EXPECT_FALSE(accepts({5, ~0u, ~0u}, {5, ~0u, ~0u}));
  EXPECT_TRUE(accepts({5, ~0u, ~0u}, {6, ~0u, ~0u}));
  EXPECT_FALSE(accepts({0, 1, ~0u}, {0, ~0u, 2}));
  EXPECT_FALSE(accepts({0, ~0u, 2}, {0, 1, ~0u}));
  EXPECT_TRUE(accepts({0, 1, 2}, {0, 2, 1}));
}

TYPED_TEST(ShapeTest, AttachedShapeCarriesItsIdAndDetachedDropsIt) {
  using S = TypeParam;
  Shape<S> shape = TestFixture::box();
  shape.attach(ShapeId{4, 2, 77});
  EXPECT_EQ(shape.id(), (ShapeId{4, 2}));
  EXPECT_EQ(shape.id().space, 77u);
  EXPECT_EQ(shape.detached(), TestFixture::box());
}

TYPED_TEST(ShapeTest, EveryFieldIsVisitedByName) {
  using S = TypeParam;
  const Shape<S> shape = TestFixture::box();
  std::set<std::string> names;
  int count = 0;
  Shape<S>::fields(shape, [&](const char* name, const auto&) {
    names.insert(name);
    ++count;
  });
  EXPECT_EQ(names.size(), 20u);
  EXPECT_EQ(count, 19 + 4);  // Four vertices.
}

TYPED_TEST(ShapeTest, ExtentReachesTheFarthestPoint) {
  using S = TypeParam;
  EXPECT_EQ(circleShape<S>(BodyId(), S(2), TestFixture::at(3, 4)).extent(), S(7));
  EXPECT_EQ(segmentShape<S>(BodyId(), TestFixture::at(1, 0), TestFixture::at(-3, -4), S(1)).extent(), S(6));
  EXPECT_EQ(boxShape<S>(BodyId(), S(6), S(8), S(1)).extent(), S(6));
}

TYPED_TEST(ShapeTest, WhatTheFactoriesMakeIsWellFormed) {
  using S = TypeParam;
  Shape<S> box = TestFixture::box();
  box.setMass(S(5));
  EXPECT_TRUE(Shape<S>().wellFormed());
  EXPECT_TRUE(box.wellFormed());
  EXPECT_TRUE(circleShape<S>(BodyId(), S(2), TestFixture::at(1, 1)).wellFormed());
  Shape<S> line = segmentShape<S>(BodyId(), TestFixture::at(0, 0), TestFixture::at(1, 0), S(1));
  SegmentShape<S>(line).setNeighbors(TestFixture::at(-1, 1), TestFixture::at(2, 0));
  EXPECT_TRUE(line.wellFormed());
}

TYPED_TEST(ShapeTest, ChangedBytesAreNotWellFormed) {
  using S = TypeParam;
  const auto spoiled = [](const char* wanted, auto change) {
    Shape<S> shape = TestFixture::box();
    int seen = 0;
    Shape<S>::fields(shape, [&](const char* name, auto& field) {
      if (std::string(name) == wanted && seen++ == 0) change(field);
    });
    return shape.wellFormed();
  };
  const auto set = [](auto value) {
    return [value](auto& field) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(field)>,
                                   std::remove_cvref_t<decltype(value)>>)
        field = value;
    };
  };
  EXPECT_FALSE(spoiled("count", set(std::uint8_t{5})));
  EXPECT_FALSE(spoiled("count", set(std::uint8_t{200})));
  EXPECT_FALSE(spoiled("count", set(std::uint8_t{0})));
  EXPECT_FALSE(spoiled("type", set(static_cast<ShapeType>(9))));
  EXPECT_FALSE(spoiled("type", set(ShapeType::circle)));
  EXPECT_FALSE(spoiled("sensor", set(std::uint8_t{2})));
  EXPECT_FALSE(spoiled("radius", set(S(-1))));
  EXPECT_FALSE(spoiled("radius", set(S(kMaxExtent))));
  EXPECT_FALSE(spoiled("mass", set(S(-1))));
  EXPECT_FALSE(spoiled("friction", set(S(-1))));
  EXPECT_FALSE(spoiled("elasticity", set(S(kMaxMaterial + 1))));
  EXPECT_FALSE(spoiled("surfaceVelocity", set(Vector<S>(S(2000), S(0)))));
  EXPECT_FALSE(spoiled("centroid", set(Vector<S>(S(1), S(0)))));
  EXPECT_FALSE(spoiled("vertex", set(Vector<S>(S(0), S(0)))));
  EXPECT_TRUE(spoiled("userData", set(std::uint64_t{1})));
}

// MIS section 5, shapeUpdate and shapeCacheBB.
TYPED_TEST(ShapeTest, PlaceMovesEachTypeAndReturnsItsBox) {
  using S = TypeParam;
  const Transform<S> quarter = Transform<S>::rigid(TestFixture::at(10, 20), Vector<S>(S(0), S(1)));
  EXPECT_EQ(boundingBox(circleShape<S>(BodyId(), S(2), TestFixture::at(3, 0)), quarter),
            BB<S>(S(8), S(21), S(12), S(25)));
  EXPECT_EQ(
      boundingBox(segmentShape<S>(BodyId(), TestFixture::at(-2, 0), TestFixture::at(4, 1), S(1)), quarter),
      BB<S>(S(8), S(17), S(11), S(25)));
  EXPECT_EQ(boundingBox(TestFixture::box(), quarter), BB<S>(S(8), S(19), S(12), S(21)));
}

TYPED_TEST(ShapeTest, PlacedNormalsPointOutAndTurnWithThePose) {
  using S = TypeParam;
  const Placement<S> box(TestFixture::box(), Transform<S>::rigid(Vector<S>(), Vector<S>(S(0), S(1))));
  // The first vertex is the bottom right one; the edge that ends there is the lower one, turned to the right.
  EXPECT_EQ(box->planes[0].v0, TestFixture::at(2, 1));
  EXPECT_EQ(box->planes[0].n, TestFixture::at(1, 0));
  EXPECT_EQ(box->planes[1].n, TestFixture::at(0, 1));
}

TYPED_TEST(ShapeTest, PreparedShapeIsMovedAgainWithoutTheShape) {
  using S = TypeParam;
  const Shape<S> shape = TestFixture::box();
  std::vector<Plane<S>> planes(static_cast<std::size_t>(planeCount(shape))), local = planes;
  PlacedShape<S> placed;
  placed.planes = planes.data();
  prepare(shape, local.data(), placed);
  for (int i = 0; i < 4; ++i) {
    const Transform<S> pose = Transform<S>::rigid(TestFixture::at(i, -i), S(i));
    EXPECT_EQ(place(pose, placed), boundingBox(shape, pose));
  }
}

// Half the planes of a box around its origin are computed.
TYPED_TEST(ShapeTest, EachPlaneOfABoxIsMovedByThePoseToTheLastBit) {
  using S = TypeParam;
  Random random(11);
  for (int round = 0; round < 200; ++round) {
    const Shape<S> shape = boxShape<S>(BodyId(), random.number<S>(1, 4), random.number<S>(1, 4));
    const Transform<S> pose = Transform<S>::rigid({random.number<S>(-100, 100), random.number<S>(-100, 100)},
                                                  random.number<S>(-4, 4));
    const Placement<S> box(shape, pose);
    BB<S> around(box->planes[0].v0.x, box->planes[0].v0.y, box->planes[0].v0.x, box->planes[0].v0.y);
    for (int i = 0; i < box->count; ++i) {
      EXPECT_EQ(box->planes[i].v0, transformPoint(pose, shape.vertices()[static_cast<std::size_t>(i)]));
      EXPECT_EQ(box->planes[i].n, transformVect(pose, box->local[i].n));
      around = expand(around, box->planes[i].v0);
    }
    EXPECT_EQ(box->box, around);
  }
}

TYPED_TEST(ShapeTest, PlaneCountIsWhatEachTypeNeeds) {
  using S = TypeParam;
  EXPECT_EQ(planeCount(circleShape<S>(BodyId(), S(1))), 1);
  EXPECT_EQ(planeCount(segmentShape<S>(BodyId(), Vector<S>(), TestFixture::at(1, 0))), 3);
  EXPECT_EQ(planeCount(TestFixture::box()), 4);
}

#ifndef SAMESTEP_FIXED_ONLY
TEST(ShapeDoubleTest, SettersRefuseWhatIsNotFiniteAndKeepTheOld) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  Shape<double> shape = boxShape<double>(BodyId(), 1, 1);
  const Shape<double> before = shape;
  EXPECT_THROW(shape.setMass(nan), NaNMass);
  EXPECT_THROW(shape.setMass(inf), InfiniteMass);
  EXPECT_THROW(shape.setMass(-inf), NegativeMass);
  EXPECT_THROW(shape.setDensity(nan), ValueOutOfRange);
  EXPECT_THROW(shape.setElasticity(nan), ValueOutOfRange);
  EXPECT_THROW(shape.setFriction(inf), ValueOutOfRange);
  EXPECT_THROW(shape.setSurfaceVelocity({0, nan}), ValueOutOfRange);
  EXPECT_EQ(shape, before);
}
#endif

}  // namespace
}  // namespace samestep
