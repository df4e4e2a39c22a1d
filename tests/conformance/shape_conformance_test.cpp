// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <samestep/control.h>

#include "chipmunk_shapes.h"

namespace samestep {
namespace {

constexpr int kShapes = 2000;

/// |a - b| relative to the larger of them, or to `least`.
double relative(double a, double b, double least = 0) {
  const double size = std::fmax(std::fmax(std::fabs(a), std::fabs(b)), least);
  return size > 0 ? std::fabs(a - b) / size : 0;
}

/// Sizes from centimetres to a hundred metres.
double randomSize(RecipeSource& source) { return std::ldexp(1, source.random().between(-5, 7)); }

template <class S>
class ShapeConformanceTest : public ::testing::Test {
 protected:
  static constexpr bool kExact = std::is_same_v<S, double>;
  /// double: the same formulas in another order. Fixed: half a unit of 2^-32 on the result, and what a square
  /// root or a radius of that precision makes of it.
  static double tolerance(double value) { return kExact ? 1e-9 : 1e-9 + 0x1p-30 / std::fabs(value); }

  static void expectNear(S found, double expected, const char* what) {
    EXPECT_LE(relative(static_cast<double>(found), expected), tolerance(expected)) << what << " " << expected;
  }
  static void expectNear(const Vector<S>& found, cpVect expected, double size) {
    const Vector<double> v = toDouble(found);
    EXPECT_LE(std::hypot(v.x - expected.x, v.y - expected.y),
              size * (kExact ? 1e-9 : 0) + (kExact ? 0 : 0x1p-27));
  }
  static std::vector<cpVect> chipmunkPoints(const std::vector<Vector<double>>& points) {
    std::vector<cpVect> result;
    for (const Vector<double>& v : points) result.push_back(toChipmunk(v));
    return result;
  }
};
using BothScalars = ::testing::Types<double, Fixed>;
TYPED_TEST_SUITE(ShapeConformanceTest, BothScalars);

TYPED_TEST(ShapeConformanceTest, MassPropertiesAreThoseOfChipmunk) {
  using S = TypeParam;
  RecipeSource source(41);
  for (int i = 0; i < kShapes; ++i) {
    const double size = randomSize(source);
    const auto type = static_cast<ShapeType>(i % 3);
    const ShapeRecipe recipe = source.shape(type, size, i % 2 == 0);
    const ChipmunkShape chipmunk(recipe, Transform<double>());
    Shape<S> shape = build<S>(recipe);
    shape.setMass(S(8));
    cpShapeSetMass(chipmunk.get(), 8);

    this->expectNear(shape.area(), cpShapeGetArea(chipmunk.get()), "area");
    // Chipmunk 7.0.3 and this library give the moment about the centroid of the shape.
    this->expectNear(shape.moment(), cpShapeGetMoment(chipmunk.get()), "moment");
    this->expectNear(shape.centerOfMass(), cpShapeGetCenterOfGravity(chipmunk.get()), size);
    const double area = cpShapeGetArea(chipmunk.get()), density = cpShapeGetDensity(chipmunk.get());
    if (area > 0) {
      EXPECT_LE(relative(static_cast<double>(shape.density()), density),
                this->tolerance(density) + this->tolerance(area));
    }
  }
}

TYPED_TEST(ShapeConformanceTest, MomentAndAreaFunctionsAreThoseOfChipmunk) {
  using S = TypeParam;
  RecipeSource source(42);
  for (int i = 0; i < kShapes; ++i) {
    const double size = randomSize(source), mass = source.number(1, 100);
    const double r1 = source.number(0, size), r2 = source.number(size / 16, size);
    const Vector<double> a = source.point(size), b = source.point(size), offset = source.point(size);
    const ShapeRecipe poly = source.shape(ShapeType::poly, size, false);
    const std::vector<Vector<S>> vertices = convert<S>(poly.points);
    const std::vector<cpVect> points = this->chipmunkPoints(poly.points);
    const int count = static_cast<int>(points.size());

    this->expectNear(momentForCircle<S>(S(mass), S(r1), S(r2), convert<S>(offset)),
                     cpMomentForCircle(mass, r1, r2, toChipmunk(offset)), "circle");
    this->expectNear(momentForSegment<S>(S(mass), convert<S>(a), convert<S>(b), S(r1)),
                     cpMomentForSegment(mass, toChipmunk(a), toChipmunk(b), r1), "segment");
    this->expectNear(momentForPoly<S>(S(mass), vertices, convert<S>(offset), S(r1)),
                     cpMomentForPoly(mass, count, points.data(), toChipmunk(offset), r1), "poly");
    this->expectNear(momentForBox<S>(S(mass), S(r1), S(r2)), cpMomentForBox(mass, r1, r2), "box");
    this->expectNear(
        momentForBox<S>(S(mass), BB<S>(S(offset.x), S(offset.y), S(offset.x + r1), S(offset.y + r2))),
        cpMomentForBox2(mass, cpBBNew(offset.x, offset.y, offset.x + r1, offset.y + r2)), "box2");
    this->expectNear(areaForCircle<S>(S(r1), S(r2)), cpAreaForCircle(r1, r2), "area of circle");
    this->expectNear(areaForSegment<S>(convert<S>(a), convert<S>(b), S(r1)),
                     cpAreaForSegment(toChipmunk(a), toChipmunk(b), r1), "area of segment");
    this->expectNear(areaForPoly<S>(vertices, S(r1)), cpAreaForPoly(count, points.data(), r1),
                     "area of poly");
    this->expectNear(centroidForPoly<S>(vertices), cpCentroidForPoly(count, points.data()), size);
  }
}

TYPED_TEST(ShapeConformanceTest, HullsAreThoseOfChipmunk) {
  using S = TypeParam;
  RecipeSource source(43);
  for (int i = 0; i < kShapes; ++i) {
    const double size = randomSize(source), slack = i % 2 == 0 ? 0 : source.number(0, size / 16);
    std::vector<Vector<double>> points(3 + source.random().below(40));
    for (Vector<double>& v : points) v = source.point(size);
    const std::vector<cpVect> input = this->chipmunkPoints(points);
    std::vector<cpVect> expected(input.size());
    int expectedFirst = -1;
    const int expectedCount =
        cpConvexHull(static_cast<int>(input.size()), input.data(), expected.data(), &expectedFirst, slack);

    const std::vector<Vector<S>> ours = convert<S>(points);
    std::vector<Vector<S>> hull(ours.size());
    int first = -1;
    const int count = convexHull<S>(ours, hull, &first, S(slack));

    ASSERT_EQ(count, expectedCount) << i;
    EXPECT_EQ(first, expectedFirst) << i;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      EXPECT_EQ(toDouble(hull[k]), fromChipmunk(expected[k])) << i;
    }
  }
}

TYPED_TEST(ShapeConformanceTest, BoxesAreThoseOfChipmunk) {
  using S = TypeParam;
  RecipeSource source(44);
  for (int i = 0; i < kShapes; ++i) {
    const ShapeRecipe recipe = source.shape(static_cast<ShapeType>(i % 3), 4, i % 2 == 0);
    const Transform<double> pose = source.pose(1000);
    const ChipmunkShape chipmunk(recipe, pose);
    const cpBB expected = cpShapeGetBB(chipmunk.get());
    const BB<S> found = boundingBox(build<S>(recipe), convert<S>(pose));
    this->expectNear(Vector<S>(found.left, found.bottom), cpv(expected.l, expected.b), 4);
    this->expectNear(Vector<S>(found.right, found.top), cpv(expected.r, expected.t), 4);
  }
}

TYPED_TEST(ShapeConformanceTest, PointQueriesAreThoseOfChipmunk) {
  using S = TypeParam;
  RecipeSource source(45);
  for (int i = 0; i < kShapes; ++i) {
    const ShapeRecipe recipe = source.shape(static_cast<ShapeType>(i % 3), 4, i % 2 == 0);
    const Transform<double> pose = source.pose(2);
    const ChipmunkShape chipmunk(recipe, pose);
    const Vector<double> point = source.point(5);
    cpPointQueryInfo expected;
    cpShapePointQuery(chipmunk.get(), toChipmunk(point), &expected);
    const PointQueryInfo<S> found =
        pointQuery(*Placement<S>(build<S>(recipe), convert<S>(pose)), convert<S>(point));
    EXPECT_NEAR(static_cast<double>(found.distance), expected.distance, this->kExact ? 4e-9 : 0x1p-28) << i;
    // A direction from a point this near to the surface is not to be compared.
    if (std::fabs(expected.distance + recipe.radius) < 1e-3) continue;
    this->expectNear(found.point, expected.point, 4);
    EXPECT_LE(far(toDouble(found.gradient), fromChipmunk(expected.gradient)), this->kExact ? 1e-9 : 1e-6)
        << i;
  }
}

TYPED_TEST(ShapeConformanceTest, SegmentQueriesAreThoseOfChipmunk) {
  using S = TypeParam;
  RecipeSource source(46);
  int hits = 0, differing = 0;
  for (int i = 0; i < kShapes; ++i) {
    const ShapeRecipe recipe = source.shape(static_cast<ShapeType>(i % 3), 4, i % 2 == 0);
    const Transform<double> pose = source.pose(2);
    const ChipmunkShape chipmunk(recipe, pose);
    const Vector<double> a = source.point(8), b = source.point(8);
    const double radius = i % 4 == 0 ? source.number(0, 1) : 0;
    cpSegmentQueryInfo expected;
    const bool expectedHit =
        cpShapeSegmentQuery(chipmunk.get(), toChipmunk(a), toChipmunk(b), radius, &expected) != 0;
    const SegmentQueryInfo<S> found = segmentQuery(*Placement<S>(build<S>(recipe), convert<S>(pose)),
                                                   convert<S>(a), convert<S>(b), S(radius));
    // Beside the end of a thick segment Chipmunk takes the far face for the first thing met.
    if (recipe.type == ShapeType::segment &&
        (found.hit != expectedHit || far(toDouble(found.normal), fromChipmunk(expected.normal)) > 0.1)) {
      ++differing;
      continue;
    }
    ASSERT_EQ(found.hit, expectedHit) << i;
    if (!found.hit || expected.alpha == 0) continue;
    ++hits;
    EXPECT_NEAR(static_cast<double>(found.alpha), expected.alpha, this->kExact ? 1e-9 : 1e-7) << i;
    EXPECT_LE(far(toDouble(found.normal), fromChipmunk(expected.normal)), this->kExact ? 1e-7 : 1e-5) << i;
    EXPECT_LE(far(toDouble(found.point), fromChipmunk(expected.point)), this->kExact ? 1e-8 : 1e-5) << i;
  }
  EXPECT_GT(hits, kShapes / 6);
  EXPECT_LT(differing, kShapes / 50);
}

}  // namespace
}  // namespace samestep
