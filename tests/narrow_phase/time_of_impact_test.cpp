// SPDX-License-Identifier: MIT
#include <samestep/time_of_impact.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/error.h>
#include <samestep/limits.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "support/random.h"
#include "support/scalars.h"

namespace samestep {
namespace {

constexpr double kSlack = 0x1p-20;

template <class S>
class TimeOfImpactTest : public ::testing::Test {
 protected:
  using Motion = RigidMotion<S>;

  static Shape<S> circle(S radius) { return circleShape<S>(BodyId(), radius, {}); }
  static Shape<S> box(S width, S height, S radius = S(0)) {
    return boxShape<S>(BodyId(), width, height, radius);
  }
  static Shape<S> wall(S length, S radius) {
    return segmentShape<S>(BodyId(), {S(0), -length}, {S(0), length}, radius);
  }
  static Motion going(S x, S y, S wayX, S wayY, S turn = S(0)) {
    return {{}, {x, y}, S(0), {wayX, wayY}, turn};
  }
  static Shape<S> randomShape(Random& random) {
    const S size = random.number<S>(0, 2) + ratio<S>(1, 32);
    const S radius = random.oneIn(2) ? S(0) : ratio<S>(random.between(0, 256), 1024);
    switch (random.below(4)) {
      case 0:
        return circleShape<S>(BodyId(), size, {random.number<S>(-1, 1), random.number<S>(-1, 1)});
      case 1:
        return segmentShape<S>(BodyId(), {-size, S(0)}, {size, random.number<S>(-1, 1)}, radius);
      case 2:
        return boxShape<S>(BodyId(), size, ratio<S>(random.between(1, 64), 64), radius);
      default:
        return polyShape<S>(
            BodyId(), std::vector<Vector<S>>{{-size, -size}, {size, random.number<S>(-1, 0)}, {S(0), size}},
            Transform<S>(), radius);
    }
  }
  static Motion randomMotion(Random& random) {
    const int reach = random.oneIn(2) ? 2 : 8;
    return {{random.number<S>(-1, 1), random.number<S>(-1, 1)},
            {random.number<S>(-reach, reach), random.number<S>(-reach, reach)},
            random.number<S>(-4, 4),
            {random.number<S>(-reach, reach), random.number<S>(-reach, reach)},
            random.oneIn(3) ? S(0) : random.number<S>(-reach, reach)};
  }

  // The oracle: places in double, every vertex against every edge.

  struct Place {
    double x, y;
  };
  static double toSegment(Place p, Place a, Place b) {
    const double dx = b.x - a.x, dy = b.y - a.y, whole = dx * dx + dy * dy;
    const double t = whole == 0 ? 0 : std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / whole, 0.0, 1.0);
    return std::hypot(p.x - a.x - dx * t, p.y - a.y - dy * t);
  }
  static std::vector<Place> placesOf(const Shape<S>& shape, const Motion& motion, double part) {
    const double angle = double(motion.angle) + double(motion.turn) * part;
    const double c = std::cos(angle), s = std::sin(angle);
    const std::size_t count = shape.type() == ShapeType::segment ? 2 : shape.vertices().size();
    std::vector<Place> places;
    for (const Vector<S>& v : shape.vertices().first(count)) {
      const double x = double(v.x - motion.pivot.x), y = double(v.y - motion.pivot.y);
      places.push_back({double(motion.start.x) + double(motion.way.x) * part + x * c - y * s,
                        double(motion.start.y) + double(motion.way.y) * part + x * s + y * c});
    }
    return places;
  }
  static bool inside(Place p, const std::vector<Place>& poly) {
    for (std::size_t i = 0; poly.size() > 2 && i < poly.size(); ++i) {
      const Place a = poly[i], b = poly[(i + 1) % poly.size()];
      if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) < 0) return false;
    }
    return poly.size() > 2;
  }
  static double cross(Place o, Place a, Place b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
  }
  /// Distance of the surfaces; of cores that overlap minus both radii, or less.
  static double distanceAt(const Shape<S>& a, const Motion& motionA, const Shape<S>& b, const Motion& motionB,
                           double part) {
    const auto placesA = placesOf(a, motionA, part), placesB = placesOf(b, motionB, part);
    const double radii = double(a.radius()) + double(b.radius());
    double least = 1e300;
    const auto each = [&](const std::vector<Place>& points, const std::vector<Place>& edges) {
      for (const Place& p : points) {
        if (inside(p, edges)) least = 0;
        for (std::size_t i = 0; i < edges.size(); ++i)
          least = std::min(least, toSegment(p, edges[i], edges[(i + 1) % edges.size()]));
      }
    };
    each(placesA, placesB);
    each(placesB, placesA);
    for (std::size_t i = 0; i < placesA.size() && placesA.size() > 1; ++i) {
      for (std::size_t j = 0; j < placesB.size() && placesB.size() > 1; ++j) {
        const Place p = placesA[i], q = placesA[(i + 1) % placesA.size()], r = placesB[j],
                    s = placesB[(j + 1) % placesB.size()];
        if (cross(p, q, r) * cross(p, q, s) < 0 && cross(r, s, p) * cross(r, s, q) < 0) least = 0;
      }
    }
    return least - radii;
  }
};
TYPED_TEST_SUITE(TimeOfImpactTest, AllScalarsAndChecked);

