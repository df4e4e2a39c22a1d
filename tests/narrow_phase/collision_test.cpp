// SPDX-License-Identifier: MIT
#include <samestep/collision.h>

#include <gtest/gtest.h>

#include <type_traits>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/error.h>
#include <samestep/limits.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "narrow_phase/clip.h"
#include "narrow_phase/collision_functions.h"
#include "support/random.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class CollisionTest : public ::testing::Test {
 protected:
  static Vector<S> at(int x, int y) { return {S(x), S(y)}; }
  /// x / 16, y / 16.
  static Vector<S> fine(int x, int y) { return {ratio<S>(x, 16), ratio<S>(y, 16)}; }
  static Transform<S> moved(const Vector<S>& v) { return Transform<S>::translation(v); }
  static Shape<S> unitBox(S radius = S(0)) { return boxShape<S>(BodyId(), S(1), S(1), radius); }
  static Shape<S> wheel(int count, S size) {
    std::vector<Vector<S>> points;
    for (int i = 0; i < count; ++i) points.push_back(forAngle(kPi<S> * ratio<S>(2 * i, count)) * size);
    return polyShape<S>(BodyId(), points);
  }

  static void expectSane(const CollisionInfo<S>& info) {
    ASSERT_GE(info.count, 0);
    ASSERT_LE(info.count, kMaxContactsPerPair);
    if (info.count == 0) return;
    const double x = static_cast<double>(info.normal.x), y = static_cast<double>(info.normal.y);
    EXPECT_NEAR(x * x + y * y, 1.0, 0x1p-29);
    for (int i = 0; i < info.count; ++i) {
      EXPECT_TRUE(within(info.points[i].pointA, S(1 << 21)));
      EXPECT_TRUE(within(info.points[i].pointB, S(1 << 21)));
      // Points push apart along the normal, never sideways by more than the rounding of what was clipped.
      EXPECT_LE(dot(info.points[i].pointB - info.points[i].pointA, info.normal), S(0x1p-20));
    }
  }

  /// A shape of any type about `size` metres across.
  static Shape<S> randomShape(Random& random, int size, bool rounded) {
    const auto point = [&] {
      return Vector<S>(random.number<S>(-size, size), random.number<S>(-size, size));
    };
    const S radius = rounded ? random.number<S>(0, size) * ratio<S>(1, 4) : S(0);
    switch (random.below(3)) {
      case 0:
        return circleShape<S>(BodyId(), random.number<S>(0, size) + ratio<S>(1, 16), point());
      case 1:
        return segmentShape<S>(BodyId(), point(), point() + at(2 * size, 0), radius);
      default: {
        std::vector<Vector<S>> points = {at(0, size)};
        for (int i = 0; i < 9; ++i) points.push_back(point());
        points.push_back(at(size, -size));
        return polyShape<S>(BodyId(), points, Transform<S>(), radius);
      }
    }
  }
  static Transform<S> randomPose(Random& random, int reach) {
    return Transform<S>::rigid({random.number<S>(-reach, reach), random.number<S>(-reach, reach)},
                               random.number<S>(-3, 3));
  }
};
TYPED_TEST_SUITE(CollisionTest, AllScalarsAndChecked);

TYPED_TEST(CollisionTest, OverlappingCirclesTouchBetweenTheirCentres) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const Shape<S> circle = circleShape<S>(BodyId(), S(2));
  const auto set = shapesCollide(circle, TestFixture::moved(at(1, 1)), circle, TestFixture::moved(at(4, 1)));
  ASSERT_EQ(set.count, 1);
  EXPECT_EQ(set.normal, at(1, 0));
  EXPECT_EQ(set.points[0].pointA, at(3, 1));
  EXPECT_EQ(set.points[0].pointB, at(2, 1));
  EXPECT_EQ(set.points[0].distance, S(-1));
}

TYPED_TEST(CollisionTest, CirclesThatJustMeetDoNotTouch) {
  using S = TypeParam;
  const Shape<S> circle = circleShape<S>(BodyId(), S(5));
  const auto place = [](int x, int y) { return TestFixture::moved(TestFixture::at(x, y)); };
  EXPECT_EQ(shapesCollide(circle, Transform<S>(), circle, place(6, 8)).count, 0);
  EXPECT_EQ(shapesCollide(circle, Transform<S>(), circle, place(6, 7)).count, 1);
}

