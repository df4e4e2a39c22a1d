// SPDX-License-Identifier: MIT
#include "peer_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace samestep::bench {
namespace {

constexpr double kTurned = 0.2;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Point {
  double x = 0, y = 0;
};
Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
Point operator*(Point a, double s) { return {a.x * s, a.y * s}; }
double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
double length(Point a) { return std::sqrt(dot(a, a)); }

struct Box {
  Point low{kInfinity, kInfinity}, high{-kInfinity, -kInfinity};
  void take(Point p, double radius = 0) {
    low = {std::min(low.x, p.x - radius), std::min(low.y, p.y - radius)};
    high = {std::max(high.x, p.x + radius), std::max(high.y, p.y + radius)};
  }
};

/// A shape of a scene in world coordinates: a circle has one point, its centre.
struct Placed {
  int body = 0;
  bool dynamic = false;
  double radius = 0;
  std::vector<Point> points;
  Box box;
  bool isCircle() const { return points.size() == 1; }
};

/// Unit normal of the edge from point i, outward.
Point normalOf(const std::vector<Point>& points, std::size_t i) {
  const Point edge = points[(i + 1) % points.size()] - points[i];
  return Point{edge.y, -edge.x} * (1 / length(edge));
}

/// Distance of a point from a polygon, negative inside.
double distance(const std::vector<Point>& polygon, Point p) {
  double inside = -kInfinity;
  double nearest = kInfinity;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double along = std::clamp(dot(p - polygon[i], edge) / dot(edge, edge), 0.0, 1.0);
    inside = std::max(inside, dot(normalOf(polygon, i), p - polygon[i]));
    nearest = std::min(nearest, length(p - (polygon[i] + edge * along)));
  }
  return inside <= 0 ? inside : nearest;
}

/// Greatest separation of `b` along a face normal of `a`.
double faceSeparation(const std::vector<Point>& a, const std::vector<Point>& b) {
  double greatest = -kInfinity;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Point normal = normalOf(a, i);
    double least = kInfinity;
    for (const Point& p : b) least = std::min(least, dot(normal, p - a[i]));
    greatest = std::max(greatest, least);
  }
  return greatest;
}

/// Separation by separating axes; exact where shapes overlap, and then negative.
double separation(const Placed& a, const Placed& b) {
  if (a.isCircle() && b.isCircle()) return length(a.points[0] - b.points[0]) - a.radius - b.radius;
  if (a.isCircle()) return distance(b.points, a.points[0]) - a.radius;
  if (b.isCircle()) return distance(a.points, b.points[0]) - b.radius;
  return std::max(faceSeparation(a.points, b.points), faceSeparation(b.points, a.points));
}

std::vector<Point> localPoints(const SceneShape& shape) {
  if (shape.isCircle()) return {Point{}};
  std::vector<Point> points;
  for (std::size_t i = 0; i < shape.vertices.size(); i += 2) {
    points.push_back({number(shape.vertices[i]), number(shape.vertices[i + 1])});
  }
  return points;
}

Point toWorld(const Motion& motion, Point p) {
  const double c = std::cos(motion.angle), s = std::sin(motion.angle);
  return {motion.x + c * p.x - s * p.y, motion.y + s * p.x + c * p.y};
}

Point toLocal(const Motion& motion, Point p) {
  const double c = std::cos(motion.angle), s = std::sin(motion.angle);
  const Point from = p - Point{motion.x, motion.y};
  return {c * from.x + s * from.y, c * from.y - s * from.x};
}

std::vector<Placed> place(const PeerScene& scene, const std::vector<Motion>& motions) {
  std::vector<Placed> all;
  for (const SceneShape& shape : scene.shapes) {
    Placed placed{shape.body, shape.isDynamic(), number(shape.radius), {}, {}};
    for (const Point& p : localPoints(shape)) {
      placed.points.push_back(toWorld(motions[static_cast<std::size_t>(shape.body)], p));
      placed.box.take(placed.points.back(), placed.radius);
    }
    all.push_back(std::move(placed));
  }
  return all;
}

