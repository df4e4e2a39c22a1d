// SPDX-License-Identifier: MIT
// collide() for all pairs of shapes, in all scalars, against brute force and against itself.
#include <samestep/collision.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <samestep/limits.h>

#include "cases.h"
#include "check.h"
#include "distance.h"

namespace samestep::fuzz {
namespace {

struct Case {
  ShapePlan shapeA, shapeB;
  PosePlan poseA, poseB;
  bool same = false;  ///< True if B is the same shape as A.
  Fixed margin{};
  CollisionId start = 0;
  std::uint64_t choice = 0;  ///< Choice of the dearer checks that are made.
};
Case current;

/// The dearer checks; each is made on a part of the inputs, as the hash of all bytes has it.
enum class Choice { checked, real, start, shift, turn, out, aside, rational, plain };
bool chosen(Choice what) {
  const std::uint64_t bits = current.choice;
  switch (what) {
    case Choice::checked:
      return (bits & 3) == 0;
    case Choice::real:
      return (bits & 4) == 0;
    case Choice::start:
      return (bits & 8) == 0;
    case Choice::shift:
      return (bits >> 4 & 3) == 0;
    case Choice::turn:
      return (bits >> 6 & 3) == 0;
    case Choice::out:
      return (bits >> 8 & 3) == 0;
    case Choice::aside:
      return (bits >> 8 & 3) == 1;
    case Choice::plain:
      return (bits >> 16 & 15) == 0;
    case Choice::rational:
      // One in 128 is checked of those in double, one in 256 of all.
      return (bits >> 9 & 0x7f) == 0;
  }
  return false;
}

/// The answer looked at last, for the report.
Vector<double> lastNormal;
CollisionPoint<double> lastPoints[kMaxContactsPerPair];
int lastCount = 0;

template <Scalar S>
Vector<double> toDouble(const Vector<S>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y)};
}
template <Scalar S>
void remember(const CollisionInfo<S>& info) {
  lastCount = info.count;
  lastNormal = toDouble(info.normal);
  for (int i = 0; i < info.count; ++i) {
    lastPoints[i] = {toDouble(info.points[i].pointA), toDouble(info.points[i].pointB), info.points[i].hash};
  }
}

void describe() {
  print("A", current.shapeA, current.poseA);
  print("B", current.shapeB, current.poseB);
  std::fprintf(stderr, "margin %.17g, start %08x, choice %llx\n", static_cast<double>(current.margin),
               current.start, static_cast<unsigned long long>(current.choice));
  std::fprintf(stderr, "answer: %d points, normal (%.17g, %.17g)\n", lastCount, lastNormal.x, lastNormal.y);
  for (int i = 0; i < lastCount; ++i) {
    const CollisionPoint<double>& p = lastPoints[i];
    std::fprintf(stderr, "answer: (%.17g, %.17g) on A, (%.17g, %.17g) on B, %08x\n", p.pointA.x, p.pointA.y,
                 p.pointB.x, p.pointB.y, p.hash);
  }
}

/// Faces that lie 2^-20 m flat on each other count as one: collide takes the first shape's. It compares them
/// by places cut to 2^-22 m, which for two faces adds up to as much again.
constexpr double kFlat = 0x1p-19;
/// Ratio below which double makes no promise: the thickness of the Minkowski difference to its size.
constexpr double kThin = 0x1p-20;
/// Ratio of an edge to the size below which it makes none either.
constexpr double kDust = 0x1p-30;

template <Scalar S>
struct Bounds {
  double place;  ///< Error of any point or length that collide answers with, m.
  double flat;   ///< Amount by which the axis may be worse than the best one, m.
};