TYPED_TEST(CollisionTest, CirclesInOnePlacePushAlongTheXAxis) {
  using S = TypeParam;
  const Shape<S> circle = circleShape<S>(BodyId(), S(1));
  const auto set = shapesCollide(circle, Transform<S>(), circle, Transform<S>());
  ASSERT_EQ(set.count, 1);
  EXPECT_EQ(set.normal, TestFixture::at(1, 0));
  EXPECT_EQ(set.points[0].distance, S(-2));
}

TYPED_TEST(CollisionTest, CircleTouchesTheFaceOfASegmentFromEitherSide) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const Shape<S> circle = circleShape<S>(BodyId(), S(2));
  const Shape<S> floor = segmentShape<S>(BodyId(), at(-8, 0), at(8, 0), S(1));
  const auto above = shapesCollide(circle, TestFixture::moved(at(3, 2)), floor, Transform<S>());
  ASSERT_EQ(above.count, 1);
  EXPECT_EQ(above.normal, at(0, -1));
  EXPECT_EQ(above.points[0].pointA, at(3, 0));
  EXPECT_EQ(above.points[0].pointB, at(3, 1));
  const auto below = shapesCollide(circle, TestFixture::moved(at(3, -2)), floor, Transform<S>());
  ASSERT_EQ(below.count, 1);
  EXPECT_EQ(below.normal, at(0, 1));
  EXPECT_EQ(shapesCollide(circle, TestFixture::moved(at(3, 3)), floor, Transform<S>()).count, 0);
}

TYPED_TEST(CollisionTest, CircleOnTheLineOfASegmentPushesAlongItsNormal) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const auto set = shapesCollide(circleShape<S>(BodyId(), S(1)), TestFixture::moved(at(2, 0)),
                                 segmentShape<S>(BodyId(), at(-8, 0), at(8, 0)), Transform<S>());
  ASSERT_EQ(set.count, 1);
  EXPECT_EQ(set.normal, at(0, -1));
}

TYPED_TEST(CollisionTest, CircleTouchesTheRoundEndOfASegment) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const auto set = shapesCollide(circleShape<S>(BodyId(), S(4)), TestFixture::moved(at(11, 4)),
                                 segmentShape<S>(BodyId(), at(-8, 0), at(8, 0), S(2)), Transform<S>());
  ASSERT_EQ(set.count, 1);
  EXPECT_EQ(set.normal, Vector<S>(ratio<S>(-3, 5), ratio<S>(-4, 5)));
  EXPECT_LE(abs(set.points[0].distance + S(1)), S(0x1p-29));
}

TYPED_TEST(CollisionTest, CircleDoesNotTouchAnEndOnTheSideOfItsNeighbour) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  Shape<S> floor = segmentShape<S>(BodyId(), at(-8, 0), at(8, 0));
  const Shape<S> circle = circleShape<S>(BodyId(), S(1));
  const auto count = [&](const Vector<S>& v) {
    return shapesCollide(circle, TestFixture::moved(v), floor, Transform<S>()).count;
  };
  const Vector<S> pastB(S(8) + ratio<S>(1, 2), ratio<S>(1, 2)), pastA(S(-8) - ratio<S>(1, 2), ratio<S>(1, 2));
  EXPECT_EQ(count(pastB), 1);
  SegmentShape<S>(floor).setNeighbors(at(-8, 0), at(16, 0));
  EXPECT_EQ(count(pastB), 0);
  EXPECT_EQ(count(pastA), 1);
  SegmentShape<S>(floor).setNeighbors(at(-16, 0), at(16, 0));
  EXPECT_EQ(count(pastA), 0);
  EXPECT_EQ(count(Vector<S>(S(8), ratio<S>(1, 2))), 1);
}

