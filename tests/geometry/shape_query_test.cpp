// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "support/random.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class ShapeQueryTest : public ::testing::Test {
 protected:
  static Vector<S> at(int x, int y) { return {S(x), S(y)}; }
  static Shape<S> box(S radius = S(0)) { return boxShape<S>(BodyId(), S(20), S(10), radius); }
  static Shape<S> line(S radius = S(0)) { return segmentShape<S>(BodyId(), at(-10, 0), at(10, 0), radius); }

  static PointQueryInfo<S> query(const Shape<S>& shape, const Vector<S>& point) {
    return pointQuery(*Placement<S>(shape, Transform<S>()), point);
  }
  static void expectPoint(const Shape<S>& shape, const Vector<S>& from, const Vector<S>& point, S distance,
                          const Vector<S>& gradient) {
    const PointQueryInfo<S> info = query(shape, from);
    EXPECT_EQ(info.point, point);
    EXPECT_EQ(info.distance, distance);
    EXPECT_EQ(info.gradient, gradient);
  }
  static SegmentQueryInfo<S> shoot(const Shape<S>& shape, const Vector<S>& a, const Vector<S>& b,
                                   S radius = S(0)) {
    return segmentQuery(*Placement<S>(shape, Transform<S>()), a, b, radius);
  }
  static void expectHit(const SegmentQueryInfo<S>& info, S alpha, const Vector<S>& point,
                        const Vector<S>& normal) {
    EXPECT_TRUE(info.hit);
    EXPECT_LE(abs(info.alpha - alpha), S(0x1p-30));
    EXPECT_LE(length(info.point - point), S(0x1p-24));
    EXPECT_LE(length(info.normal - normal), S(0x1p-28));
  }
  static std::vector<Shape<S>> everyShape() {
    return {circleShape<S>(BodyId(), S(3)),
            line(),
            line(S(2)),
            box(),
            box(S(2)),
            polyShape<S>(BodyId(), std::vector<Vector<S>>{at(-5, -5), at(8, -2), at(6, 6), at(-1, 9)})};
  }
};
TYPED_TEST_SUITE(ShapeQueryTest, AllScalarsAndChecked);

TYPED_TEST(ShapeQueryTest, PointOutsideInsideAndInTheMiddleOfACircle) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const Shape<S> circle = circleShape<S>(BodyId(), S(5), at(1, 0));
  TestFixture::expectPoint(circle, at(11, 0), at(6, 0), S(5), at(1, 0));
  TestFixture::expectPoint(circle, at(1, -2), at(1, -5), S(-3), at(0, -1));
  TestFixture::expectPoint(circle, at(1, 0), at(1, 5), S(-5), at(0, 1));
}

TYPED_TEST(ShapeQueryTest, PointBesidePastAndOnASegment) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const Shape<S> line = TestFixture::line(S(2));
  TestFixture::expectPoint(line, at(3, 5), at(3, 2), S(3), at(0, 1));
  TestFixture::expectPoint(line, at(3, -5), at(3, -2), S(3), at(0, -1));
  TestFixture::expectPoint(line, at(3, 1), at(3, 2), S(-1), at(0, 1));
  TestFixture::expectPoint(line, at(15, 0), at(12, 0), S(3), at(1, 0));
  // The line itself has its normal, to the right of the way from a to b.
  TestFixture::expectPoint(line, at(3, 0), at(3, -2), S(-2), at(0, -1));
}

TYPED_TEST(ShapeQueryTest, PointAtAFaceACornerAndInsideOfABox) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  TestFixture::expectPoint(TestFixture::box(), at(3, 9), at(3, 5), S(4), at(0, 1));
  TestFixture::expectPoint(TestFixture::box(), at(10, 9), at(10, 5), S(4), at(0, 1));
  TestFixture::expectPoint(TestFixture::box(), at(8, 1), at(10, 1), S(-2), at(1, 0));
  TestFixture::expectPoint(TestFixture::box(), at(3, 5), at(3, 5), S(0), at(0, 1));
  const PointQueryInfo<S> corner = TestFixture::query(TestFixture::box(S(1)), at(13, 9));
  EXPECT_EQ(corner.distance, S(4));
  EXPECT_EQ(corner.gradient, Vector<S>(ratio<S>(3, 5), ratio<S>(4, 5)));
}