template <Scalar S>
Bounds<S> boundsOf(const Cores<S>& cores, const PlacedShape<S>& a, const PlacedShape<S>& b) {
  const double size = cores.size + static_cast<double>(a.radius) + static_cast<double>(b.radius);
  // Rounded places turn short edges: in Fixed against the normals, which counts by the square; in double,
  // where the edges of the Minkowski difference are rounded too, in full.
  const double turned = std::min(1.0, (kIsFixed<S> ? 0x1p-30 : cores.reach * 0x1p-50) / cores.shortest);
  const double place = kIsFixed<S> ? 8 * 0x1p-32 + size * (0x1p-29 + turned * turned)
                                   : size * (0x1p-46 + turned) + cores.reach * 0x1p-50;
  const bool faces = a.type != ShapeType::circle && b.type != ShapeType::circle &&
                     (a.type == ShapeType::poly || b.type == ShapeType::poly) && a.count * b.count <= 64;
  return {place, faces ? kFlat : 0};
}

template <Scalar S>
double least(const CollisionInfo<S>& info) {
  double result = 1e300;
  for (int i = 0; i < info.count; ++i) {
    const Vector<S> d = info.points[i].pointB - info.points[i].pointA;
    result = std::min(result, static_cast<double>(d.x) * static_cast<double>(info.normal.x) +
                                  static_cast<double>(d.y) * static_cast<double>(info.normal.y));
  }
  return result;
}

bool hasNeighbors() { return current.shapeA.hasNeighbors || current.shapeB.hasNeighbors; }

/// Remarks of the last call of touch.
CollisionStats stats;

template <Scalar S>
CollisionInfo<S> touch(const PlacedShape<S>& a, const PlacedShape<S>& b, CollisionId start = 0) {
  stats = {};
  return collide(a, b, start, &stats, as<S>(current.margin));
}

/// Width across the normal of the edges that the points are found on: near 0 for a needle that points at the
/// other shape.
template <Scalar S>
double width(const Cores<S>& cores, const CollisionInfo<S>& info) {
  if (info.count == 0) return 1;
  if (leastWidth(cores) < 64 * 0x1p-32) return 0;
  return std::min(widthTowards(cores.a, cores.countA, info.normal),
                  widthTowards(cores.b, cores.countB, -info.normal));
}
constexpr double kNeedle = 0x1p-10;
/// Ends of edges that lie opposite each other to this, in metres across the normal, count as meeting.
constexpr double kMeet = 16 * 0x1p-32;

/// Checks what holds for every answer, whatever the features are.
template <Scalar S>
void checkAnswer(const Cores<S>& cores, const BruteAnswer& brute, const PlacedShape<S>& a,
                 const PlacedShape<S>& b, const CollisionInfo<S>& info) {
  const Bounds<S> bounds = boundsOf(cores, a, b);
  const double radii = static_cast<double>(a.radius) + static_cast<double>(b.radius);
  const double reach = radii + static_cast<double>(as<S>(current.margin));
  remember(info);
  expect(info.count >= 0 && info.count <= kMaxContactsPerPair, "at most two points");
  if (info.count == 0) {
    if (!hasNeighbors()) {
      expectAtMost(reach - bounds.place - bounds.flat, brute.distance, "shapes in reach touch");
    }
    return;
  }
  expectAtMost(brute.distance, reach + bounds.place + bounds.flat, "shapes out of reach do not touch");

  const double nx = static_cast<double>(info.normal.x), ny = static_cast<double>(info.normal.y);
  expectNear(nx * nx + ny * ny, 1, kIsFixed<S> ? 0x1p-29 : 0x1p-49, "the normal is a unit vector");
  const double along = separationAlong(cores, info.normal);
  // A search that reached its limit of iterations answers with the best edge so far.
  const double gaveUp = stats.highEpaIterations > 0 ? cores.size * 0x1p-5 : 0;
  expectAtMost(brute.distance - along, bounds.place + bounds.flat + gaveUp,
               "no direction separates much better than the normal");
  expectAtMost(along - brute.distance, bounds.place, "the normal separates no more than is possible");
  const double depth = least(info);
  expectAtMost(along - radii, depth + bounds.place, "no point is deeper than the shapes overlap");
  // The face that the deepest vertex is not above may win, of two that are nearly parallel.
  const bool parallel =
      brute.bestFace > -1e300 && brute.lead <= 2 * bounds.place + 2 * bounds.flat + cores.size * 0x1p-20;
  // The tip of a needle that points at the other shape is not always one of the points either.
  const double across = width(cores, info);
  if (!parallel && across > kNeedle && gaveUp == 0) {
    expectNear(depth, along - radii, bounds.place / across + 2 * bounds.flat,
               "the deepest point is as deep as the shapes overlap");
  }

  // A rounded edge is not quite across its normal, which shows at a distance.
  const double rounding = kIsFixed<S> ? 4 * 0x1p-32 : cores.reach * 0x1p-51;
  const double onCore = bounds.place + (cores.size + radii) * std::min(1.0, rounding / cores.shortest);
  for (int i = 0; i < info.count; ++i) {
    const CollisionPoint<S>& p = info.points[i];
    const Vector<S> coreA = p.pointA - cores.origin - info.normal * a.radius;
    const Vector<S> coreB = p.pointB - cores.origin + info.normal * b.radius;
    expectAtMost(distanceToCore(cores.a, cores.countA, coreA), onCore, "a point of A is on A");
    expectAtMost(distanceToCore(cores.b, cores.countB, coreB), onCore, "a point of B is on B");
    expectAtMost(std::fabs(static_cast<double>(cross(p.pointB - p.pointA, info.normal))),
                 2 * onCore + bounds.flat, "the places of a point lie opposite each other");
  }
  if (info.count == 2) expect(info.points[0].hash != info.points[1].hash, "two points have two names");
}