TYPED_TEST(CollisionTest, CircleTouchesFaceCornerAndInsideOfABox) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const Shape<S> circle = circleShape<S>(BodyId(), S(5)), box = boxShape<S>(BodyId(), S(20), S(20), S(1));
  const auto face = shapesCollide(circle, TestFixture::moved(at(2, 14)), box, Transform<S>());
  ASSERT_EQ(face.count, 1);
  EXPECT_EQ(face.normal, at(0, -1));
  EXPECT_EQ(face.points[0].pointA, at(2, 9));
  EXPECT_EQ(face.points[0].pointB, at(2, 11));
  const auto corner = shapesCollide(circle, TestFixture::moved(at(13, 14)), box, Transform<S>());
  ASSERT_EQ(corner.count, 1);
  EXPECT_EQ(corner.normal, Vector<S>(ratio<S>(-3, 5), ratio<S>(-4, 5)));
  const auto inside = shapesCollide(circle, TestFixture::moved(at(-7, 2)), box, Transform<S>());
  ASSERT_EQ(inside.count, 1);
  EXPECT_EQ(inside.normal, at(1, 0));
  EXPECT_EQ(inside.points[0].distance, S(-9));
  // A polygon is touched when it is just met.
  EXPECT_EQ(shapesCollide(circle, TestFixture::moved(at(0, 16)), box, Transform<S>()).count, 1);
  EXPECT_EQ(shapesCollide(circle, TestFixture::moved(at(14, 15)), box, Transform<S>()).count, 0);
}

TYPED_TEST(CollisionTest, BoxRestsOnABoxWithTwoPoints) {
  using S = TypeParam;
  const Placement<S> lower(boxShape<S>(BodyId(), S(4), S(2)), Transform<S>());
  const Placement<S> upper(boxShape<S>(BodyId(), S(2), S(2)), TestFixture::moved(TestFixture::fine(16, 28)));
  const CollisionInfo<S> info = collide(*lower, *upper);
  ASSERT_EQ(info.count, 2);
  EXPECT_EQ(info.normal, TestFixture::at(0, 1));
  EXPECT_EQ(info.points[0].pointA, TestFixture::at(2, 1));
  EXPECT_EQ(info.points[0].pointB, TestFixture::fine(32, 12));
  EXPECT_EQ(info.points[1].pointA, TestFixture::at(0, 1));
  EXPECT_EQ(info.points[1].pointB, TestFixture::fine(0, 12));
  EXPECT_NE(info.points[0].hash, info.points[1].hash);
}

TYPED_TEST(CollisionTest, PointsKeepTheirFeaturesWhileABoxSlides) {
  using S = TypeParam;
  const Placement<S> lower(boxShape<S>(BodyId(), S(8), S(2)), Transform<S>());
  CollisionInfo<S> before;
  for (int i = 0; i < 16; ++i) {
    const Placement<S> upper(TestFixture::unitBox(), TestFixture::moved(TestFixture::fine(i, 23)));
    const CollisionInfo<S> info = collide(*lower, *upper, before.id);
    ASSERT_EQ(info.count, 2);
    if (i > 0) {
      EXPECT_EQ(info.points[0].hash, before.points[0].hash);
      EXPECT_EQ(info.points[1].hash, before.points[1].hash);
    }
    before = info;
  }
}

TYPED_TEST(CollisionTest, BoxesThatJustMeetTouchAndApartDoNot) {
  using S = TypeParam;
  const Shape<S> box = TestFixture::unitBox();
  const auto count = [&](const Vector<S>& v) {
    return shapesCollide(box, Transform<S>(), box, TestFixture::moved(v)).count;
  };
  EXPECT_EQ(count(TestFixture::fine(16, 3)), 2);
  EXPECT_EQ(count(TestFixture::fine(17, 3)), 0);
  EXPECT_GE(count(TestFixture::fine(16, 16)), 1);
  EXPECT_EQ(count(TestFixture::fine(17, 17)), 0);
}

