// SPDX-License-Identifier: MIT
// Convex hull, polygon set-up and mass properties, against exact integers and rationals.
#include <samestep/control.h>
#include <samestep/poly_shape.h>

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/error.h>
#include <samestep/segment_shape.h>

#include "cases.h"
#include "check.h"
#include "distance.h"
#include "input.h"

namespace samestep::fuzz {
namespace {

__extension__ typedef __int128 Int128;
using Point = Vector<Fixed>;

constexpr int kMostPoints = 40;

std::vector<Point> current;

void describe() {
  std::fprintf(stderr, "points");
  for (const Point& p : current) {
    std::fprintf(stderr, " (%lld, %lld)", static_cast<long long>(p.x.raw()),
                 static_cast<long long>(p.y.raw()));
  }
  std::fprintf(stderr, " in units of 2^-32\n");
}

/// Twice the area of a, b, c: positive counter-clockwise.
Int128 turn(const Point& a, const Point& b, const Point& c) {
  const auto difference = [](Fixed x, Fixed y) { return Int128{x.raw()} - y.raw(); };
  return difference(b.x, a.x) * difference(c.y, a.y) - difference(b.y, a.y) * difference(c.x, a.x);
}

bool isOneOf(const std::vector<Point>& points, const Point& p) {
  return std::find(points.begin(), points.end(), p) != points.end();
}

/// Checks that a hull without tolerance is exact: made of the points, strictly convex, with none of them
/// outside.
void checkExactHull(const std::vector<Point>& points) {
  std::vector<Point> hull(points.size());
  int first = -1;
  const int count = convexHull<Fixed>(points, hull, &first);
  hull.resize(static_cast<std::size_t>(count));
  expect(count >= 1 && first >= 0 && points[static_cast<std::size_t>(first)] == hull[0],
         "the first point is known");
  for (const Point& p : hull) expect(isOneOf(points, p), "a hull is made of the points");
  for (const Point& p : points) {
    expect(hull[0].x < p.x || (hull[0].x == p.x && hull[0].y <= p.y),
           "a hull begins with the leftmost, lowest point");
  }
  if (count == 1) {
    for (const Point& p : points) expect(p == points[0], "one point is the hull of one place only");
    return;
  }
  if (count == 2) {
    for (const Point& p : points)
      expect(turn(hull[0], hull[1], p) == 0, "two points are the hull of a line only");
    return;
  }
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point &a = hull[i], &b = hull[(i + 1) % hull.size()], &c = hull[(i + 2) % hull.size()];
    expect(turn(a, b, c) > 0, "a hull is strictly convex: no point of it can be left out");
    for (const Point& p : points) expect(turn(a, b, p) >= 0, "no point is outside of the hull");
  }

  // The points in any order, and the hull itself, have the same hull.
  std::vector<Point> turned(points.rbegin(), points.rend()), again(points.size());
  const int countAgain = convexHull<Fixed>(turned, again);
  expect(countAgain == count && std::equal(hull.begin(), hull.end(), again.begin()), "order does not matter");
  std::vector<Point> own(hull.size());
  expect(convexHull<Fixed>(hull, own) == count && own == hull, "the hull of a hull is itself");
}

/// Checks that with a tolerance no point is much farther outside than it, and what is left is a part of the
/// exact hull.
void checkTolerantHull(const std::vector<Point>& points, Fixed tolerance) {
  std::vector<Point> hull(points.size());
  const int count = convexHull<Fixed>(points, hull, nullptr, tolerance);
  hull.resize(static_cast<std::size_t>(count));
  for (const Point& p : hull) expect(isOneOf(points, p), "a hull is made of the points");
  for (const Point& p : points) {
    expectAtMost(distanceToCore(hull.data(), count, p), static_cast<double>(tolerance) + 0x1p-31,
                 "no point is outside by more than the tolerance");
  }
}

struct Exact {
  mpq_class doubleArea, centroidX, centroidY, moment;  ///< The moment per kilogram about the centroid.
};

/// The textbook formulas, in rational numbers, in metres.
Exact integrate(std::span<const Point> v) {
  Exact sums;
  const auto at = [&](std::size_t i) {
    const Point& p = v[i % v.size()];
    return std::pair<mpq_class, mpq_class>(mpq_class(static_cast<double>(p.x)),
                                           mpq_class(static_cast<double>(p.y)));
  };
  mpq_class aboutOrigin;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto [ax, ay] = at(i);
    const auto [bx, by] = at(i + 1);
    const mpq_class area = ax * by - ay * bx;
    sums.doubleArea += area;
    sums.centroidX += area * (ax + bx);
    sums.centroidY += area * (ay + by);
    aboutOrigin += area * (ax * ax + ax * bx + bx * bx + ay * ay + ay * by + by * by);
  }
  sums.centroidX /= 3 * sums.doubleArea;
  sums.centroidY /= 3 * sums.doubleArea;
  sums.moment =
      aboutOrigin / (6 * sums.doubleArea) - sums.centroidX * sums.centroidX - sums.centroidY * sums.centroidY;
  return sums;
}