template <Scalar S>
bool sameTouch(const CollisionInfo<S>& a, const CollisionInfo<S>& b, bool features = true) {
  if (a.count != b.count) return false;
  if (a.count > 0 && a.normal != b.normal) return false;
  for (int i = 0; i < a.count; ++i) {
    if (a.points[i].pointA != b.points[i].pointA || a.points[i].pointB != b.points[i].pointB ||
        (features && a.points[i].hash != b.points[i].hash)) {
      return false;
    }
  }
  return true;
}

/// True if two vertices lie hardly farther apart than the places that faces are searched by: which of them is
/// the nearest, is then a matter of rounding.
bool isDust(const Cores<Fixed>& cores) { return cores.doubled || cores.shortest < 0x1p-16; }
/// True if more than two vertices of a core are farthest along a direction, but for what is cut off from the
/// places that faces are searched by: which two of them make the edge towards the other shape, is then a
/// matter of rounding.
bool isFlatTowards(const Vector<Fixed>* points, int count, const Vector<Fixed>& direction) {
  constexpr double kCut = 0x1p-21;
  double most = -1e300;
  const auto along = [&](int i) { return static_cast<double>(dot(points[i] - points[0], direction)); };
  for (int i = 0; i < count; ++i) most = std::max(most, along(i));
  int farthest = 0;
  for (int i = 0; i < count; ++i) farthest += along(i) >= most - kCut ? 1 : 0;
  return farthest > 2;
}
/// True if a shape is a segment that points along the normal, nearly: rounding then decides which side is
/// towards the other shape.
bool hasNoSide(const PlacedShape<Fixed>& shape, const Vector<Fixed>& normal) {
  if (shape.type != ShapeType::segment) return false;
  const Vector<Fixed> edge = shape.planes[1].v0 - shape.planes[0].v0;
  return std::fabs(static_cast<double>(cross(edge, normal))) <
         std::max(16 * 0x1p-32, 0x1p-20 * static_cast<double>(length(edge)));
}