TYPED_TEST(CollisionTest, RoundedBoxesTouchAtTheirCorners) {
  using S = TypeParam;
  const Shape<S> box = boxShape<S>(BodyId(), S(8), S(8), S(3));
  const auto set = shapesCollide(box, Transform<S>(), box, TestFixture::moved(TestFixture::at(11, 12)));
  ASSERT_GE(set.count, 1);
  EXPECT_EQ(set.normal, Vector<S>(ratio<S>(3, 5), ratio<S>(4, 5)));
  EXPECT_EQ(shapesCollide(box, Transform<S>(), box, TestFixture::moved(TestFixture::at(13, 13))).count, 0);
}

TYPED_TEST(CollisionTest, CrossingSegmentsTouch) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const Shape<S> line = segmentShape<S>(BodyId(), at(-8, 0), at(8, 0), S(1));
  const Shape<S> post = segmentShape<S>(BodyId(), at(0, -1), at(0, 8), S(1));
  const auto set = shapesCollide(line, Transform<S>(), post, TestFixture::moved(at(2, 0)));
  ASSERT_GE(set.count, 1);
  EXPECT_EQ(set.normal, at(0, 1));
  EXPECT_EQ(shapesCollide(line, Transform<S>(), post, TestFixture::moved(at(2, 4))).count, 0);
}

TYPED_TEST(CollisionTest, SegmentsInOneLineTouchOnlyWhereTheyReach) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const Shape<S> line = segmentShape<S>(BodyId(), at(0, 0), at(8, 0), S(1));
  EXPECT_EQ(shapesCollide(line, Transform<S>(), line, TestFixture::moved(at(11, 0))).count, 0);
  EXPECT_GE(shapesCollide(line, Transform<S>(), line, TestFixture::moved(at(9, 0))).count, 1);
  EXPECT_GE(shapesCollide(line, Transform<S>(), line, TestFixture::moved(at(3, 0))).count, 1);
}

// A row of segments that know each other is one floor: nothing pushes along it at the joints.
TYPED_TEST(CollisionTest, NothingCatchesOnTheJointsOfAFloor) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  Shape<S> left = segmentShape<S>(BodyId(), at(-8, 0), at(0, 0)),
           right = segmentShape<S>(BodyId(), at(0, 0), at(8, 0));
  SegmentShape<S>(left).setNeighbors(at(-16, 0), at(8, 0));
  SegmentShape<S>(right).setNeighbors(at(-8, 0), at(16, 0));
  for (const Shape<S>& shape :
       {TestFixture::unitBox(), TestFixture::unitBox(ratio<S>(1, 8)),
        circleShape<S>(BodyId(), ratio<S>(1, 2)), segmentShape<S>(BodyId(), at(-1, 0), at(1, 1), S(1))}) {
    for (int i = -40; i <= 40; ++i) {
      const BB<S> box = boundingBox(shape, Transform<S>());
      const Vector<S> place(ratio<S>(i, 8), -box.bottom - ratio<S>(1, 64));
      for (const Shape<S>& floor : {left, right}) {
        const auto set = shapesCollide(floor, Transform<S>(), shape, TestFixture::moved(place));
        if (set.count > 0) {
          EXPECT_GE(set.normal.y, ratio<S>(15, 16)) << i;
        }
      }
    }
  }
}

TYPED_TEST(CollisionTest, ExchangingTheShapesMirrorsTheAnswer) {
  using S = TypeParam;
  Random random(11);
  int touching = 0;
  for (int i = 0; i < 1500; ++i) {
    const Placement<S> a(TestFixture::randomShape(random, 2, i % 2 == 0), TestFixture::randomPose(random, 2));
    const Placement<S> b(TestFixture::randomShape(random, 2, i % 3 == 0), TestFixture::randomPose(random, 2));
    const CollisionInfo<S> there = collide(*a, *b), back = collide(*b, *a);
    ASSERT_EQ(there.count, back.count) << i;
    touching += there.count > 0;
    if (there.count == 0) continue;
    EXPECT_EQ(there.normal, -back.normal) << i;
    const bool turned = there.count == 2 && a->type == b->type;
    for (int k = 0; k < there.count; ++k) {
      const CollisionPoint<S>&p = there.points[k], &q = back.points[turned ? 1 - k : k];
      EXPECT_EQ(p.hash, q.hash << 16 | q.hash >> 16) << i;
      EXPECT_EQ(p.pointA, q.pointB) << i;
      EXPECT_EQ(p.pointB, q.pointA) << i;
    }
  }
  EXPECT_GT(touching, 500);
}

