// SPDX-License-Identifier: MIT
#pragma once

#include <chipmunk/chipmunk.h>
#include <chipmunk/chipmunk_structs.h>

#include <cmath>
#include <memory>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "support/random.h"

namespace samestep {

/// One geometry in numbers that every scalar holds exactly.
struct ShapeRecipe {
  ShapeType type = ShapeType::circle;
  double radius = 0;
  std::vector<Vector<double>> points;  // Circle: the centre. Segment: its ends. Polygon: its hull.
};

template <Scalar S>
Vector<S> convert(const Vector<double>& v) {
  return {S(v.x), S(v.y)};
}
template <Scalar S>
std::vector<Vector<S>> convert(const std::vector<Vector<double>>& points) {
  std::vector<Vector<S>> result;
  for (const Vector<double>& v : points) result.push_back(convert<S>(v));
  return result;
}
template <Scalar S>
Transform<S> convert(const Transform<double>& t) {
  return {S(t.a), S(t.b), S(t.c), S(t.d), S(t.tx), S(t.ty)};
}
inline Vector<double> toDouble(const Vector<double>& v) { return v; }
template <FixedNumber S>
Vector<double> toDouble(const Vector<S>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y)};
}

template <Scalar S>
Shape<S> build(const ShapeRecipe& recipe) {
  const std::vector<Vector<S>> points = convert<S>(recipe.points);
  const S radius(recipe.radius);
  switch (recipe.type) {
    case ShapeType::circle:
      return circleShape<S>(BodyId(), radius, points[0]);
    case ShapeType::segment:
      return segmentShape<S>(BodyId(), points[0], points[1], radius);
    case ShapeType::poly:
      return polyShapeRaw<S>(BodyId(), points, radius);
  }
  return {};
}

inline double far(const Vector<double>& a, const Vector<double>& b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
}

inline cpVect toChipmunk(const Vector<double>& v) { return cpv(v.x, v.y); }
inline Vector<double> fromChipmunk(cpVect v) { return {v.x, v.y}; }

/// A shape of Chipmunk on a body, to be freed by the caller.
inline cpShape* newChipmunkShape(cpBody* body, const ShapeRecipe& recipe) {
  std::vector<cpVect> points;
  for (const Vector<double>& v : recipe.points) points.push_back(toChipmunk(v));
  switch (recipe.type) {
    case ShapeType::circle:
      return cpCircleShapeNew(body, recipe.radius, points[0]);
    case ShapeType::segment:
      return cpSegmentShapeNew(body, points[0], points[1], recipe.radius);
    case ShapeType::poly:
      return cpPolyShapeNewRaw(body, static_cast<int>(points.size()), points.data(), recipe.radius);
  }
  return nullptr;
}

/// A shape of Chipmunk with a body of its own, posed by the very numbers of a Transform.
class ChipmunkShape {
 public:
  ChipmunkShape(const ShapeRecipe& recipe, const Transform<double>& pose)
      : body_(cpBodyNew(1, 1)), shape_(newChipmunkShape(body_, recipe)) {
    move(pose);
  }
  ChipmunkShape(const ChipmunkShape&) = delete;
  ChipmunkShape& operator=(const ChipmunkShape&) = delete;
  ~ChipmunkShape() {
    cpShapeFree(shape_);
    cpBodyFree(body_);
  }

  void move(const Transform<double>& pose) {
    body_->transform = {pose.a, pose.b, pose.c, pose.d, pose.tx, pose.ty};
    cpShapeUpdate(shape_, body_->transform);
  }
  cpShape* get() const { return shape_; }

 private:
  cpBody* body_;
  cpShape* shape_;
};

/// Random numbers with 20 fraction bits: exact in every scalar.
class RecipeSource {
 public:
  explicit RecipeSource(std::uint64_t seed) : random_(seed) {}

  double number(double low, double high) {
    const double unit = static_cast<double>(random_.next() >> 11) * 0x1p-53;
    return exact(low + (high - low) * unit);
  }
  Random& random() { return random_; }

  /// @param size  metres, about the diameter
  ShapeRecipe shape(ShapeType type, double size, bool rounded) {
    ShapeRecipe recipe{type, rounded ? number(size / 64, size / 8) : 0, {}};
    switch (type) {
      case ShapeType::circle:
        recipe.radius = number(size / 8, size / 2);
        recipe.points = {point(size / 4)};
        break;
      case ShapeType::segment:
        recipe.points = {point(size / 2), point(size / 2)};
        break;
      case ShapeType::poly:
        recipe.points = hull(size);
        break;
    }
    return recipe;
  }

  Vector<double> point(double reach) { return {number(-reach, reach), number(-reach, reach)}; }

  Transform<double> pose(double reach) {
    const SinCos<double> turn = sincos(number(-4, 4));
    const Vector<double> place = point(reach);
    return Transform<double>::rigid(place, Vector<double>(turn.cos, turn.sin));
  }

 private:
  static double exact(double x) {
    return static_cast<double>(static_cast<std::int64_t>(x * 0x1p20)) * 0x1p-20;
  }

  std::vector<Vector<double>> hull(double size) {
    for (;;) {
      std::vector<Vector<double>> points(3 + random_.below(8));
      for (Vector<double>& v : points) v = point(size / 2);
      const int count = convexHull<double>(std::span<const Vector<double>>(points), points);
      points.resize(static_cast<std::size_t>(count));
      if (count >= 3 && areaForPoly<double>(points, 0) > size * size / 64) return points;
    }
  }

  Random random_;
};

}  // namespace samestep
