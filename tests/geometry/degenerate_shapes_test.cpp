// SPDX-License-Identifier: MIT
// The collision routines on the shapes and poses of the degenerate library, and what fuzzing found in them.
#include "study/degenerate_shapes.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/collision.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class DegenerateShapesTest : public ::testing::Test {
 protected:
  static constexpr bool kIsDouble = !kIsFixed<S>;

  static CollisionInfo<S> touch(const Shape<S>& a, const Transform<S>& poseA, const Shape<S>& b,
                                const Transform<S>& poseB, S margin = S(0)) {
    const Placement<S> placedA(a, poseA), placedB(b, poseB);
    return collide(*placedA, *placedB, 0, nullptr, margin);
  }
  static void expectUnitNormal(const CollisionInfo<S>& info) {
    EXPECT_LE(abs(lengthSq(info.normal) - S(1)), S(0x1p-29));
  }
  static S depth(const CollisionInfo<S>& info, int i) {
    return dot(info.points[i].pointB - info.points[i].pointA, info.normal);
  }
  /// Expects at least one point, and that its two places lie opposite each other, along the normal.
  static void expectOpposite(const CollisionInfo<S>& info, double tolerance = 1e-5) {
    EXPECT_GE(info.count, 1);
    for (int i = 0; i < info.count; ++i) {
      const Vector<S> apart = info.points[i].pointB - info.points[i].pointA;
      EXPECT_NEAR(static_cast<double>(cross(apart, info.normal)), 0, tolerance);
    }
  }
  static Shape<S> hull(std::initializer_list<RawPoint> points, S radius = S(0)) {
    std::vector<Vector<S>> vertices;
    for (const RawPoint& p : points) vertices.push_back(fromUnits<S>(p));
    return polyShape<S>(BodyId(), vertices, Transform<S>(), radius);
  }
  static Shape<S> raw(std::initializer_list<RawPoint> points) {
    std::vector<Vector<S>> vertices;
    for (const RawPoint& p : points) vertices.push_back(fromUnits<S>(p));
    return polyShapeRaw<S>(BodyId(), vertices);
  }
};
TYPED_TEST_SUITE(DegenerateShapesTest, AllScalarsAndChecked);

TYPED_TEST(DegenerateShapesTest, EachShapeIsAccepted) {
  using S = TypeParam;
  for (const NastyShape& shape : nastyShapes()) {
    EXPECT_EQ(makeNasty<S>(shape).vertices().size() >= 1, true) << shape.name;
    EXPECT_EQ(findNastyShape(shape.name), &shape - nastyShapes().data());
  }
  EXPECT_EQ(findNastyShape("nothing of that name"), -1);
}

TYPED_TEST(DegenerateShapesTest, EachPairTouchesOrNotAsItSaysInBothOrders) {
  using S = TypeParam;
  for (const NastyPair& pair : nastyPairs()) {
    const Shape<S> a = makeNasty<S>(nastyShapes()[static_cast<std::size_t>(pair.shapeA)]);
    const Shape<S> b = makeNasty<S>(nastyShapes()[static_cast<std::size_t>(pair.shapeB)]);
    const S margin = pair.touches ? S(0x1p-20) : S(0);
    const CollisionInfo<S> info = TestFixture::touch(a, poseAOf<S>(pair), b, poseBOf<S>(pair), margin);
    const CollisionInfo<S> turned = TestFixture::touch(b, poseBOf<S>(pair), a, poseAOf<S>(pair), margin);
    EXPECT_EQ(info.count > 0, pair.touches) << pair.name;
    EXPECT_EQ(turned.count > 0, pair.touches) << pair.name;
    if (info.count > 0) TestFixture::expectUnitNormal(info);
    if (turned.count > 0) TestFixture::expectUnitNormal(turned);
  }
}

// The nearest edge is found by rounded distances: of two nearly parallel ones it may be the wrong one, and
// its end is then far from the circle.
TYPED_TEST(DegenerateShapesTest, CircleAtTheTipOfANeedleTouchesIt) {
  using S = TypeParam;
  const Shape<S> needle =
      TestFixture::hull({{0, 506806140928}, {32, 506806141003}, {107, -506806141003}, {-107, 4398046511017}});
  const Shape<S> circle = circleShape<S>(BodyId(), S(0));
  const Transform<S> atTip = Transform<S>::translation(fromUnits<S>({-107, 4398046511017}));
  EXPECT_EQ(TestFixture::touch(needle, Transform<S>(), circle, atTip, S(1)).count, 1);
}

