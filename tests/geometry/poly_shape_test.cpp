// SPDX-License-Identifier: MIT
#include <samestep/poly_shape.h>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/error.h>

#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class PolyShapeTest : public ::testing::Test {
 protected:
  using Points = std::vector<Vector<S>>;

  static Vector<S> at(int x, int y) { return {S(x), S(y)}; }
  static Points triangle() { return {at(0, 0), at(6, 0), at(0, 3)}; }
  static std::vector<Vector<S>> vertices(const Shape<S>& shape) {
    return {shape.vertices().begin(), shape.vertices().end()};
  }
  /// Corners of a regular shape, counter-clockwise.
  static Points wheel(int count) {
    Points points;
    for (int i = 0; i < count; ++i) points.push_back(forAngle(kPi<S> * ratio<S>(2 * i, count)) * S(8));
    return points;
  }
};
TYPED_TEST_SUITE(PolyShapeTest, AllScalarsAndChecked);

TYPED_TEST(PolyShapeTest, RawPolygonKeepsItsVerticesAndTheirNumbers) {
  using S = TypeParam;
  const auto points = TestFixture::triangle();
  const Shape<S> shape = polyShapeRaw<S>(BodyId(), points, S(1));
  const ConstPolyShape<S> poly(shape);
  EXPECT_EQ(poly.count(), 3);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(poly.vertex(i), points[static_cast<std::size_t>(i)]);
  EXPECT_EQ(poly.radius(), S(1));
  EXPECT_THROW(poly.vertex(3), IndexOutOfBounds);
  EXPECT_THROW(poly.vertex(-1), IndexOutOfBounds);
}

TYPED_TEST(PolyShapeTest, PolygonIsTheHullOfItsPointsUnderTheTransform) {
  using S = TypeParam;
  auto points = TestFixture::triangle();
  points.push_back(TestFixture::at(1, 1));
  // Mirrored, so that the points go round the other way.
  const Transform<S> mirror(S(-1), S(0), S(0), S(1), S(10), S(0));
  EXPECT_EQ(
      TestFixture::vertices(polyShape<S>(BodyId(), points, mirror)),
      (typename TestFixture::Points{TestFixture::at(4, 0), TestFixture::at(10, 0), TestFixture::at(10, 3)}));
}

TYPED_TEST(PolyShapeTest, BoxBeginsAtItsBottomRightCorner) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  EXPECT_EQ(TestFixture::vertices(boxShape<S>(BodyId(), S(2), S(4), S(1))),
            (typename TestFixture::Points{at(1, -2), at(1, 2), at(-1, 2), at(-1, -2)}));
  EXPECT_EQ(TestFixture::vertices(boxShape<S>(BodyId(), BB<S>(S(1), S(2), S(3), S(5)))),
            (typename TestFixture::Points{at(3, 2), at(3, 5), at(1, 5), at(1, 2)}));
}

TYPED_TEST(PolyShapeTest, SettersKeepTheMassAndRenewTheMoment) {
  using S = TypeParam;
  Shape<S> shape = boxShape<S>(BodyId(), S(1), S(1));
  shape.setMass(S(12));
  PolyShape<S> poly(shape);
  poly.setVerticesRaw(TestFixture::vertices(boxShape<S>(BodyId(), S(2), S(4))));
  EXPECT_LE(abs(shape.moment() - S(20)), S(0x1p-32));
  EXPECT_EQ(shape.mass(), S(12));
  poly.setVertices(TestFixture::triangle(), Transform<S>::translation(TestFixture::at(-2, -1)));
  EXPECT_EQ(poly.count(), 3);
  EXPECT_EQ(shape.centerOfMass(), Vector<S>());
  poly.setRadius(S(2));
  EXPECT_EQ(poly.radius(), S(2));
  EXPECT_EQ(poly.vertex(0), TestFixture::at(-2, -1));
}

TYPED_TEST(PolyShapeTest, AnotherTypeIsNoPolygon) {
  using S = TypeParam;
  Shape<S> circle = circleShape<S>(BodyId(), S(1));
  EXPECT_THROW(PolyShape<S>{circle}, NotPolyShape);
  EXPECT_THROW(ConstPolyShape<S>{circle}, NotPolyShape);
}