TYPED_TEST(ShapeQueryTest, AWayThatMissesReportsItsEnd) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  for (const Shape<S>& shape : TestFixture::everyShape()) {
    for (const Vector<S>& end : {at(30, 50), at(30, -50), at(90, 0), at(30, 0)}) {
      const SegmentQueryInfo<S> info = TestFixture::shoot(shape, at(30, 0), end, S(1));
      EXPECT_FALSE(info.hit);
      EXPECT_EQ(info.alpha, S(1));
      EXPECT_EQ(info.point, end);
      EXPECT_EQ(info.normal, Vector<S>());
    }
  }
}

TYPED_TEST(ShapeQueryTest, HitsTheNearSideOfACircle) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const Shape<S> circle = circleShape<S>(BodyId(), S(3));
  TestFixture::expectHit(TestFixture::shoot(circle, at(8, 0), at(-8, 0)), ratio<S>(5, 16), at(3, 0),
                         at(1, 0));
  TestFixture::expectHit(TestFixture::shoot(circle, at(8, 0), at(-8, 0), S(1)), ratio<S>(4, 16), at(3, 0),
                         at(1, 0));
  TestFixture::expectHit(TestFixture::shoot(circle, at(8, 4), at(-8, 4), S(2)), ratio<S>(5, 16),
                         {ratio<S>(9, 5), ratio<S>(12, 5)}, {ratio<S>(3, 5), ratio<S>(4, 5)});
}

TYPED_TEST(ShapeQueryTest, HitsTheFaceAndTheEndOfASegment) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  TestFixture::expectHit(TestFixture::shoot(TestFixture::line(), at(2, 8), at(2, -8)), ratio<S>(1, 2),
                         at(2, 0), at(0, 1));
  TestFixture::expectHit(TestFixture::shoot(TestFixture::line(S(1)), at(2, -8), at(2, 8), S(3)),
                         ratio<S>(1, 4), at(2, -1), at(0, -1));
  TestFixture::expectHit(TestFixture::shoot(TestFixture::line(S(1)), at(18, 0), at(2, 0), S(3)),
                         ratio<S>(1, 4), at(11, 0), at(1, 0));
  // Beside the end, inside the strip along the line: the round end is met, not the far face.
  TestFixture::expectHit(TestFixture::shoot(TestFixture::line(S(5)), at(18, 4), at(2, 4)), ratio<S>(5, 16),
                         at(13, 4), {ratio<S>(3, 5), ratio<S>(4, 5)});
}

TYPED_TEST(ShapeQueryTest, HitsTheFaceAndTheCornerOfABox) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  TestFixture::expectHit(TestFixture::shoot(TestFixture::box(), at(18, 2), at(2, 2)), ratio<S>(1, 2),
                         at(10, 2), at(1, 0));
  TestFixture::expectHit(TestFixture::shoot(TestFixture::box(S(1)), at(18, 2), at(2, 2), S(1)),
                         ratio<S>(3, 8), at(11, 2), at(1, 0));
  TestFixture::expectHit(TestFixture::shoot(TestFixture::box(), at(18, 9), at(2, 9), S(5)), ratio<S>(5, 16),
                         at(10, 5), {ratio<S>(3, 5), ratio<S>(4, 5)});
}

TYPED_TEST(ShapeQueryTest, AWayThatBeginsInTouchHitsAtOnce) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  TestFixture::expectHit(TestFixture::shoot(TestFixture::box(), at(8, 1), at(50, 1)), S(0), at(10, 1),
                         at(1, 0));
  TestFixture::expectHit(TestFixture::shoot(TestFixture::line(), at(3, 1), at(3, 50), S(1)), S(0), at(3, 0),
                         at(0, 1));
}