// Before a thin corner all edges are within rounding of the point, however far off it is.
TYPED_TEST(DegenerateShapesTest, CircleFarBeforeTheTipOfABladeDoesNotTouchIt) {
  using S = TypeParam;
  const Shape<S> blade = makeNasty<S>(nastyShapes()[static_cast<std::size_t>(findNastyShape("blade"))]);
  const Shape<S> circle = circleShape<S>(BodyId(), S(1));
  for (const int apart : {2, 20, 200}) {
    const Transform<S> before = Transform<S>::translation({S(64 + apart), S(0)});
    EXPECT_EQ(TestFixture::touch(blade, Transform<S>(), circle, before).count, 0) << apart;
  }
}

// Turned by some units, its edges are in line and its normals are not: all say that the centre is inside.
TYPED_TEST(DegenerateShapesTest, CircleRoundTheTipOfASliverTurnedInsideOutIsPushedOffTheTip) {
  using S = TypeParam;
  const Shape<S> sliver = TestFixture::hull({{32, 32}, {2611340116437, -1}, {78, 32}});
  const Shape<S> circle = circleShape<S>(BodyId(), S(14958));
  const Transform<S> turned =
      Transform<S>::rigid(fromUnits<S>(RawPoint{16, 16}), fromUnits<S>(std::int64_t{78}));
  const Transform<S> before = Transform<S>::translation(fromUnits<S>(RawPoint{-1786706394652, 15}));
  const CollisionInfo<S> info = TestFixture::touch(sliver, turned, circle, before);
  ASSERT_EQ(info.count, 1);
  EXPECT_NEAR(static_cast<double>(info.normal.x), -1, 1e-9);
  EXPECT_NEAR(static_cast<double>(dot(info.points[0].pointB - info.points[0].pointA, info.normal)),
              416 - 14958, 1e-5);
}

// All their edges are in one line to some units. By rounded distances the end of the sliver was nearest to
// the segment, 938 m before the segment begins, and there they were said to touch.
TYPED_TEST(DegenerateShapesTest, SliverAndSegmentInOneLineTouchWhereBothAre) {
  using S = TypeParam;
  const std::int64_t metre = std::int64_t{1} << 32;
  const Shape<S> sliver =
      polyShapeRaw<S>(BodyId(),
                      std::vector<Vector<S>>{fromUnits<S>({-1, -8430215495680}), fromUnits<S>({32, 78}),
                                             fromUnits<S>({32, 608 * metre + 469}), fromUnits<S>({-1, 32})},
                      fromUnits<S>(std::int64_t{64}));
  const Shape<S> segment =
      segmentShape<S>(BodyId(), fromUnits<S>({0, 2465}), fromUnits<S>({92, 1024 * metre - 86}));
  const CollisionInfo<S> info =
      TestFixture::touch(sliver, Transform<S>::translation(fromUnits<S>({0, 13})), segment,
                         Transform<S>(S(-1), S(0), S(0), S(-1), fromUnits<S>(std::int64_t{105}),
                                      fromUnits<S>(std::int64_t{2616})));
  ASSERT_GE(info.count, 1);
  for (int i = 0; i < info.count; ++i) {
    EXPECT_GE(static_cast<double>(info.points[i].pointB.y), -1024 - 1e-5);
    EXPECT_LE(static_cast<double>(info.points[i].pointA.y), 1e-5);
    EXPECT_NEAR(static_cast<double>(info.points[i].pointA.y - info.points[i].pointB.y), 0, 1e-5);
  }
}

// The segment lies along the longest edge of the polygon, whose vertices below it are a unit farther out. The
// vertex named nearest was the one at the top, 43 m beyond the end of the segment.
TYPED_TEST(DegenerateShapesTest, SegmentAlongAnEdgeTouchesItWhereBothAre) {
  using S = TypeParam;
  const Shape<S> polygon = TestFixture::raw(
      {{-1, -7327119612}, {874591712747, 7327}, {1019765687664, 883364052277}, {0, 1019698578800}, {-1, 0}});
  const Shape<S> segment =
      segmentShape<S>(BodyId(), fromUnits<S>({-9, -71}), fromUnits<S>({0, 834863265259}));
  for (const CollisionId start : {0u, 0xeu}) {
    const Placement<S> a(segment, Transform<S>()), b(polygon, Transform<S>());
    const CollisionInfo<S> info = collide(*a, *b, start);
    if constexpr (kIsFixed<S>) {
      EXPECT_GE(info.count, 1);
    }
    for (int i = 0; i < info.count; ++i) {
      EXPECT_LE(static_cast<double>(info.points[i].pointA.y), 194.4);
      EXPECT_NEAR(static_cast<double>(info.points[i].pointA.y - info.points[i].pointB.y), 0, 1e-5);
    }
  }
}