/// True if the ends of two facing edges that make a point lie opposite each other to some units: rounding
/// then decides which of them the point is at.
bool endsMeet(const PlacedShape<Fixed>& a, const PlacedShape<Fixed>& b, const CollisionInfo<Fixed>& info) {
  if (a.type == ShapeType::circle || b.type == ShapeType::circle) return false;
  for (int i = 0; i < info.count; ++i) {
    const std::uint32_t hash = info.points[i].hash;
    const Vector<Fixed> apart = b.planes[hash & 0xffff].v0 - a.planes[hash >> 16].v0;
    if (std::fabs(static_cast<double>(cross(apart, info.normal))) <= kMeet) return true;
  }
  return false;
}
bool nearTouch(const CollisionInfo<Fixed>& a, const CollisionInfo<Fixed>& b, double tolerance) {
  if (a.count != b.count || (a.count > 0 && a.normal != b.normal)) return false;
  const auto near = [&](const Vector<Fixed>& p, const Vector<Fixed>& q) {
    return std::fabs(static_cast<double>(p.x - q.x)) <= tolerance &&
           std::fabs(static_cast<double>(p.y - q.y)) <= tolerance;
  };
  for (int i = 0; i < a.count; ++i) {
    if (!near(a.points[i].pointA, b.points[i].pointA) || !near(a.points[i].pointB, b.points[i].pointB)) {
      return false;
    }
  }
  return true;
}

/// Leaves out the points that lie so near the end of the reach that rounding may leave them out; one at least
/// stays.
CollisionInfo<Fixed> withoutMarginal(CollisionInfo<Fixed> info, double bound) {
  for (int i = info.count - 1; i >= 0 && info.count > 1; --i) {
    const double apart = static_cast<double>(dot(info.points[i].pointB - info.points[i].pointA, info.normal));
    if (std::fabs(apart - static_cast<double>(current.margin)) > bound) continue;
    if (i == 0) info.points[0] = info.points[1];
    --info.count;
  }
  return info;
}

/// Exchanges the shapes; where an edge lies across the normal, which side of it counts depends on the order:
/// the names may differ. Two points come in the other order, but for shapes of two types, which are always
/// searched in one order.
template <Scalar S>
CollisionInfo<S> exchanged(const CollisionInfo<S>& info, bool sameType) {
  CollisionInfo<S> result = info;
  result.normal = -info.normal;
  for (int i = 0; i < info.count; ++i) {
    const CollisionPoint<S>& p = info.points[sameType ? info.count - 1 - i : i];
    result.points[i] = {p.pointB, p.pointA, p.hash << 16 | p.hash >> 16};
  }
  return result;
}

template <Scalar S>
CollisionInfo<S> mapped(const CollisionInfo<S>& info, const Transform<S>& by) {
  CollisionInfo<S> result = info;
  result.normal = transformVect(by, info.normal);
  for (int i = 0; i < info.count; ++i) {
    result.points[i].pointA = transformPoint(by, info.points[i].pointA);
    result.points[i].pointB = transformPoint(by, info.points[i].pointB);
  }
  return result;
}

/// The shapes of one scalar, with room for a second pose each.
template <Scalar S>
struct Scene {
  Placed<S> a, b, otherA, otherB;
  std::optional<Shape<S>> shapeA, shapeB;

  bool make() {
    shapeA = build<S>(current.shapeA);
    if (!shapeA) return false;
    shapeB = current.same ? shapeA : build<S>(current.shapeB);
    if (!shapeB) return false;
    for (Placed<S>* placed : {&a, &otherA}) placed->prepare(*shapeA);
    for (Placed<S>* placed : {&b, &otherB}) placed->prepare(*shapeB);
    return true;
  }
};

/// Asks the question without anything prepared.
void checkPlain(Scene<Fixed>& scene, const Transform<Fixed>& poseA, const Transform<Fixed>& poseB,
                const CollisionInfo<Fixed>& info) {
  expect(boundingBox(*scene.shapeA, poseA) == (*scene.a).box, "the box of a shape is that of the placed one");
  if (current.margin != Fixed(0)) return;
  const ContactPointSet<Fixed> set = shapesCollide(*scene.shapeA, poseA, *scene.shapeB, poseB);
  expect(set.count == info.count, "shapesCollide finds what collide finds");
  for (int i = 0; i < set.count; ++i) {
    expect(set.points[i].pointA == info.points[i].pointA && set.points[i].pointB == info.points[i].pointB,
           "shapesCollide finds the same points");
  }
}