// Both ways, to where a circle of each radius just touches each shape, and in a direction of no axis.
TYPED_TEST(ShapeQueryTest, AWayThatEndsInTouchHitsAsOneThatBeginsThere) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  struct Case {
    Shape<S> shape;
    Vector<S> surface, normal;
  };
  std::vector<Case> cases;
  for (const int rounding : {0, 1, 2}) {
    const S r(rounding);
    for (const int side : {-1, 1}) {
      cases.push_back({TestFixture::box(r), at(10 * side + rounding * side, 2), at(side, 0)});
      cases.push_back({TestFixture::box(r), at(3, 5 * side + rounding * side), at(0, side)});
      cases.push_back({TestFixture::line(r), at(3, side * rounding), at(0, side)});
      cases.push_back({TestFixture::line(r), at(side * (10 + rounding), 0), at(side, 0)});
      cases.push_back({circleShape<S>(BodyId(), S(3 + rounding)), at(side * (3 + rounding), 0), at(side, 0)});
      cases.push_back({circleShape<S>(BodyId(), S(3 + rounding)), at(0, side * (3 + rounding)), at(0, side)});
    }
  }
  for (const Case& each : cases) {
    for (const int moving : {0, 1, 3}) {
      const Vector<S> touch = each.surface + each.normal * S(moving);
      for (const int aside : {-7, 0, 3}) {
        const Vector<S> away = touch + each.normal * S(4) + perp(each.normal) * S(aside);
        const SegmentQueryInfo<S> ends = TestFixture::shoot(each.shape, away, touch, S(moving));
        ASSERT_TRUE(ends.hit);
        EXPECT_LE(abs(ends.alpha - S(1)), S(0x1p-30));
        EXPECT_LE(length(ends.point - each.surface), S(0x1p-28));
        // Towards where it comes from; an end of a segment without radius has the normal of a side.
        EXPECT_GT(dot(ends.normal, away - touch), S(0));
        EXPECT_TRUE(TestFixture::shoot(each.shape, touch, away, S(moving)).hit);
        // A unit short of it: no touch.
        const Vector<S> before = touch + each.normal * S(0x1p-20);
        EXPECT_FALSE(TestFixture::shoot(each.shape, away, before, S(moving)).hit);
      }
    }
  }
}

TYPED_TEST(ShapeQueryTest, AWayThatEndsInTouchWithACornerHits) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  for (const int rounding : {0, 2, 5}) {
    const S moving(5 - rounding);
    const Shape<S> box = TestFixture::box(S(rounding)), line = TestFixture::line(S(rounding));
    EXPECT_TRUE(TestFixture::shoot(box, at(30, 19), at(13, 9), moving).hit);
    EXPECT_TRUE(TestFixture::shoot(box, at(-30, 19), at(-13, 9), moving).hit);
    EXPECT_TRUE(TestFixture::shoot(line, at(30, 19), at(13, 4), moving).hit);
    EXPECT_TRUE(TestFixture::shoot(circleShape<S>(BodyId(), S(rounding)), at(30, 19), at(3, 4), moving).hit);
  }
}

TYPED_TEST(ShapeQueryTest, AWayThatTouchesInPassingHits) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  // The shots go along the upper face of a box, which begins at x = 10; past its corner; along a segment; by
  // a circle.
  TestFixture::expectHit(TestFixture::shoot(TestFixture::box(), at(18, 5), at(2, 5)), ratio<S>(1, 2),
                         at(10, 5), at(1, 0));
  TestFixture::expectHit(TestFixture::shoot(TestFixture::box(), at(11, 4), at(9, 6)), ratio<S>(1, 2),
                         at(10, 5), at(1, 0));
  TestFixture::expectHit(TestFixture::shoot(TestFixture::line(), at(18, 0), at(2, 0)), ratio<S>(1, 2),
                         at(10, 0), at(1, 0));
  TestFixture::expectHit(TestFixture::shoot(TestFixture::line(), at(-18, 0), at(18, 0)), ratio<S>(2, 9),
                         at(-10, 0), at(-1, 0));
  TestFixture::expectHit(TestFixture::shoot(circleShape<S>(BodyId(), S(3)), at(8, 3), at(-8, 3)),
                         ratio<S>(1, 2), at(0, 3), at(0, 1));
  TestFixture::expectHit(TestFixture::shoot(TestFixture::box(), at(18, 7), at(2, 7), S(2)), ratio<S>(1, 2),
                         at(10, 5), at(0, 1));
  // A line that only its own end keeps from the shape misses.
  EXPECT_FALSE(TestFixture::shoot(TestFixture::box(), at(18, 5), at(11, 5)).hit);
  EXPECT_FALSE(TestFixture::shoot(TestFixture::line(), at(18, 0), at(11, 0)).hit);
  EXPECT_FALSE(TestFixture::shoot(TestFixture::line(), at(11, 0), at(18, 0)).hit);
}

