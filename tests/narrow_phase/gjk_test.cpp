// SPDX-License-Identifier: MIT
#include "narrow_phase/gjk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <samestep/error.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "narrow_phase/epa.h"
#include "narrow_phase/support_faces.h"
#include "support/random.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class GjkTest : public ::testing::Test {
 protected:
  static Shape<S> randomPoly(Random& random, int corners) {
    std::vector<Vector<S>> points = {{S(-2), S(-2)}, {S(2), S(-1)}, {S(0), S(2)}};
    for (int i = 3; i < corners; ++i) points.push_back({random.number<S>(-2, 2), random.number<S>(-2, 2)});
    return polyShape<S>(BodyId(), points);
  }
  static Transform<S> randomPose(Random& random, int reach) {
    return Transform<S>::rigid({random.number<S>(-reach, reach), random.number<S>(-reach, reach)},
                               random.number<S>(-3, 3));
  }
  static SupportPair<S> pairOf(const Placement<S>& a, const Placement<S>& b) {
    return {SupportShape<S>(*a), SupportShape<S>(*b)};
  }
  static ClosestPoints<S> search(const Placement<S>& a, const Placement<S>& b, std::uint32_t start = 0) {
    CollisionStats stats;
    return gjk(pairOf(a, b), start, Vector<S>(), &stats);
  }

  static double distanceToSegment(double px, double py, double ax, double ay, double bx, double by) {
    const double dx = bx - ax, dy = by - ay;
    const double t = std::fmin(1, std::fmax(0, ((px - ax) * dx + (py - ay) * dy) / (dx * dx + dy * dy)));
    return std::hypot(px - ax - dx * t, py - ay - dy * t);
  }
  /// The least distance of any vertex of one from any edge of the other.
  static double bruteDistance(const Placement<S>& a, const Placement<S>& b) {
    double least = 1e300;
    for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &a)}) {
      const PlacedShape<S>&points = **from, &edges = **to;
      for (int i = 0; i < points.count; ++i) {
        for (int j = 0; j < edges.count; ++j) {
          const Vector<S> p = points.planes[i].v0, q = edges.planes[j].v0,
                          r = edges.planes[(j + 1) % edges.count].v0;
          least = std::fmin(least, distanceToSegment(double(p.x), double(p.y), double(q.x), double(q.y),
                                                     double(r.x), double(r.y)));
        }
      }
    }
    return least;
  }
};
TYPED_TEST_SUITE(GjkTest, AllScalarsAndChecked);

TYPED_TEST(GjkTest, FindsTheDistanceOfShapesApart) {
  using S = TypeParam;
  Random random(21);
  int apart = 0;
  for (int i = 0; i < 1000; ++i) {
    const Placement<S> a(TestFixture::randomPoly(random, 3 + i % 20), TestFixture::randomPose(random, 5));
    const Placement<S> b(TestFixture::randomPoly(random, 3 + i % 7), TestFixture::randomPose(random, 5));
    const ClosestPoints<S> found = TestFixture::search(a, b);
    if (found.distance <= S(0)) continue;
    ++apart;
    EXPECT_NEAR(double(found.distance), TestFixture::bruteDistance(a, b), 1e-8) << i;
    EXPECT_NEAR(double(length(found.normal)), 1, 1e-9);
  }
  EXPECT_GT(apart, 300);
}

// The overlap is found by two ways: growing a polygon in the difference, and trying every face.
TYPED_TEST(GjkTest, FindsTheOverlapThatTheFacesHave) {
  using S = TypeParam;
  Random random(22);
  int overlapping = 0;
  for (int i = 0; i < 1000; ++i) {
    const Placement<S> a(TestFixture::randomPoly(random, 3 + i % 20), TestFixture::randomPose(random, 1));
    const Placement<S> b(TestFixture::randomPoly(random, 3 + i % 7), TestFixture::randomPose(random, 1));
    const ClosestPoints<S> found = TestFixture::search(a, b);
    const FaceAxis<S> axis = bestFace(*a, *b, S(100), 0);
    EXPECT_EQ(found.distance <= S(0), axis.separation <= S(0)) << i;
    if (axis.separation > S(0)) continue;
    ++overlapping;
    EXPECT_NEAR(double(found.distance), double(axis.separation), 1e-8) << i;
    const Vector<S> normal = axis.onB ? -b->planes[axis.face].n : a->planes[axis.face].n;
    EXPECT_LE(double(length(found.normal - normal)), 1e-7) << i;
  }
  EXPECT_GT(overlapping, 700);
}