TYPED_TEST(PolyShapeTest, RefusesDegeneratePolygonsAndKeepsTheOld) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  Shape<S> shape = boxShape<S>(BodyId(), S(1), S(1));
  const Shape<S> before = shape;
  PolyShape<S> poly(shape);
  const typename TestFixture::Points tooFew = {at(0, 0), at(1, 0)},
                                     collinear = {at(0, 0), at(1, 1), at(2, 2)},
                                     repeated = {at(0, 0), at(4, 0), at(4, 0), at(0, 4)},
                                     clockwise = {at(0, 0), at(0, 1), at(1, 0)},
                                     dented = {at(0, 0), at(4, 0), at(1, 1), at(0, 4)},
                                     straight = {at(0, 0), at(2, 0), at(4, 0), at(0, 4)},
                                     star = {at(0, 10), at(-6, -8), at(9, 3), at(-9, 3), at(6, -8)};
  for (const typename TestFixture::Points& bad :
       {tooFew, collinear, repeated, clockwise, dented, straight, star}) {
    EXPECT_THROW(poly.setVerticesRaw(bad), DegenerateShape);
    EXPECT_THROW(polyShapeRaw<S>(BodyId(), bad), DegenerateShape);
  }
  EXPECT_THROW(poly.setVertices(tooFew), DegenerateShape);
  EXPECT_THROW(poly.setVertices(collinear), DegenerateShape);
  EXPECT_THROW(polyShape<S>(BodyId(), typename TestFixture::Points(5, at(1, 1))), DegenerateShape);
  EXPECT_EQ(shape, before);
  // The hull puts these right.
  EXPECT_EQ(ConstPolyShape<S>(polyShape<S>(BodyId(), repeated)).count(), 3);
  EXPECT_EQ(ConstPolyShape<S>(polyShape<S>(BodyId(), star)).count(), 5);
}

TYPED_TEST(PolyShapeTest, RefusesMoreVerticesThanThereIsRoomFor) {
  using S = TypeParam;
  EXPECT_EQ(ConstPolyShape<S>(polyShape<S>(BodyId(), TestFixture::wheel(kMaxPolyVertices))).count(),
            kMaxPolyVertices);
  EXPECT_EQ(ConstPolyShape<S>(polyShapeRaw<S>(BodyId(), TestFixture::wheel(kMaxPolyVertices))).count(),
            kMaxPolyVertices);
  EXPECT_THROW(polyShape<S>(BodyId(), TestFixture::wheel(kMaxPolyVertices + 1)), TooManyVertices);
  EXPECT_THROW(polyShapeRaw<S>(BodyId(), TestFixture::wheel(kMaxPolyVertices + 1)), TooManyVertices);
}

TYPED_TEST(PolyShapeTest, RefusesNegativeAndTooLarge) {
  using S = TypeParam;
  EXPECT_THROW(polyShapeRaw<S>(BodyId(), TestFixture::triangle(), S(-1)), NegativeRadius);
  EXPECT_THROW(boxShape<S>(BodyId(), S(-1), S(1)), NegativeHalfDimensions);
  EXPECT_THROW(boxShape<S>(BodyId(), BB<S>(S(1), S(0), S(0), S(1))), NegativeHalfDimensions);
  EXPECT_THROW(boxShape<S>(BodyId(), S(0), S(1)), DegenerateShape);
  EXPECT_THROW(boxShape<S>(BodyId(), S(2 * kMaxExtent), S(1)), SizeOutOfRange);
  EXPECT_THROW(polyShape<S>(BodyId(), TestFixture::triangle(), Transform<S>::scaling(S(1 << 29), S(1))),
               SizeOutOfRange);
}

TYPED_TEST(PolyShapeTest, CentroidAreaAndMomentOfATriangle) {
  using S = TypeParam;
  const auto points = TestFixture::triangle();
  EXPECT_EQ(centroidForPoly<S>(points), TestFixture::at(2, 1));
  EXPECT_EQ(areaForPoly<S>(points, S(0)), S(9));
  // (36 + 9 + 45) / 36 about the centroid, for each kilogram.
  EXPECT_EQ(momentForPoly<S>(S(2), points, TestFixture::at(-2, -1), S(0)), S(5));
  EXPECT_EQ(momentForPoly<S>(S(2), points, Vector<S>(), S(0)), S(15));
}