// Its own edges are some units too far from the segment, the one that was named ends 988 m before its tip.
TYPED_TEST(DegenerateShapesTest, SegmentBesideThreeEdgesInOneLineTouchesWhereBothAre) {
  using S = TypeParam;
  const Vector<S> down(S(0), S(-1));
  const Shape<S> polygon = TestFixture::raw(
      {{-1, -21500}, {0, -8430215495680}, {77309411328, 0}, {0, 137438955613}, {-1, 2424307712}});
  const Shape<S> segment =
      segmentShape<S>(BodyId(), fromUnits<S>({0, 2465}), fromUnits<S>({92, 4398046511018}));
  const Placement<S> a(segment, Transform<S>::rigid(fromUnits<S>({21474775, 173}), down)),
      b(polygon, Transform<S>::rigid(fromUnits<S>({17201367913, 171}), down));
  for (const CollisionInfo<S>& info : {collide(*a, *b), collide(*b, *a), collide(*a, *b, 0x1000u)}) {
    for (int i = 0; i < info.count; ++i) {
      EXPECT_LE(static_cast<double>(info.points[i].pointB.x), 36.1);
      EXPECT_NEAR(static_cast<double>(info.points[i].pointA.x - info.points[i].pointB.x), 0, 1e-5);
    }
  }
}

// Beside each other by a micrometre, in one line, 448 m apart: at 16 km the rounding of a normal is more than
// that, and by its faces one seemed to overlap the other.
TYPED_TEST(DegenerateShapesTest, LongSliversInOneLineFarApartDoNotTouch) {
  using S = TypeParam;
  const Shape<S> sliver = TestFixture::raw({{-4225, -67894843015083}, {-1, 1}, {-1, 1048575999}});
  const Transform<S> turned(S(-1), S(0), S(0), S(-1), fromUnits<S>(std::int64_t{-4225}),
                            fromUnits<S>(std::int64_t{1924145349672}));
  EXPECT_EQ(TestFixture::touch(sliver, Transform<S>(), sliver, turned, S(1)).count, 0);
}

// Rounded, an edge of one unit is turned by any angle against its normal. It seemed to lie opposite the other
// tip, and its normal was taken for the way there: 0.24 rad and 28 mm off.
TYPED_TEST(DegenerateShapesTest, TipsOfTwoSliversAreApartByTheWayFromOneToTheOther) {
  using S = TypeParam;
  const Shape<S> sliver = polyShapeRaw<S>(
      BodyId(), std::vector<Vector<S>>{fromUnits<S>({-1, -1}), fromUnits<S>({1002438656, -59649}),
                                       fromUnits<S>({0, -1})});
  const auto turned = [](std::int64_t angle) { return forAngle(fromUnits<S>(angle)); };
  const std::int64_t at = 1936946035;
  const CollisionInfo<S> info =
      TestFixture::touch(sliver, Transform<S>::rigid(fromUnits<S>({at, at}), rperp(turned(at))), sliver,
                         Transform<S>::rigid(fromUnits<S>({2 * at, 2 * at}), perp(turned(2096329587))), S(1));
  ASSERT_GE(info.count, 1);
  const double apart = static_cast<double>(dot(info.points[0].pointB - info.points[0].pointA, info.normal));
  EXPECT_NEAR(apart, at * 0x1p-32 * 1.4142135623730951, 1e-8);
}

// Two edges of each are in one line, and rounding preferred the one that ends before the other needle: a
// place 1 km from the crossing.
TYPED_TEST(DegenerateShapesTest, NeedlesThatCrossTouchWhereTheyCross) {
  using S = TypeParam;
  const Shape<S> needle =
      TestFixture::raw({{-4225, 67894843015287}, {-1, -94489280512}, {-1, 4294967295914}});
  const Vector<S> upright = forAngle(fromUnits<S>(std::int64_t{-4449}));
  const Vector<S> at = fromUnits<S>({-4335, -72842645340165});
  const CollisionInfo<S> info = TestFixture::touch(needle, Transform<S>::rigid(at, rperp(upright)), needle,
                                                   Transform<S>::rigid(at, upright), S(1));
  TestFixture::expectOpposite(info, 1e-3);
  EXPECT_NEAR(static_cast<double>(TestFixture::depth(info, 0)), -22, 1e-3);
}