TYPED_TEST(GjkTest, EveryStartLeadsToTheSameDistance) {
  using S = TypeParam;
  Random random(23);
  for (int i = 0; i < 300; ++i) {
    const Placement<S> a(TestFixture::randomPoly(random, 12), TestFixture::randomPose(random, 3));
    const Placement<S> b(TestFixture::randomPoly(random, 12), TestFixture::randomPose(random, 3));
    const ClosestPoints<S> cold = TestFixture::search(a, b);
    for (int k = 0; k < 8; ++k) {
      const std::uint32_t start = static_cast<std::uint32_t>(random.next()) & 0x07070707u;
      EXPECT_LE(abs(TestFixture::search(a, b, start).distance - cold.distance), S(0x1p-28)) << i;
    }
    EXPECT_EQ(TestFixture::search(a, b, cold.id).distance, cold.distance) << i;
  }
}

// Vertices of the start that are no corners of the difference would spoil the polygon that grows in it.
TYPED_TEST(GjkTest, EveryStartMeasuresAnOverlapWithDustRight) {
  using S = TypeParam;
  const auto unit = [](int x, int y) { return Vector<S>(S(x) * S(0x1p-32), S(y) * S(0x1p-32)); };
  const Placement<S> dust(
      polyShape<S>(BodyId(), std::vector<Vector<S>>{unit(0, -1024), unit(242, 5), unit(-4, 290)}),
      Transform<S>::rigid(unit(3, 5), S(1) / S(8)));
  const Placement<S> box(boxShape<S>(BodyId(), S(16384), S(16384)), Transform<S>::rigid(Vector<S>(), S(2)));
  const S cold = TestFixture::search(dust, box).distance;
  EXPECT_NEAR(double(cold), -8192, 1e-4);
  for (std::uint32_t start = 0; start < 3 * 4 * 3 * 4; ++start) {
    const std::uint32_t id = start % 3 << 24 | start / 3 % 4 << 16 | start / 12 % 3 << 8 | start / 36;
    EXPECT_EQ(TestFixture::search(dust, box, id).distance, cold) << id;
  }
}

TYPED_TEST(GjkTest, KnowsTheVerticesThatAreNearest) {
  using S = TypeParam;
  const Shape<S> box = boxShape<S>(BodyId(), S(2), S(2));
  const Placement<S> a(box, Transform<S>()), b(box, Transform<S>::translation({S(5), S(6)}));
  const ClosestPoints<S> corner = TestFixture::search(a, b);
  EXPECT_EQ(corner.vertexA, 1);  // Top right.
  EXPECT_EQ(corner.vertexB, 3);  // Bottom left.
  EXPECT_EQ(corner.distance, S(5));
  EXPECT_EQ(corner.normal, Vector<S>(ratio<S>(3, 5), ratio<S>(4, 5)));

  const Placement<S> turned(box, Transform<S>::rigid({S(4), S(0)}, normalize(Vector<S>(S(1), S(1)))));
  const ClosestPoints<S> face = TestFixture::search(a, turned);
  EXPECT_EQ(face.vertexA, -1);
  EXPECT_GE(face.vertexB, 0);
  EXPECT_EQ(face.normal, Vector<S>(S(1), S(0)));
}

TYPED_TEST(GjkTest, VerticesInOnePlaceHaveDistanceZeroAndAUnitNormal) {
  using S = TypeParam;
  const Shape<S> box = boxShape<S>(BodyId(), S(2), S(2));
  for (const int x : {-2, 2}) {
    for (const int y : {-2, 2}) {
      const Placement<S> a(box, Transform<S>()), b(box, Transform<S>::translation({S(x), S(y)}));
      const ClosestPoints<S> found = TestFixture::search(a, b);
      EXPECT_EQ(found.distance, S(0));
      EXPECT_EQ(length(found.normal), S(1));
      // It separates them: all of B lies ahead of it.
      EXPECT_GE(dot(found.normal, Vector<S>(S(x), S(y))), S(0));
    }
  }
}

TYPED_TEST(GjkTest, SegmentsInOneLineHaveTheDistanceOfTheirEnds) {
  using S = TypeParam;
  const Shape<S> line = segmentShape<S>(BodyId(), {S(0), S(0)}, {S(2), S(0)});
  const Placement<S> a(line, Transform<S>()), b(line, Transform<S>::translation({S(5), S(0)}));
  const ClosestPoints<S> found = TestFixture::search(a, b);
  EXPECT_EQ(found.distance, S(3));
  EXPECT_EQ(found.normal, Vector<S>(S(1), S(0)));
  EXPECT_EQ(found.vertexA, 1);
  EXPECT_EQ(found.vertexB, 0);
}