double toDouble(const Scaled<Fixed>& x) {
  return std::ldexp(static_cast<double>(x.mantissa()), static_cast<int>(x.exponent()));
}
double toDouble(double x) { return x; }

void expectRatio(double found, const mpq_class& exact, double tolerance, const char* claim) {
  expectNear(found / exact.get_d(), 1, tolerance, claim);
}

template <Scalar S>
void checkMass(const Shape<S>& shape, const Exact& exact, double slimness) {
  const ShapeMassInfo<S>& info = shape.massInfo();
  // A sliver's moment is a difference of numbers that are larger by the square of its slimness.
  const double tolerance = 0x1p-50 + (kIsFixed<S> ? 0x1p-54 : 0x1p-46) * (1 + slimness * slimness);
  const double size = static_cast<double>(shape.extent());
  const double place = kIsFixed<S> ? 0x1p-31 + size * slimness * 0x1p-58 : size * (1 + slimness) * 0x1p-48;
  expectNear(static_cast<double>(info.centroid.x), exact.centroidX.get_d(), place, "the centroid is exact");
  expectNear(static_cast<double>(info.centroid.y), exact.centroidY.get_d(), place, "the centroid is exact");
  if (tolerance < 1e-3) {
    expectRatio(toDouble(info.unitMoment), exact.moment, tolerance, "the moment is exact");
    if (shape.radius() == S(0)) {
      expectRatio(toDouble(info.area), exact.doubleArea / 2, tolerance, "the area is exact");
    }
  }
}

/// Setting what is there changes nothing, and the functions for numbers say what the shape says.
void checkMeasures(const Shape<Fixed>& shape) {
  Shape<Fixed> copy = shape;
  Fixed area, moment;
  const Fixed mass(3);
  copy.setMass(mass);
  const Shape<Fixed> whole = copy;
  const Vector<Fixed> none;
  switch (shape.type()) {
    case ShapeType::circle: {
      CircleShape<Fixed> circle(copy);
      circle.setRadius(circle.radius());
      circle.setOffset(circle.offset());
      area = areaForCircle(Fixed(0), shape.radius());
      moment = momentForCircle(mass, Fixed(0), shape.radius(), none);
      break;
    }
    case ShapeType::segment: {
      SegmentShape<Fixed> segment(copy);
      segment.setEndpoints(segment.a(), segment.b());
      segment.setRadius(segment.radius());
      area = areaForSegment(segment.a(), segment.b(), shape.radius());
      moment = momentForSegment(mass, segment.a(), segment.b(), shape.radius());
      break;
    }
    case ShapeType::poly: {
      PolyShape<Fixed> poly(copy);
      poly.setRadius(poly.radius());
      const std::span<const Point> vertices = shape.vertices();
      poly.setVerticesRaw(vertices);
      poly.setVertices(vertices);
      area = areaForPoly(vertices, shape.radius());
      moment = momentForPoly(mass, vertices, none, Fixed(0));
      // A line has a centroid, too.
      const Point middle = centroidForPoly(vertices.first(2));
      expect(middle == lerp(vertices[0], vertices[1], Fixed(0.5)) ||
                 middle == lerp(vertices[1], vertices[0], Fixed(0.5)),
             "the centroid of a line is its middle");
      expect(momentForPoly(mass, vertices.first(2), none, Fixed(0)) >= Fixed(0), "a line has a moment");
      const BB<Fixed> box{shape.vertices()[0].x, shape.vertices()[0].y, shape.vertices()[0].x + Fixed(2),
                          shape.vertices()[0].y + Fixed(1)};
      expect(momentForBox(mass, Fixed(2), Fixed(1)) <= momentForBox(mass, box),
             "off the centre a moment is larger");
      break;
    }
  }
  if (shape.type() != ShapeType::poly) {
    expect(copy.sameGeometry(whole) && copy.massInfo() == whole.massInfo(),
           "setting what is there changes nothing");
  }
  expect(copy.wellFormed(), "a shape that was set anew is well formed");
  expect(shape.area() == area, "the area of the numbers is that of the shape");
  expect(whole.moment() <= moment || shape.type() != ShapeType::circle ||
             moment == std::numeric_limits<Fixed>::max(),
         "about the centroid a moment is least");
  const Fixed density = whole.density();
  expect(sign(shape.massInfo().area) != 0 || density == Fixed(0), "without area there is no density");
}