double maxPenetration(std::vector<Placed> shapes) {
  std::sort(shapes.begin(), shapes.end(),
            [](const Placed& a, const Placed& b) { return a.box.low.x < b.box.low.x; });
  double deepest = 0;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Placed& a = shapes[i];
    for (std::size_t j = i + 1; j < shapes.size() && shapes[j].box.low.x < a.box.high.x; ++j) {
      const Placed& b = shapes[j];
      const bool apart = a.box.high.y <= b.box.low.y || b.box.high.y <= a.box.low.y;
      if (apart || a.body == b.body || (!a.dynamic && !b.dynamic)) continue;
      deepest = std::max(deepest, -separation(a, b));
    }
  }
  return deepest;
}

/// Mass of a shape of density 1, about its centre.
struct Mass {
  double mass = 0, moment = 0;
  Point center;
};

Mass massOf(const SceneShape& shape) {
  if (shape.isCircle()) {
    const double square = number(shape.radius) * number(shape.radius);
    return {std::numbers::pi * square, std::numbers::pi * square * square / 2, {}};
  }
  Mass total;
  const std::vector<Point> points = localPoints(shape);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point a = points[i], b = points[(i + 1) % points.size()];
    const double twice = cross(a, b);
    total.mass += twice / 2;
    total.center = total.center + (a + b) * (twice / 6);
    total.moment += twice * (dot(a, a) + dot(a, b) + dot(b, b)) / 12;
  }
  total.center = total.center * (1 / total.mass);
  total.moment -= total.mass * dot(total.center, total.center);
  return total;
}

/// Walls that bodies may not pass: the shapes of bodies that are not dynamic.
class Walls {
 public:
  Walls(const PeerScene& scene, const std::vector<Motion>& motions, const std::vector<Placed>& placed) {
    for (std::size_t i = 0; i < placed.size(); ++i) {
      if (placed[i].dynamic) continue;
      // A container that turns is looked at in its own frame, and is closed at the top.
      if (walls_.empty()) frame_ = motions[static_cast<std::size_t>(placed[i].body)];
      closed_ = closed_ || scene.shapes[i].type == "kinematic";
      walls_.push_back(placed[i]);
      for (const Point& p : placed[i].points) bounds_.take(toLocal(frame_, p));
    }
  }
  bool passedBy(Point center) const {
    if (walls_.empty()) return false;
    const Point p = toLocal(frame_, center);
    if (p.x < bounds_.low.x || p.x > bounds_.high.x || p.y < bounds_.low.y) return true;
    if (closed_ && p.y > bounds_.high.y) return true;
    return std::any_of(walls_.begin(), walls_.end(),
                       [&](const Placed& wall) { return distance(wall.points, center) < 0; });
  }

 private:
  std::vector<Placed> walls_;
  Motion frame_{};
  Box bounds_;
  bool closed_ = false;
};

}  // namespace

Quality qualityOf(const PeerScene& scene, const std::vector<Motion>& motions) {
  const std::vector<Placed> placed = place(scene, motions);
  const Walls walls(scene, motions, placed);
  Quality quality;
  double mass = 0;
  int last = -1;
  for (const SceneShape& shape : scene.shapes) {
    if (!shape.isDynamic() || shape.body == last) continue;
    last = shape.body;
    const Motion& motion = motions[static_cast<std::size_t>(shape.body)];
    const Mass own = massOf(shape);
    const Point center = toWorld(motion, own.center);
    mass += own.mass;
    quality.pileY += own.mass * center.y;
    quality.kineticEnergy +=
        (own.mass * (motion.vx * motion.vx + motion.vy * motion.vy) + own.moment * motion.w * motion.w) / 2;
    quality.apexDrop = number(shape.y) - motion.y;
    quality.throughWalls += walls.passedBy(center) ? 1 : 0;
    quality.turned += std::abs(motion.angle - number(shape.angle)) > kTurned ? 1 : 0;
  }
  if (mass > 0) quality.pileY /= mass;
  quality.maxPenetration = maxPenetration(placed);
  return quality;
}

}  // namespace samestep::bench