void checkDouble(double fixedDistance) {
  static Scene<double> scene;
  if (!scene.make()) return;
  const PlacedShape<double>&a = scene.a.at(transformOf<double>(current.poseA)),
        &b = scene.b.at(transformOf<double>(current.poseB));
  Cores<double> cores(a, b);
  cores.reach =
      std::max({cores.reach, reachOf(current.shapeA, current.poseA), reachOf(current.shapeB, current.poseB)});
  const CollisionInfo<double> info = touch(a, b);
  // Only exact products decide right in a difference that is as thin as rounding.
  if (thickness(cores) < cores.reach * kThin || cores.shortest < cores.reach * kDust) return;
  const double limit = a.radius + b.radius + as<double>(current.margin) + 1;
  const BruteAnswer brute = bruteDistance(cores, limit);
  checkAnswer(cores, brute, a, b, info);
  checkAnswer(cores, brute, a, b, touch(a, b, current.start));
  if (info.count > 0) {
    // The places differ by the rounding of the pose.
    const double arms = armOf(current.shapeA) + armOf(current.shapeB);
    expectNear(brute.distance, fixedDistance, (arms + 4) * 0x1p-30, "Fixed agrees with double");
  }
  if (chosen(Choice::rational) && brute.distance <= limit) {
    const Bounds<double> bounds = boundsOf(cores, a, b);
    expect(nearExactDistance(cores, brute.distance, bounds.place), "the exact distance in rational numbers");
  }
}

void checkChecked(const CollisionInfo<Fixed>& expected) {
  static Scene<CheckedFixed> scene;
  expect(scene.make(), "CheckedFixed takes what Fixed takes");
  const CollisionInfo<CheckedFixed> info = touch(scene.a.at(transformOf<CheckedFixed>(current.poseA)),
                                                 scene.b.at(transformOf<CheckedFixed>(current.poseB)));
  expect(info.count == expected.count && info.id == expected.id, "CheckedFixed finds the same");
  for (int i = 0; i < info.count; ++i) {
    expect(info.points[i].pointA.x.raw() == expected.points[i].pointA.x.raw() &&
               info.points[i].pointA.y.raw() == expected.points[i].pointA.y.raw() &&
               info.points[i].pointB.x.raw() == expected.points[i].pointB.x.raw() &&
               info.points[i].pointB.y.raw() == expected.points[i].pointB.y.raw(),
           "CheckedFixed finds the same points");
  }
}

/// Moves B by one of its vertices exactly to one of A's, or to the middle of two, give or take some units.
void snap(Scene<Fixed>& scene, std::uint64_t how) {
  const PlacedShape<Fixed>&a = scene.a.at(transformOf<Fixed>(current.poseA)),
        &b = scene.b.at(transformOf<Fixed>(current.poseB));
  const auto vertex = [](const PlacedShape<Fixed>& shape, int i) { return shape.planes[i % shape.count].v0; };
  const int i = byteOf(how, 0), j = byteOf(how, 1);
  Vector<Fixed> goal = vertex(a, i);
  if ((byteOf(how, 2) & 1) != 0) goal = lerp(goal, vertex(a, i + 1), Fixed::ratio(byteOf(how, 3), 256));
  const Vector<Fixed> units(Fixed::fromRaw(static_cast<std::int8_t>(byteOf(how, 4))),
                            Fixed::fromRaw(static_cast<std::int8_t>(byteOf(how, 5))));
  const Vector<Fixed> moved = current.poseB.position + (goal - vertex(b, j)) + units;
  if (within(moved, Fixed(kMaxNumber))) current.poseB.position = moved;
}