TYPED_TEST(ShapeQueryTest, ACastFromTheCentreHitsAtOnceWithADocumentedNormal) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  TestFixture::expectHit(TestFixture::shoot(circleShape<S>(BodyId(), S(3)), at(0, 0), at(9, 0)), S(0),
                         at(0, 3), at(0, 1));
  const Shape<S> square = boxShape<S>(BodyId(), S(4), S(4));
  TestFixture::expectHit(TestFixture::shoot(square, at(0, 0), at(-9, 0)), S(0), at(0, -2), at(0, -1));
}

TYPED_TEST(ShapeQueryTest, AWayWithoutLengthIsAPoint) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  for (const Shape<S>& shape : TestFixture::everyShape()) {
    EXPECT_FALSE(TestFixture::shoot(shape, at(20, 20), at(20, 20), S(1)).hit);
    EXPECT_TRUE(TestFixture::shoot(shape, at(20, 20), at(20, 20), S(40)).hit);
  }
}

// The two queries agree: where the way is met the distance is the radius, and before it is more.
TYPED_TEST(ShapeQueryTest, DistanceAtTheHitIsTheRadius) {
  using S = TypeParam;
  Random random(31);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const auto end = [&] { return Vector<S>(random.number<S>(-30, 30), random.number<S>(-30, 30)); };
    const Vector<S> a = end(), b = end();
    const S radius = i % 3 == 0 ? S(0) : random.number<S>(0, 4);
    for (const Shape<S>& shape : TestFixture::everyShape()) {
      const Placement<S> placed(shape, Transform<S>::rigid(TestFixture::at(1, 2), random.number<S>(-3, 3)));
      const SegmentQueryInfo<S> info = segmentQuery(*placed, a, b, radius);
      const S reached = info.hit ? info.alpha : S(1);
      if (info.hit && info.alpha > S(0)) {
        ++hits;
        const S apart = pointQuery(*placed, a + (b - a) * info.alpha).distance;
        EXPECT_LE(abs(apart - radius), S(0x1p-22)) << i;
        EXPECT_LE(abs(pointQuery(*placed, info.point).distance), S(0x1p-22)) << i;
        EXPECT_LE(abs(length(info.normal) - S(1)), S(0x1p-28));
      }
      for (int k = 0; k < 16; ++k) {
        const Vector<S> before = a + (b - a) * (reached * ratio<S>(k, 16));
        if (info.alpha > S(0)) {
          EXPECT_GE(pointQuery(*placed, before).distance, radius - S(0x1p-22)) << i;
        }
      }
    }
  }
  EXPECT_GT(hits, 300);
}

// Rays at the common corner of two boxes, from everywhere: none slips through.
TYPED_TEST(ShapeQueryTest, NoRaySlipsThroughACorner) {
  using S = TypeParam;
  const Shape<S> shape = TestFixture::box();
  Random random(32);
  for (int i = 0; i < 500; ++i) {
    const Transform<S> pose = Transform<S>::rigid(Vector<S>(), random.number<S>(-3, 3));
    const Placement<S> placed(shape, pose);
    const Vector<S> corner = placed->planes[random.below(4)].v0;
    // Towards the corner from the far side of it, on into the inside.
    const Vector<S> a = corner * S(3), b = -corner;
    EXPECT_TRUE(segmentQuery(*placed, a, b).hit) << i;
  }
}

TYPED_TEST(ShapeQueryTest, QueriesReachAcrossTheWorld) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const int far = 1 << 20;
  for (const Shape<S>& shape : TestFixture::everyShape()) {
    const Placement<S> placed(shape, Transform<S>::translation(at(far, -far)));
    const PointQueryInfo<S> info = pointQuery(*placed, at(-far, far));
    EXPECT_GT(info.distance, S(2 * far));
    EXPECT_LE(abs(length(info.gradient) - S(1)), S(0x1p-28));
    EXPECT_TRUE(segmentQuery(*placed, at(-far, far), at(far, -far), S(1)).hit);
  }
}

}  // namespace
}  // namespace samestep