TYPED_TEST(CollisionTest, AnyStartIdGivesTheSameAnswer) {
  using S = TypeParam;
  Random random(12);
  for (int i = 0; i < 1500; ++i) {
    const Placement<S> a(TestFixture::randomShape(random, 2, i % 2 == 0), TestFixture::randomPose(random, 3));
    const Placement<S> b(TestFixture::randomShape(random, 2, i % 3 == 0), TestFixture::randomPose(random, 3));
    const CollisionInfo<S> fresh = collide(*a, *b);
    for (const CollisionId id : {fresh.id, static_cast<CollisionId>(random.next()),
                                 static_cast<CollisionId>(random.next()) & 0x81010101u, ~0u}) {
      const CollisionInfo<S> warm = collide(*a, *b, id);
      ASSERT_EQ(warm.count, fresh.count) << i;
      if (fresh.count == 0) continue;
      EXPECT_EQ(warm.normal, fresh.normal) << i;
      for (int k = 0; k < fresh.count; ++k) EXPECT_EQ(warm.points[k].pointA, fresh.points[k].pointA) << i;
    }
  }
}

TEST(CollisionFixedTest, AnswerDoesNotDependOnWhereInTheWorldThePairIs) {
  using S = Fixed;
  using Maker = CollisionTest<S>;
  struct Access : Maker {
    void TestBody() override {}
    using Maker::randomPose;
    using Maker::randomShape;
  };
  Random random(13);
  int touching = 0;
  for (int i = 0; i < 2000; ++i) {
    const Shape<S> a = Access::randomShape(random, 2, i % 2 == 0),
                   b = Access::randomShape(random, 2, i % 3 == 0);
    Transform<S> poseA = Access::randomPose(random, 2), poseB = Access::randomPose(random, 2);
    const Placement<S> hereA(a, poseA), hereB(b, poseB);
    const CollisionInfo<S> here = collide(*hereA, *hereB);
    const auto raw = [&] { return S::fromRaw(static_cast<std::int64_t>(random.next()) >> 12); };  // +-2^19 m
    const Vector<S> away(raw(), raw());
    poseA = Transform<S>::translation(away) * poseA;
    poseB = Transform<S>::translation(away) * poseB;
    const Placement<S> thereA(a, poseA), thereB(b, poseB);
    const CollisionInfo<S> there = collide(*thereA, *thereB);
    ASSERT_EQ(here.count, there.count);
    EXPECT_EQ(here.id, there.id);
    if (here.count == 0) continue;
    ++touching;
    EXPECT_EQ(here.normal, there.normal);
    for (int k = 0; k < here.count; ++k) {
      EXPECT_EQ(here.points[k].pointA + away, there.points[k].pointA);
      EXPECT_EQ(here.points[k].pointB + away, there.points[k].pointB);
      EXPECT_EQ(here.points[k].hash, there.points[k].hash);
    }
  }
  EXPECT_GT(touching, 800);
}

TYPED_TEST(CollisionTest, EqualShapesInOnePlaceGetAnAnswer) {
  using S = TypeParam;
  Random random(14);
  for (int i = 0; i < 300; ++i) {
    const Placement<S> a(TestFixture::randomShape(random, 2, i % 2 == 0), TestFixture::randomPose(random, 3));
    const CollisionInfo<S> info = collide(*a, *a);
    // A line without thickness does not overlap itself.
    if (a->type != ShapeType::segment || a->radius > S(0)) {
      EXPECT_GE(info.count, 1) << i;
    }
    TestFixture::expectSane(info);
    TestFixture::expectSane(collide(*a, *a, info.id));
  }
  for (const int corners : {3, 4, 5, 9, 32}) {
    const Placement<S> a(TestFixture::wheel(corners, S(2)), Transform<S>());
    EXPECT_GE(collide(*a, *a).count, 1) << corners;
    TestFixture::expectSane(collide(*a, *a));
  }
}