/// Checks what exchanging two shapes of which one feature wins makes of their answer.
void checkExchanged(const PlacedShape<Fixed>& a, const PlacedShape<Fixed>& b,
                    const CollisionInfo<Fixed>& found, const CollisionInfo<Fixed>& turned,
                    const Cores<Fixed>& cores, const BruteAnswer& brute, const Bounds<Fixed>& bounds) {
  const CollisionInfo<Fixed> info = withoutMarginal(found, bounds.place);
  const CollisionInfo<Fixed> back = withoutMarginal(exchanged(turned, a.type == b.type), bounds.place);
  const CollisionInfo<Fixed> other = withoutMarginal(exchanged(turned, a.type != b.type), bounds.place);
  // A face's own normal and that of the nearest features, which count apart and beside dust, differ by their
  // rounding.
  const double turnedBy = brute.distance < 0 && !isDust(cores) ? 0 : 0x1p-29;
  // The way from one end to the other is longer along an edge that is not quite across the normal.
  const double between = (bounds.place + kMeet) / width(cores, found);
  expect(back.count == info.count || isDust(cores), "exchanging the shapes keeps the count");
  expectAtMost(std::fabs(static_cast<double>(back.normal.x - info.normal.x)) +
                   std::fabs(static_cast<double>(back.normal.y - info.normal.y)),
               info.count == 0 ? 1e300 : turnedBy, "exchanging the shapes turns the normal round");
  expect(brute.distance >= 0 || isDust(cores) || hasNoSide(a, info.normal) || hasNoSide(b, info.normal) ||
             sameTouch(back, info, false) || sameTouch(other, info, false) ||
             (endsMeet(a, b, info) && (nearTouch(back, info, between) || nearTouch(other, info, between))),
         "exchanging the shapes exchanges the points");
}