TYPED_TEST(PolyShapeTest, ClockwiseTurnsOnlyTheSignOfTheArea) {
  using S = TypeParam;
  auto points = TestFixture::triangle();
  std::swap(points[0], points[2]);
  EXPECT_EQ(centroidForPoly<S>(points), TestFixture::at(2, 1));
  EXPECT_EQ(areaForPoly<S>(points, S(0)), S(-9));
  EXPECT_EQ(momentForPoly<S>(S(2), points, Vector<S>(), S(0)), S(15));
}

TYPED_TEST(PolyShapeTest, RoundingAddsAStripAndACircleToTheArea) {
  using S = TypeParam;
  const auto box = TestFixture::vertices(boxShape<S>(BodyId(), S(2), S(4)));
  EXPECT_EQ(areaForPoly<S>(box, S(1)), S(8) + S(12) + kPi<S>);
}

TYPED_TEST(PolyShapeTest, MassPropertiesDoNotDependOnWhereTheOriginIs) {
  using S = TypeParam;
  const S unit = S(0x1p-12);
  for (const auto& offset : {Vector<S>(), TestFixture::at(8000, -9000)}) {
    const typename TestFixture::Points points = {offset, offset + Vector<S>(S(6) * unit, S(0)),
                                                 offset + Vector<S>(S(0), S(3) * unit)};
    const Shape<S> shape = polyShapeRaw<S>(BodyId(), points);
    EXPECT_EQ(shape.centerOfMass(), offset + Vector<S>(unit + unit, unit));
    EXPECT_EQ(toScalar<S>(shape.massInfo().unitMoment * toScaled(S(1 << 24))), ratio<S>(5, 2));
    EXPECT_EQ(shape.area(), S(9) * unit * unit);
  }
}

TYPED_TEST(PolyShapeTest, WithoutAreaTheCentroidIsBetweenTheEnds) {
  using S = TypeParam;
  const typename TestFixture::Points line = {TestFixture::at(0, 0), TestFixture::at(2, 2),
                                             TestFixture::at(6, 6)};
  EXPECT_EQ(centroidForPoly<S>(line), TestFixture::at(3, 3));
  const typename TestFixture::Points two = {TestFixture::at(-2, 0), TestFixture::at(2, 0)};
  EXPECT_EQ(momentForPoly<S>(S(3), two, Vector<S>(), S(0)), S(4));
  EXPECT_EQ(momentForPoly<S>(S(3), two, TestFixture::at(0, 1), S(0)), S(7));
  EXPECT_THROW(centroidForPoly<S>(std::span<const Vector<S>>()), IndexOutOfBounds);
}

TYPED_TEST(PolyShapeTest, MomentForBoxTakesSidesOrABox) {
  using S = TypeParam;
  EXPECT_EQ(momentForBox<S>(S(3), S(2), S(4)), S(5));
  EXPECT_EQ(momentForBox<S>(S(3), BB<S>(S(-1), S(-2), S(1), S(2))), S(5));
  EXPECT_EQ(momentForBox<S>(S(3), BB<S>(S(0), S(0), S(2), S(4))), S(20));
}

#ifndef SAMESTEP_FIXED_ONLY
TEST(PolyShapeDoubleTest, RefusesWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<Vector<double>> good = {{0, 0}, {1, 0}, {0, 1}}, bad = {{0, 0}, {1, nan}, {0, 1}};
  EXPECT_THROW(polyShapeRaw<double>(BodyId(), bad), ValueOutOfRange);
  EXPECT_THROW(polyShape<double>(BodyId(), bad), ValueOutOfRange);
  EXPECT_THROW(polyShapeRaw<double>(BodyId(), good, inf), ValueOutOfRange);
  EXPECT_THROW(polyShape<double>(BodyId(), good, Transform<double>::scaling(nan, 1)), ValueOutOfRange);
  EXPECT_THROW(boxShape<double>(BodyId(), nan, 1), ValueOutOfRange);
  EXPECT_THROW(boxShape<double>(BodyId(), BB<double>(0, 0, 1, nan)), ValueOutOfRange);
}
#endif

}  // namespace
}  // namespace samestep