TYPED_TEST(TimeOfImpactTest, IsThatOfTheFormulaForCircles) {
  using S = TypeParam;
  const auto ball = TestFixture::circle(S(1));
  Random random(1);
  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    const double x = 8, y = double(random.number<S>(-3, 3)), way = double(random.number<S>(1, 20));
    const Impact<S> impact = timeOfImpact(ball, TestFixture::going(S(0), S(0), S(way), S(0)), ball,
                                          TestFixture::going(S(x), S(y), S(0), S(0)));
    const auto at = [&](double reach) { return (x - std::sqrt(reach * reach - y * y)) / way; };
    const double early = 2 + 0x1p-12, late = 2 + 0x1p-13;
    if (std::fabs(y) < late && at(late) < 1) {
      ++hits;
      ASSERT_TRUE(impact.hit) << y << " " << way;
      EXPECT_TRUE(impact.found);
      EXPECT_LE(double(impact.part), at(late) + 1e-9);
      EXPECT_GE(double(impact.part), at(early) - 1e-9);
      EXPECT_LE(double(length(impact.there.pointB - impact.there.pointA)), 0x1p-12 + kSlack);
    } else if (std::fabs(y) > early || at(early) > 1) {
      EXPECT_FALSE(impact.hit) << y << " " << way;
      EXPECT_EQ(impact.part, S(1));
    }
  }
  EXPECT_GT(hits, 100);
}