#ifndef SAMESTEP_FIXED_ONLY
// The ends of an edge of the Minkowski difference are compared with the origin one by one: in a sum, an end
// that almost coincides with it would be lost, and with it which way is out.
TEST(GjkDoubleTest, CornersAnUlpApartAreSeparatedByTheirNormal) {
  const std::vector<Vector<double>> dust = {{9.9800527133012628e-06, -1.4551915228366847e-07},
                                            {1.0119052602911938e-05, 2.8172511603913219e-08},
                                            {9.9800527086505776e-06, 2.8172507882118212e-08}};
  const std::vector<Vector<double>> large = {{9.9800527095794678e-06, -1.4551915228366852e-07},
                                             {1024.0000099674799, 0.0039060988929122686},
                                             {1024.0000099677127, 1023.9999998314306}};
  const Placement<double> a(polyShapeRaw<double>(BodyId(), dust), Transform<double>());
  const Placement<double> b(polyShapeRaw<double>(BodyId(), large), Transform<double>());
  const SupportPair<double> pair{SupportShape<double>(*a), SupportShape<double>(*b)};
  const Vector<double> axis =
      perp(Vector<double>((a->box.left - b->box.left) + (a->box.right - b->box.right),
                          (a->box.bottom - b->box.bottom) + (a->box.top - b->box.top)));
  const ClosestPoints<double> found = gjk<double>(pair, 0, axis, nullptr);
  EXPECT_NEAR(found.distance, 0, 1e-12);
  // All of the large one lies ahead of all of the small one.
  EXPECT_GE(dot(pair.farthest(-found.normal).ab, found.normal), -1e-6);
}

// A vertex may seem to lie outside of an edge that is not its own: it must not be put in twice.
TEST(GjkDoubleTest, EpaTakesNoVertexTwice) {
  const double w = 5.5879354476928711e-09;
  const std::vector<Vector<double>> blade = {{w, -8192}, {w, 8192}, {-w, 8192}, {-w, -8192}};
  const std::vector<Vector<double>> points = {
      {-2.3283064365386963e-10, 0}, {0, 0},
      {0.1318359375, 0.1318359375}, {-0.1953125, -0.1337890625},
      {0.0048828125, 0.1318359375}, {-9.8044984042644501e-07, 0.0048828125}};
  const Vector<double> turn = forAngle(16384.000000011176);
  const Placement<double> a(polyShapeRaw<double>(BodyId(), blade),
                            Transform<double>::rigid({0, -26.24609375}, perp(turn)));
  const Placement<double> b(polyShape<double>(BodyId(), points),
                            Transform<double>::rigid({0, -26.24609375}, -turn));
  const SupportPair<double> pair{SupportShape<double>(*a), SupportShape<double>(*b)};
  for (const std::uint32_t start : {0u, 0x00385822u, 0x00010200u, 0x03000102u, 0x02010300u}) {
    EXPECT_NO_THROW(gjk<double>(pair, start, Vector<double>(), nullptr)) << start;
  }
}

// A vertex of the difference that all but coincides with the origin is lost in sums with other vertices. The
// search took it for a direction and went in a ring until it gave up, with 0 for the overlap of 4 mm.
TEST(GjkDoubleTest, AVertexThatAllButCoincidesWithTheOriginEndsNoSearchInARing) {
  const std::vector<Vector<double>> points = {
      {0, -2.3283064365386963e-10}, {0.3125, 1.9999999976716936}, {0.0048828125, 0.0048828125}};
  const Shape<double> sliver = polyShape<double>(BodyId(), points);
  const Placement<double> a(sliver, Transform<double>::rigid({}, Vector<double>(-1, 0)));
  const Placement<double> b(sliver, Transform<double>::rigid({}, -forAngle(1.1874362826347351e-08)));
  const SupportPair<double> pair{SupportShape<double>(*a), SupportShape<double>(*b)};
  for (std::uint32_t start = 0; start < 0x03000000u; start += 0x00010000u) {
    CollisionStats stats;
    const ClosestPoints<double> found = gjk<double>(pair, start, Vector<double>(), &stats);
    EXPECT_NEAR(found.distance, -0.0040704840447681918, 1e-12) << start;
    EXPECT_EQ(stats.highGjkIterations, 0u) << start;
  }
}

// Each step comes nearer, or rounding has led back: here between two edges, until the search gave up 110 m
// off.
TEST(GjkDoubleTest, ASearchThatDoesNotComeNearerEnds) {
  const double half = 0.34472656273283064, width = 0.34472656296566129, thin = 3.6668498069047928e-06;
  const std::vector<Vector<double>> box = {{half, -width}, {half, width}, {-half, width}, {-half, -width}};
  const std::vector<Vector<double>> blade = {
      {127.90234375, -thin}, {127.90234375, thin}, {-127.90234375, thin}, {-127.90234375, -thin}};
  const Vector<double> turn = forAngle(27.0);
  const Placement<double> a(polyShapeRaw<double>(BodyId(), box), Transform<double>::rigid({126, -58}, turn));
  const Placement<double> b(polyShapeRaw<double>(BodyId(), blade),
                            Transform<double>::rigid({110.8193359375, -58.000000046566129}, -turn));
  const SupportPair<double> pair{SupportShape<double>(*a), SupportShape<double>(*b)};
  for (const std::uint32_t start : {0u, 0x03020202u}) {
    CollisionStats stats;
    EXPECT_NEAR(gjk<double>(pair, start, Vector<double>(), &stats).distance, 14.173691470358605, 1e-9)
        << start;
    EXPECT_EQ(stats.highGjkIterations, 0u) << start;
  }
}