/// A copy is the same; with anything changed it is another.
void checkSame(const Shape<Fixed>& shape) {
  expect(Shape<Fixed>(shape) == shape, "a copy is the same");
  const auto expectOther = [&](auto&& change) {
    Shape<Fixed> other = shape;
    change(other);
    expect(!(other == shape), "a shape with something changed is another");
    other = shape;
    expect(other == shape, "what is assigned is the same");
  };
  const Fixed step = Fixed::ratio(1, 8);
  expectOther([&](Shape<Fixed>& other) { other.setElasticity(shape.elasticity() + step); });
  expectOther([&](Shape<Fixed>& other) { other.setFriction(shape.friction() + step); });
  expectOther([&](Shape<Fixed>& other) { other.setSurfaceVelocity({step, step}); });
  expectOther([&](Shape<Fixed>& other) { other.setUserData(shape.userData() + 1); });
  expectOther([&](Shape<Fixed>& other) { other.setBody({7, 1}); });
  expectOther([&](Shape<Fixed>& other) { other.setCollisionType(shape.collisionType() + 1); });
  expectOther([&](Shape<Fixed>& other) { other.setRollingResistance(shape.rollingResistance() + step); });
  expectOther([&](Shape<Fixed>& other) { other.setMaterial(shape.material() + 1); });
  expectOther([&](Shape<Fixed>& other) { other.setFilter({1, 2, 3}); });
  expectOther([&](Shape<Fixed>& other) { other.setSensor(true); });
  expectOther([&](Shape<Fixed>& other) { other.setMass(Fixed(5)); });
}

/// Checks what a factory makes of a plan: it is refused with a type, or a shape that is whole.
void checkShape(const ShapePlan& plan) {
  const auto shape = build<Fixed>(plan);
  const auto checked = build<CheckedFixed>(plan);
  expect(shape.has_value() == checked.has_value(), "CheckedFixed takes what Fixed takes");
  if (!shape) return;
  expect(shape->wellFormed(), "a shape that was made is well formed");
  expect(shape->vertices().size() <= kMaxPolyVertices, "no shape has too many vertices");
  checkMeasures(*shape);
  checkSame(*shape);
  Shape<Fixed> copy = *shape;
  copy.setMass(Fixed(3));
  try {
    copy.setDensity(Fixed(2));
  } catch (const MassOutOfRange&) {
  }
  expect(copy.wellFormed(), "a shape with another mass is well formed");
  if (shape->type() != ShapeType::poly) return;

  const std::span<const Point> v = shape->vertices();
  current.assign(v.begin(), v.end());
  const Exact exact = integrate(v);
  const double size = static_cast<double>(shape->extent());
  const double slimness = size * size / std::fabs(exact.doubleArea.get_d());
  checkMass(*shape, exact, slimness);
  const auto real = build<double>(plan);
  if (real && real->vertices().size() == v.size()) checkMass(*real, exact, slimness);
}

void run(Input& input) {
  const std::uint64_t head = input.word();
  if ((head & 3) == 0) return checkShape(readShape(input));
  current.clear();
  constexpr Fixed kLimits[] = {Fixed(kMaxNumber), Fixed(4), Fixed::fromRaw(8), Fixed(1 << 14)};
  const Fixed limit = kLimits[byteOf(head, 1) & 3];
  const int count = 1 + byteOf(head, 2) % kMostPoints;
  for (int i = 0; i < count; ++i) {
    const Fixed x = input.numberIn(-limit, limit);
    current.push_back({x, input.numberIn(-limit, limit)});
  }
  checkExactHull(current);
  if ((head & 4) != 0) checkTolerantHull(current, input.numberIn(Fixed(0), Fixed(kMaxNumber)));
  std::vector<Vector<CheckedFixed>> points, hull(current.size());
  for (const Point& p : current) points.push_back(as<CheckedFixed>(p));
  convexHull<CheckedFixed>(points, hull);
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  samestep::fuzz::describer() = samestep::fuzz::describe;
  samestep::fuzz::Input input(data, size);
  samestep::fuzz::guarded([&] { samestep::fuzz::run(input); });
  return 0;
}