// Samples of the distance all along the way, of any shapes and motions, against what is promised.
TYPED_TEST(TimeOfImpactTest, IsNeverLateAndNeverMisses) {
  using S = TypeParam;
  Random random(2);
  int hits = 0, misses = 0, found = 0;
  const double asked = double(kImpactDistance<S>), kept = asked - double(kImpactTolerance<S>);
  for (int i = 0; i < 600; ++i) {
    const auto a = TestFixture::randomShape(random), b = TestFixture::randomShape(random);
    const auto motionA = TestFixture::randomMotion(random), motionB = TestFixture::randomMotion(random);
    const Impact<S> impact = timeOfImpact(a, motionA, b, motionB);
    const auto distance = [&](double part) { return TestFixture::distanceAt(a, motionA, b, motionB, part); };
    const double end = double(impact.part);
    (impact.hit ? hits : misses) += 1;
    if (impact.hit && impact.part == S(0) && distance(0) <= asked) continue;
    for (int k = 0; k < 300; ++k) {
      const double part = end * k / 300;
      ASSERT_GE(distance(part), kept - kSlack) << i << " at " << part << " of " << end;
    }
    if (!impact.hit) {
      ASSERT_GE(distance(1), kept - kSlack) << i;
    }
    if (!impact.hit) continue;
    ASSERT_TRUE(impact.found) << i;
    ++found;
    EXPECT_LE(distance(end), asked + kSlack) << i;
    EXPECT_NEAR(double(impact.there.distance), distance(end), kSlack) << i;
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(misses, 150);
  EXPECT_GT(found, 50);
}

TYPED_TEST(TimeOfImpactTest, SeesAThinPlateThatSpinsIntoAWallWithItsTip) {
  using S = TypeParam;
  // It begins and ends upright, beside the wall, and passes it twice in between.
  const auto plate = TestFixture::box(S(2), S(0x1p-6));
  const auto wall = TestFixture::wall(S(8), S(0x1p-7));
  const S half = ratio<S>(355, 226);
  const RigidMotion<S> spin{{}, {S(-1) + ratio<S>(1, 8), S(0)}, half, {}, S(2) * half};
  const Impact<S> impact = timeOfImpact(plate, spin, wall, RigidMotion<S>::still({}));
  ASSERT_TRUE(impact.found);
  // The corner comes to -2^-7 where cos(angle) + 2^-7 sin(angle) is 7/8 - 2^-7, less the distance asked.
  const double atEarliest =
      TestFixture::distanceAt(plate, spin, wall, RigidMotion<S>::still({}), double(impact.part));
  EXPECT_LE(atEarliest, 0x1p-12 + kSlack);
  EXPECT_GE(atEarliest, 0x1p-13 - kSlack);
  EXPECT_LT(impact.part, ratio<S>(1, 2));
}

TYPED_TEST(TimeOfImpactTest, DoesNotStopWhatSpinsBesideAWallThatItDoesNotReach) {
  using S = TypeParam;
  const auto plate = TestFixture::box(S(2), S(0x1p-6));
  const auto wall = TestFixture::wall(S(8), S(0));
  const RigidMotion<S> spin{{}, {S(-1) - S(0x1p-9), S(0)}, S(0), {}, kMaxTurn<S>};
  const Impact<S> impact = timeOfImpact(plate, spin, wall, RigidMotion<S>::still({}));
  EXPECT_FALSE(impact.hit);
  const RigidMotion<S> less{{}, {S(-1) - S(0x1p-9), S(0)}, S(0), {}, S(4)};
  EXPECT_FALSE(timeOfImpact(plate, less, wall, RigidMotion<S>::still({})).hit);
}

TYPED_TEST(TimeOfImpactTest, OfAWayOfNoLengthIsADistance) {
  using S = TypeParam;
  const auto a = TestFixture::box(S(1), S(1)), b = TestFixture::circle(S(1));
  for (const int apart : {1, 2, 3}) {
    const auto at = RigidMotion<S>::still({S(apart), S(0)});
    const Impact<S> impact = timeOfImpact(a, RigidMotion<S>::still({}), b, at);
    EXPECT_EQ(impact.hit, apart == 1);
    EXPECT_EQ(impact.part, impact.hit ? S(0) : S(1));
  }
}

// A unit of the part in Fixed is half a millimetre of such a way.
TYPED_TEST(TimeOfImpactTest, OfACastThroughTheWholeWorldMeetsTheThinnestWall) {
  using S = TypeParam;
  const S far = kMaxWorldExtent<S>;
  const auto ball = TestFixture::circle(S(0x1p-5)), wall = TestFixture::wall(S(1), S(0));
  for (int i = 1; i < 20; ++i) {
    const auto at = RigidMotion<S>::still({S(3 * i) * ratio<S>(1, 7), S(0)});
    const RigidMotion<S> way{{}, {-far, S(0)}, S(0), {S(2) * far, S(0)}, S(0)};
    const Impact<S> impact = timeOfImpact(ball, way, wall, at);
    ASSERT_TRUE(impact.hit) << i;
    const double distance = TestFixture::distanceAt(ball, way, wall, at, double(impact.part));
    EXPECT_GE(distance, -kSlack) << i;
    EXPECT_LE(distance, 0x1p-9) << i;
    const RigidMotion<S> beside{{}, {-far, S(2)}, S(0), {S(2) * far, S(0)}, S(0)};
    EXPECT_FALSE(timeOfImpact(ball, beside, wall, at).hit) << i;
  }
}

TYPED_TEST(TimeOfImpactTest, OfADepthAskedForLetsShapesOverlapByIt) {
  using S = TypeParam;
  const auto a = TestFixture::box(S(1), S(1)), b = TestFixture::box(S(1), S(1));
  const S depth = ratio<S>(-1, 8);
  const Impact<S> impact = timeOfImpact(a, TestFixture::going(S(0), S(0), S(4), S(0)), b,
                                        RigidMotion<S>::still({S(3), S(0)}), depth);
  ASSERT_TRUE(impact.found);
  EXPECT_LE(impact.there.distance, depth);
  EXPECT_GE(double(impact.there.distance), double(depth - kImpactTolerance<S>) - kSlack);
  EXPECT_NEAR(double(impact.part), 2.125 / 4, 0x1p-12);
}

TYPED_TEST(TimeOfImpactTest, IsTheSameForShapesExchanged) {
  using S = TypeParam;
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const auto a = TestFixture::randomShape(random), b = TestFixture::randomShape(random);
    const auto motionA = TestFixture::randomMotion(random), motionB = TestFixture::randomMotion(random);
    const Impact<S> one = timeOfImpact(a, motionA, b, motionB), other = timeOfImpact(b, motionB, a, motionA);
    EXPECT_EQ(one.hit, other.hit) << i;
    EXPECT_NEAR(double(one.part), double(other.part), 1e-3) << i;
  }
}