// The needles are as wide as one unit: the edges found nearest were the same one, which does not face itself.
TYPED_TEST(DegenerateShapesTest, CoincidentNeedlesTouchAtPlacesOppositeEachOther) {
  using S = TypeParam;
  const Shape<S> needle = TestFixture::raw({{-1, 151682926}, {0, -113816633346}, {-1, 313532612608}});
  const Transform<S> pose(S(-1), S(0), S(0), S(-1), fromUnits<S>(std::int64_t{-4284229877760}),
                          fromUnits<S>(std::int64_t{-4962834710528}));
  TestFixture::expectOpposite(TestFixture::touch(needle, pose, needle, pose, S(1)));
}

// The edge that the polygon is 5 m deep in begins beside another of one unit, whose end is as near: that one
// was taken, for a depth of nothing.
TYPED_TEST(DegenerateShapesTest, EdgeBesideDustIsTheOneThatTouches) {
  using S = TypeParam;
  std::vector<Vector<S>> round;
  for (int i = 0; i < 28; ++i) round.push_back(forAngle(S(i) * kPi<S> / S(14)) * S(209));
  const Shape<S> polygon = polyShapeRaw<S>(BodyId(), round);
  const Shape<S> blade = TestFixture::raw({{-515396075520, -515396075506},
                                           {12369, -12370},
                                           {-2048, 36238786560},
                                           {-515396075520, -515396075505}});
  const CollisionInfo<S> info =
      TestFixture::touch(polygon, Transform<S>(S(-1), S(0), S(0), S(-1), S(-47), ratio<S>(135, 16)), blade,
                         Transform<S>::rigid(fromUnits<S>({559462215085, 752257228312}),
                                             forAngle(fromUnits<S>(std::int64_t{4294967295914}))));
  TestFixture::expectOpposite(info);
  EXPECT_NEAR(static_cast<double>(min(TestFixture::depth(info, 0), TestFixture::depth(info, 1))), -5.13252,
              1e-5);
}

// Either of the two halves of the upper edge may be found best, which are all but in one line.
TYPED_TEST(DegenerateShapesTest, BoxDeepInEitherHalfOfAnEdgeTouchesBelowItself) {
  using S = TypeParam;
  const Shape<S> floor = polyShapeRaw<S>(
      BodyId(),
      std::vector<Vector<S>>{
          {S(-4), S(-2)}, {S(4), S(-2)}, {S(4), S(0)}, {ratio<S>(1, 2), S(0x1p-30)}, {S(-4), S(0)}});
  const Shape<S> box = boxShape<S>(BodyId(), S(1), S(1));
  for (const int x : {-3, -2, 2, 3}) {
    const Transform<S> pose = Transform<S>::translation({S(x), ratio<S>(1, 4)});
    for (const CollisionInfo<S>& info : {TestFixture::touch(floor, Transform<S>(), box, pose),
                                         TestFixture::touch(box, pose, floor, Transform<S>())}) {
      ASSERT_EQ(info.count, 2);
      TestFixture::expectOpposite(info);
      EXPECT_NEAR(static_cast<double>(TestFixture::depth(info, 0)), -0.25, 1e-8);
      EXPECT_NEAR(static_cast<double>(abs(info.points[0].pointA.x - info.points[1].pointA.x)), 1, 1e-8) << x;
    }
  }
}

TYPED_TEST(DegenerateShapesTest, BladesFarBeforeEachOthersTipsDoNotTouch) {
  using S = TypeParam;
  const Shape<S> blade = makeNasty<S>(nastyShapes()[static_cast<std::size_t>(findNastyShape("blade"))]);
  for (const int units : {0, 1, 2}) {
    const Transform<S> before = Transform<S>::translation({S(140), fromUnits<S>(units)});
    EXPECT_EQ(TestFixture::touch(blade, Transform<S>(), blade, before).count, 0) << units;
  }
}

}  // namespace
}  // namespace samestep