// On a coarse grid vertices, edges and centres coincide all the time.
TYPED_TEST(CollisionTest, CoincidingFeaturesAlwaysGiveAUnitNormal) {
  using S = TypeParam;
  Random random(15);
  const auto corner = [&] { return Vector<S>(S(random.between(-2, 2)), S(random.between(-2, 2))); };
  std::vector<Shape<S>> shapes;
  while (shapes.size() < 40) {
    const S radius = S(random.between(0, 2));
    const Vector<S> a = corner(), b = corner(), c = corner(), d = corner();
    if (random.oneIn(4)) shapes.push_back(circleShape<S>(BodyId(), radius, a));
    if (a != b) shapes.push_back(segmentShape<S>(BodyId(), a, b, radius));
    if (exactCross(b - a, c - a) != Wide<S>()) {
      shapes.push_back(polyShape<S>(BodyId(), std::vector<Vector<S>>{a, b, c, d}, Transform<S>(), radius));
    }
  }
  for (const Shape<S>& first : shapes) {
    for (const Shape<S>& second : shapes) {
      const Placement<S> a(first, Transform<S>()), b(second, TestFixture::moved(corner()));
      const CollisionInfo<S> info = collide(*a, *b), back = collide(*b, *a);
      TestFixture::expectSane(info);
      EXPECT_EQ(info.count == 0, back.count == 0);
      TestFixture::expectSane(collide(*a, *b, static_cast<CollisionId>(random.next()) & 0x81010101u));
    }
  }
}

TYPED_TEST(CollisionTest, NeedlesSliversAndGiantsGetAnAnswer) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const S tiny = S(0x1p-30);
  const std::vector<Shape<S>> shapes = {
      polyShapeRaw<S>(BodyId(), std::vector<Vector<S>>{at(0, 0), {S(256), tiny}, {S(0), tiny + tiny}}),
      polyShapeRaw<S>(BodyId(), std::vector<Vector<S>>{{-tiny, S(0)}, {tiny, S(0)}, at(0, 8000)}),
      boxShape<S>(BodyId(), S(20000), S(20000)),
      boxShape<S>(BodyId(), S(20000), tiny + tiny),
      boxShape<S>(BodyId(), tiny + tiny, tiny + tiny),
      boxShape<S>(BodyId(), ratio<S>(1, 32), ratio<S>(1, 32), ratio<S>(1, 64)),
      segmentShape<S>(BodyId(), at(-16000, 0), at(16000, 1)),
      segmentShape<S>(BodyId(), at(0, 0), {tiny, S(0)}, S(100)),
      circleShape<S>(BodyId(), S(16000)),
      circleShape<S>(BodyId(), S(0)),
      TestFixture::wheel(32, S(10000)),
      TestFixture::wheel(32, ratio<S>(1, 64))};
  Random random(16);
  for (const Shape<S>& first : shapes) {
    for (const Shape<S>& second : shapes) {
      for (int i = 0; i < 40; ++i) {
        const Vector<S> corner((random.oneIn(2) ? S(1 << 20) : S(0)), S(-(1 << 20)));
        const int reach = i % 2 == 0 ? 1 : 10000;
        const Transform<S> to = TestFixture::moved(i % 4 < 2 ? Vector<S>() : corner);
        const Placement<S> a(first, to * TestFixture::randomPose(random, reach));
        const Placement<S> b(second, to * TestFixture::randomPose(random, reach));
        CollisionStats stats;
        const CollisionInfo<S> info = collide(*a, *b, 0, &stats);
        TestFixture::expectSane(info);
        EXPECT_EQ(info.count > 0, collide(*b, *a).count > 0);
      }
    }
  }
}

// MIS section 13, HighIterWarning: every edge round the common centre is equally near.
TYPED_TEST(CollisionTest, LongSearchIsCounted) {
  using S = TypeParam;
  const Placement<S> a(TestFixture::wheel(32, S(2)), Transform<S>());
  CollisionStats stats;
  TestFixture::expectSane(collide(*a, *a, 0, &stats));
  EXPECT_EQ(stats.highEpaIterations, 1u);
  EXPECT_EQ(stats.highGjkIterations, 0u);

  const Placement<S> apart(TestFixture::wheel(32, S(2)), TestFixture::moved(TestFixture::at(5, 0)));
  collide(*a, *apart, 0, &stats);
  EXPECT_EQ(stats.highEpaIterations, 1u);
}