TYPED_TEST(TimeOfImpactTest, RefusesWhatIsOutOfRange) {
  using S = TypeParam;
  const auto ball = TestFixture::circle(S(1));
  const auto still = RigidMotion<S>::still({});
  const auto refuses = [&](const RigidMotion<S>& motion) {
    EXPECT_THROW(timeOfImpact(ball, motion, ball, still), ValueOutOfRange);
    EXPECT_THROW(timeOfImpact(ball, still, ball, motion), ValueOutOfRange);
  };
  const S beyond = kMaxWorldExtent<S> + S(1);
  refuses(RigidMotion<S>::still({beyond, S(0)}));
  refuses({{}, {}, S(0), {S(2) * beyond, S(0)}, S(0)});
  refuses({{}, {}, S(0), {}, kMaxTurn<S> + S(1)});
  refuses({{}, {}, kMaxAngle<S> + S(1), {}, S(0)});
  refuses({{S(kMaxExtent + 1), S(0)}, {}, S(0), {}, S(0)});
  EXPECT_THROW(timeOfImpact(ball, still, ball, still, S(257)), ValueOutOfRange);
}

TYPED_TEST(TimeOfImpactTest, TheRestOfAMotionGoesWhereTheWholeGoes) {
  using S = TypeParam;
  Random random(6);
  for (int i = 0; i < 50; ++i) {
    const auto motion = TestFixture::randomMotion(random);
    const auto rest = motion.from(ratio<S>(1, 4));
    const Transform<S> whole = motion.at(ratio<S>(5, 8)), part = rest.at(ratio<S>(1, 2));
    EXPECT_NEAR(double(whole.tx), double(part.tx), 1e-8);
    EXPECT_NEAR(double(whole.ty), double(part.ty), 1e-8);
    EXPECT_NEAR(double(whole.a), double(part.a), 1e-8);
  }
}

TYPED_TEST(TimeOfImpactTest, ShapesAreAsFarApartAsTheirNearestPoints) {
  using S = TypeParam;
  Random random(7);
  int apart = 0;
  for (int i = 0; i < 500; ++i) {
    const auto a = TestFixture::randomShape(random), b = TestFixture::randomShape(random);
    const auto motionA = TestFixture::randomMotion(random), motionB = TestFixture::randomMotion(random);
    const ShapeDistance<S> found = shapesDistance(a, motionA.at(S(0)), b, motionB.at(S(0)));
    const double distance = TestFixture::distanceAt(a, motionA, b, motionB, 0);
    if (distance <= 0) {
      EXPECT_LE(double(found.distance), kSlack) << i;
    } else {
      ++apart;
      EXPECT_NEAR(double(found.distance), distance, kSlack) << i;
    }
    const Vector<S> between = found.pointB - found.pointA;
    EXPECT_NEAR(double(dot(between, found.normal)), double(found.distance), kSlack) << i;
    EXPECT_NEAR(double(samestep::cross(between, found.normal)), 0, kSlack) << i;
  }
  EXPECT_GT(apart, 200);
}

}  // namespace
}  // namespace samestep