void run(Input& input, std::uint64_t choice) {
  const std::uint64_t head = input.word();
  current = {};
  current.shapeA = readShape(input);
  resolve(current.shapeA);
  current.same = (head & 1) != 0;
  current.shapeB = current.same ? current.shapeA : readShape(input);
  resolve(current.shapeB);
  current.poseA = readPose(input, nullptr);
  current.poseB = readPose(input, &current.poseA);
  constexpr Fixed kMargins[] = {Fixed(0), Fixed(0), Fixed::ratio(1, 50), Fixed(1)};
  current.margin = kMargins[byteOf(head, 1) & 3];
  current.start = static_cast<CollisionId>(head >> 32);
  current.choice = choice;

  static Scene<Fixed> scene;
  if (!scene.make()) return;
  if ((head & 2) != 0) snap(scene, input.word());
  const Transform<Fixed> poseA = transformOf<Fixed>(current.poseA), poseB = transformOf<Fixed>(current.poseB);
  const PlacedShape<Fixed>&a = scene.a.at(poseA), &b = scene.b.at(poseB);
  const Cores<Fixed> cores(a, b);
  const double limit = static_cast<double>(a.radius + b.radius + current.margin) + 1;
  const BruteAnswer brute = bruteDistance(cores, limit);
  const Bounds<Fixed> bounds = boundsOf(cores, a, b);

  const CollisionInfo<Fixed> info = touch(a, b);
  const bool gaveUp = stats.highEpaIterations > 0;
  checkAnswer(cores, brute, a, b, info);
  if (chosen(Choice::checked)) checkChecked(info);
  if (chosen(Choice::real)) checkDouble(brute.distance);

  if (chosen(Choice::plain)) checkPlain(scene, poseA, poseB, info);

  // Everything else is exact where one feature wins by more than what rounding may decide.
  const double reach = static_cast<double>(a.radius + b.radius + current.margin);
  const bool decided = !hasNeighbors() && !gaveUp && width(cores, info) > kNeedle &&
                       std::fabs(brute.distance - reach) > bounds.place + 2 * bounds.flat &&
                       std::fabs(brute.distance) > bounds.place + 2 * bounds.flat &&
                       std::fabs(brute.bestFace) > bounds.place + 2 * bounds.flat &&
                       (brute.corners ? brute.distance - brute.bestFace : brute.lead) >
                           2 * bounds.place + 2 * bounds.flat + cores.size * 0x1p-20;
  const CollisionInfo<Fixed> turned = touch(b, a);
  const CollisionInfo<Fixed> back = exchanged(turned, a.type == b.type);
  checkAnswer(cores, brute, a, b, back);
  if (decided) checkExchanged(a, b, info, turned, cores, brute, bounds);

  for (const CollisionId start : {current.start, info.id}) {
    if (!chosen(Choice::start)) break;
    const CollisionInfo<Fixed> again = touch(a, b, start);
    checkAnswer(cores, brute, a, b, again);
    if (decided) expect(sameTouch(again, info), "a start id does not change the answer");
  }

  // Moved by the same vector, both within the world.
  const Vector<Fixed> way(Fixed::fromRaw(static_cast<std::int64_t>(head * 0x9e3779b97f4a7c15u) >> 14),
                          Fixed::fromRaw(static_cast<std::int64_t>(head * 0xbf58476d1ce4e5b9u) >> 14));
  const Transform<Fixed> shift = Transform<Fixed>::translation(way);
  if (chosen(Choice::shift) && within(current.poseA.position + way, Fixed(kMaxNumber)) &&
      within(current.poseB.position + way, Fixed(kMaxNumber))) {
    const CollisionInfo<Fixed> moved = touch(scene.otherA.at(shift * poseA), scene.otherB.at(shift * poseB));
    expect(moved.id == info.id && sameTouch(moved, mapped(info, shift)), "moving both moves the answer");
  }

  // Turned by a quarter about the origin: exact but for the axes of last resort.
  const Transform<Fixed> quarter(Fixed(0), Fixed(1), Fixed(-1), Fixed(0), Fixed(0), Fixed(0));
  if (chosen(Choice::turn) && decided) {
    const PlacedShape<Fixed>&turnedA = scene.otherA.at(quarter * poseA),
          &turnedB = scene.otherB.at(quarter * poseB);
    const CollisionInfo<Fixed> rotated = touch(turnedA, turnedB);
    if (isDust(cores) || isFlatTowards(cores.a, cores.countA, info.normal) ||
        isFlatTowards(cores.b, cores.countB, -info.normal)) {
      const Cores<Fixed> turnedCores(turnedA, turnedB);
      checkAnswer(turnedCores, bruteDistance(turnedCores, limit), turnedA, turnedB, rotated);
    } else {
      expect(sameTouch(rotated, mapped(info, quarter)), "turning both turns the answer");
    }
  }

  if (info.count == 0) return;
  if (chosen(Choice::out) && decided) {
    // The point goes out along the normal by the depth.
    const double depth = least(info);
    const Vector<Fixed> out = info.normal * Fixed(-depth);
    Transform<Fixed> poseOut = poseB;
    poseOut.tx += out.x;
    poseOut.ty += out.y;
    const PlacedShape<Fixed>& b2 = scene.otherB.at(poseOut);
    const CollisionInfo<Fixed> after = touch(a, b2);
    if (after.count > 0) {
      expectAtMost(-least(after), 2 * bounds.place / width(cores, info) + bounds.flat,
                   "moving out by the depth separates");
    }
  }
  if (chosen(Choice::aside) && decided) {
    // One unit aside, away from where another axis is as good: everything follows.
    Transform<Fixed> poseAside = poseB;
    poseAside.tx += Fixed::epsilon();
    const CollisionInfo<Fixed> after = touch(a, scene.otherB.at(poseAside));
    expect(after.count > 0, "a unit aside the shapes still touch");
    expectNear(least(after), least(info), bounds.place / width(cores, info),
               "a unit aside the depth is nearly the same");
    if (brute.distance < 0) expect(after.normal == info.normal, "a unit aside the normal is the same");
  }
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  samestep::fuzz::describer() = samestep::fuzz::describe;
  samestep::fuzz::Input input(data, size);
  samestep::fuzz::guarded([&] { samestep::fuzz::run(input, samestep::fuzz::mixed(data, size)); });
  return 0;
}