// Four corners of the difference of two crossed planks lie in one line. Rounding put one of them in between
// the ends of a short edge 250 m away, and an edge that ran back was taken for the nearest.
TEST(GjkDoubleTest, EpaIsNotTurnedInsideOutByCornersInOneLine) {
  const std::vector<Vector<double>> points = {{127.99999902234413, -0.062991124112159014},
                                              {127.99999902234413, 0.068844813387840986},
                                              {-128.00000000814907, 0.068844813387840986},
                                              {-128.00000000814907, -0.062991124112159014}};
  const Shape<double> plank = polyShapeRaw<double>(BodyId(), points);
  const Vector<double> turn = forAngle(-0.1953125);
  const Placement<double> a(plank, Transform<double>::rigid({0.0048828125, 0.1318359375}, perp(turn)));
  const Placement<double> b(plank, Transform<double>::rigid({0.0048828125, -0.0380859375}, -turn));
  const SupportPair<double> pair{SupportShape<double>(*a), SupportShape<double>(*b)};
  const ClosestPoints<double> found = gjk<double>(pair, 0, Vector<double>(), nullptr);
  EXPECT_NEAR(found.distance, -127.89629997004306, 1e-9);
}

// A corner lies on an edge that is all but in line with it, and the search goes to and fro between them. The
// corner at which it gave up lies 1e-10 m from the origin: the way there is along the edge, not across it, so
// that it separated the shapes by -1 m.
TEST(GjkDoubleTest, OfAnEdgeAndACornerOnItTheEdgeSeparates) {
  const double unit = 0x1p-32;
  const std::vector<Vector<double>> flat = {{-1, 0}, {1, 0}, {0, unit}};
  const std::vector<Vector<double>> large = {
      {-88, 88}, {-unit, unit}, {-2.4680048227310181e-08, 3166.8750009145588}};
  const Vector<double> turn = forAngle(-88.0);
  const Placement<double> a(polyShapeRaw<double>(BodyId(), flat), Transform<double>::rigid({0, 88}, -turn));
  const Placement<double> b(polyShapeRaw<double>(BodyId(), large),
                            Transform<double>::rigid({0, 88}, perp(turn)));
  const SupportPair<double> pair{SupportShape<double>(*a), SupportShape<double>(*b)};
  for (const std::uint32_t start : {0u, 0x02000000u, 0x00010201u}) {
    const ClosestPoints<double> found = gjk<double>(pair, start, Vector<double>(), nullptr);
    EXPECT_NEAR(found.distance, 0, 1e-8) << start;
    EXPECT_NEAR(dot(pair.farthest(-found.normal).ab, found.normal), 0, 1e-8) << start;
  }
}

// All corners of the difference are within rounding of one line through the corner found last, which left a
// polygon without edges.
TEST(GjkDoubleTest, EpaEndsWhereAllCornersAreInOneLine) {
  const double unit = 0x1p-32;
  const std::vector<Vector<double>> blade = {
      {-1.5463256845250726, -unit}, {3.2780226320028305e-06, 0}, {1.5463256845250726, unit}};
  const Placement<double> a(polyShapeRaw<double>(BodyId(), blade), Transform<double>());
  const Placement<double> b(segmentShape<double>(BodyId(), {0, 0}, {unit, 0}), Transform<double>());
  const SupportPair<double> pair{SupportShape<double>(*a), SupportShape<double>(*b)};
  for (const std::uint32_t start : {0u, 0x02000000u}) {
    ClosestPoints<double> found;
    ASSERT_NO_THROW(found = gjk<double>(pair, start, Vector<double>(), nullptr)) << start;
    EXPECT_NEAR(found.distance, 0, 2 * unit) << start;
  }
}
#endif

// MIS section 13, SameVertices.
TYPED_TEST(GjkTest, EpaOnAPolygonWithoutLengthIsAnInternalError) {
  using S = TypeParam;
  const Placement<S> a(boxShape<S>(BodyId(), S(2), S(2)), Transform<S>());
  const SupportPair<S> pair = TestFixture::pairOf(a, a);
  const MinkowskiPoint<S> v = pair.vertex(0, 2), w = pair.vertex(0, 3);
  EXPECT_THROW(epa<S>(pair, v, v, w, nullptr), SameVertices);
}

}  // namespace
}  // namespace samestep
