// SPDX-License-Identifier: MIT
#include "cases.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <samestep/circle_shape.h>
#include <samestep/error.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "distance.h"
#include "study/degenerate_shapes.h"

namespace samestep::fuzz {
namespace {

Vector<Fixed> readPoint(Input& input, Fixed limit) {
  const Fixed x = input.numberIn(-limit, limit);
  return {x, input.numberIn(-limit, limit)};
}

void setPoints(ShapePlan& plan, std::span<const RawPoint> points) {
  plan.count = 0;
  for (const RawPoint& p : points) plan.points[plan.count++] = {Fixed::fromRaw(p.x), Fixed::fromRaw(p.y)};
}

void readLibraryShape(ShapePlan& plan, std::uint8_t index) {
  const NastyShape& shape = nastyShapes()[index % nastyShapes().size()];
  plan.make = shape.type == ShapeType::circle    ? ShapePlan::Make::circle
              : shape.type == ShapeType::segment ? ShapePlan::Make::segment
                                                 : ShapePlan::Make::raw;
  setPoints(plan, shape.points);
  plan.radius = Fixed::fromRaw(shape.radius);
}

void makeBox(ShapePlan& plan, const Vector<Fixed>& low, const Vector<Fixed>& high) {
  plan.make = ShapePlan::Make::raw;
  plan.count = 4;
  plan.points[0] = {high.x, low.y};
  plan.points[1] = high;
  plan.points[2] = {low.x, high.y};
  plan.points[3] = low;
}

}  // namespace

ShapePlan readShape(Input& input) {
  const std::uint64_t head = input.word();
  const int variant = byteOf(head, 2);
  constexpr Fixed kLimits[] = {Fixed(4), Fixed(1 << 8), Fixed(1 << 14), Fixed::fromRaw(1 << 10)};
  const Fixed limit = kLimits[byteOf(head, 1) & 3];
  ShapePlan plan;
  switch (byteOf(head, 0) % 10) {
    case 0:
      plan.make = ShapePlan::Make::circle;
      plan.count = 1;
      plan.radius = input.numberIn(Fixed(0), limit);
      if ((variant & 1) != 0) plan.points[0] = readPoint(input, limit);
      return plan;
    case 1:
      plan.make = ShapePlan::Make::segment;
      plan.count = 2;
      plan.points[0] = readPoint(input, limit);
      plan.points[1] = readPoint(input, limit);
      plan.hasNeighbors = (variant & 4) != 0;
      if (plan.hasNeighbors) {
        plan.previous = readPoint(input, limit);
        plan.next = readPoint(input, limit);
      }
      break;
    case 2:
    case 3: {
      const Fixed width = input.numberIn(Fixed(0), limit), height = input.numberIn(Fixed(0), limit);
      const Vector<Fixed> half(width * Fixed(0.5), height * Fixed(0.5));
      const Vector<Fixed> middle = (variant & 4) != 0 ? readPoint(input, limit) : Vector<Fixed>();
      makeBox(plan, middle - half, middle + half);
      break;
    }
    case 4:
    case 5:
    case 6:
      plan.make = ShapePlan::Make::hull;
      plan.count = 3 + byteOf(head, 3) % (byteOf(head, 0) % 10 == 6 ? 30 : 6);
      for (int i = 0; i < plan.count; ++i) plan.points[i] = readPoint(input, limit);
      break;
    case 7: {
      plan.make = ShapePlan::Make::hull;
      plan.count = 3 + byteOf(head, 3) % 30;
      const Fixed size = input.numberIn(Fixed(0), limit), start = input.number();
      for (int i = 0; i < plan.count; ++i) {
        plan.points[i] = forAngle(start + kPi<Fixed> * Fixed::ratio(2 * i, plan.count)) * size;
      }
      break;
    }
    case 8:
      plan.make = ShapePlan::Make::raw;
      plan.count = 3 + byteOf(head, 3) % 5;
      for (int i = 0; i < plan.count; ++i) plan.points[i] = readPoint(input, limit);
      break;
    default:
      readLibraryShape(plan, byteOf(head, 3));
      return plan;
  }
  if ((variant & 3) == 3) plan.radius = input.numberIn(Fixed(0), limit);
  return plan;
}

PosePlan readPose(Input& input, const PosePlan* near) {
  const std::uint64_t head = input.word();
  PosePlan pose;
  const bool far = byteOf(head, 0) % 16 == 15;
  const Fixed limit = far ? Fixed(kMaxNumber) : near != nullptr ? Fixed(1 << 9) : Fixed(1 << 15);
  pose.position = readPoint(input, limit);
  pose.quarters = byteOf(head, 1) & 3;
  if ((byteOf(head, 2) & 1) != 0) pose.angle = input.number();
  if (near == nullptr || far) return pose;
  pose.position += near->position;
  if ((byteOf(head, 2) & 2) != 0) {
    pose.quarters += near->quarters;
    pose.angle += near->angle;
  }
  const Fixed most(kMaxNumber);
  pose.position = {clamp(pose.position.x, -most, most), clamp(pose.position.y, -most, most)};
  return pose;
}

template <Scalar S>
std::optional<Shape<S>> build(const ShapePlan& plan) {
  Vector<S> points[kMaxPolyVertices];
  for (int i = 0; i < plan.count; ++i) points[i] = as<S>(plan.points[i]);
  const std::span<const Vector<S>> all(points, static_cast<std::size_t>(plan.count));
  const S radius = as<S>(plan.radius);
  try {
    switch (plan.make) {
      case ShapePlan::Make::circle:
        return circleShape<S>(BodyId(), radius, points[0]);
      case ShapePlan::Make::segment: {
        Shape<S> shape = segmentShape<S>(BodyId(), points[0], points[1], radius);
        if (plan.hasNeighbors) SegmentShape<S>(shape).setNeighbors(as<S>(plan.previous), as<S>(plan.next));
        return shape;
      }
      case ShapePlan::Make::raw:
        return polyShapeRaw<S>(BodyId(), all, radius);
      case ShapePlan::Make::hull:
        return polyShape<S>(BodyId(), all, Transform<S>(), radius);
    }
  } catch (const Error&) {
  }
  return std::nullopt;
}

void resolve(ShapePlan& plan) {
  if (plan.make != ShapePlan::Make::hull) return;
  plan.make = ShapePlan::Make::raw;
  plan.count = makeConvex(plan.points, plan.count);
}

double armOf(const ShapePlan& plan) {
  double arm = 0;
  for (int i = 0; i < plan.count; ++i) {
    arm = std::max(arm, std::fabs(static_cast<double>(plan.points[i].x)) +
                            std::fabs(static_cast<double>(plan.points[i].y)));
  }
  return arm;
}

double reachOf(const ShapePlan& plan, const PosePlan& pose) {
  return armOf(plan) + std::max(std::fabs(static_cast<double>(pose.position.x)),
                                std::fabs(static_cast<double>(pose.position.y)));
}

template std::optional<Shape<double>> build<double>(const ShapePlan&);
template std::optional<Shape<Fixed>> build<Fixed>(const ShapePlan&);
template std::optional<Shape<CheckedFixed>> build<CheckedFixed>(const ShapePlan&);

void print(const char* name, const ShapePlan& shape, const PosePlan& pose) {
  static constexpr const char* kMakes[] = {"circle", "segment", "raw polygon", "hull"};
  const auto show = [](const Vector<Fixed>& v) {
    std::fprintf(stderr, " (%.17g, %.17g)", static_cast<double>(v.x), static_cast<double>(v.y));
  };
  std::fprintf(stderr, "%s: %s, radius %.17g, points", name, kMakes[static_cast<int>(shape.make)],
               static_cast<double>(shape.radius));
  for (int i = 0; i < shape.count; ++i) show(shape.points[i]);
  if (shape.hasNeighbors) {
    std::fprintf(stderr, ", neighbors");
    show(shape.previous);
    show(shape.next);
  }
  std::fprintf(stderr, "; at");
  show(pose.position);
  std::fprintf(stderr, ", %d quarters + %.17g rad\n", pose.quarters, static_cast<double>(pose.angle));
}

}  // namespace samestep::fuzz