// Their normals differ by 1.4e-5 rad, whose cosine rounds to 1: the wrong one of them put contacts 1.7 m from
// where the shapes met.
TYPED_TEST(CollisionTest, OfNearlyParallelEdgesTheOneAcrossTheNormalIsTaken) {
  using S = TypeParam;
  const auto raw = [](double x, double y) { return Vector<S>(S(x), S(y)); };
  const std::vector<Vector<S>> points = {
      raw(-3.0524330213665962e-05, 0), raw(-3.0517578125e-05, -3.0537135899066925e-05),
      raw(1.6875000004656613, -3.0517578125e-05), raw(3.8749999923165888, -2.3283064365386963e-10),
      raw(-3.0524330213665962e-05, 3.8749999923165888)};
  const Placement<S> shape(polyShapeRaw<S>(BodyId(), points), Transform<S>());
  EXPECT_EQ(edgeAt(*shape, 2, raw(1.1641532182693481e-08, -1)).indexA, 1);
  EXPECT_EQ(edgeAt(*shape, 2, raw(1e-3, -1)).indexA, 2);
  // The two sides of a segment.
  const Placement<S> segment(segmentShape<S>(BodyId(), raw(0, 0), raw(1, 0)), Transform<S>());
  for (const int vertex : {0, 1}) {
    EXPECT_NE(edgeAt(*segment, vertex, raw(0, 1)).indexA, edgeAt(*segment, vertex, raw(0, -1)).indexA);
  }
}

// Their difference has 32 edges along each of which EPA has to look; with 30 iterations it gave up before.
TYPED_TEST(CollisionTest, EpaLooksAtAllEdgesOfTwoLargePolygons) {
  using S = TypeParam;
  const Placement<S> a(TestFixture::wheel(32, S(2)), Transform<S>());
  for (const int degrees : {0, 1, 3, 5}) {
    const Placement<S> b(TestFixture::wheel(32, S(2)),
                         Transform<S>::rigid({}, kPi<S> * ratio<S>(degrees, 180)));
    const CollisionInfo<S> info = collide(*a, *b);
    ASSERT_EQ(info.count, 2);
    const auto least = [](const PlacedShape<S>& faces, const PlacedShape<S>& other) {
      S result = S(1 << 10);
      for (int i = 0; i < faces.count; ++i) {
        S deepest = S(0);
        for (int j = 0; j < other.count; ++j) {
          deepest = max(deepest, dot(faces.planes[i].v0 - other.planes[j].v0, faces.planes[i].n));
        }
        result = min(result, deepest);
      }
      return result;
    };
    const S overlap = min(least(*a, *b), least(*b, *a));
    for (int i = 0; i < info.count; ++i) {
      const CollisionPoint<S>& p = info.points[i];
      EXPECT_LE(dot(p.pointA - p.pointB, info.normal), overlap + S(1e-8)) << degrees;
    }
  }
}

TYPED_TEST(CollisionTest, ShapesOutOfOrderAreAnInternalError) {
  using S = TypeParam;
  const Placement<S> box(TestFixture::unitBox(), Transform<S>()),
      circle(circleShape<S>(BodyId(), S(1)), Transform<S>());
  CollisionInfo<S> info;
  EXPECT_THROW(collideSorted<S>(*box, *circle, info, nullptr), CollisionError);
  EXPECT_EQ(info.count, 0);
}

TYPED_TEST(CollisionTest, ThirdPointIsAnInternalError) {
  using S = TypeParam;
  CollisionInfo<S> info;
  info.push(Vector<S>(), Vector<S>(), 1);
  info.push(Vector<S>(), Vector<S>(), 2);
  EXPECT_THROW(info.push(Vector<S>(), Vector<S>(), 3), CollisionContactOverflow);
  EXPECT_EQ(info.count, 2);
}

}  // namespace
}  // namespace samestep
