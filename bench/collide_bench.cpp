// SPDX-License-Identifier: MIT
// Time per pair of the narrow phase, beside Chipmunk's on the same pairs. Each run goes through 256 pairs in
// turn, so that branches are guessed as badly as in a scene.
#include <benchmark/benchmark.h>
#include <chipmunk/chipmunk.h>
#include <chipmunk/chipmunk_structs.h>

#include <memory>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/collision.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "support/random.h"

namespace samestep {
namespace {

constexpr int kPairs = 256;

enum class Kind { circles, circleOnSegment, circleOnBox, boxOnSegment, restingBoxes, deepBoxes, hexagons };

/// How two shapes stand: the second at `place`, turned by `angle`, on the first at the origin.
struct Stand {
  Vector<double> place;
  double angle = 0;
};

Stand standOf(Kind kind, Random& random) {
  const double x = random.number<double>(-1, 1), little = random.number<double>(0, 1) / 64;
  switch (kind) {
    case Kind::circles:
      return {{x, 1 - little}, 0};
    case Kind::circleOnSegment:
      return {{8 * x, 0.5 - little}, 0};
    case Kind::circleOnBox:
      return {{x / 2, 1 - little}, 0};
    case Kind::boxOnSegment:
      return {{8 * x, 0.5 - little}, little / 8};
    case Kind::restingBoxes:
      return {{x / 2, 1 - little}, little / 8};
    case Kind::deepBoxes:
    case Kind::hexagons:
      return {{x / 2, random.number<double>(0, 1)}, random.number<double>(-3, 3)};
  }
  return {};
}

std::vector<Vector<double>> hexagon() {
  return {{0.5, 0}, {0.25, 0.4375}, {-0.25, 0.4375}, {-0.5, 0}, {-0.25, -0.4375}, {0.25, -0.4375}};
}

template <Scalar S>
Shape<S> shapeOf(Kind kind, bool first) {
  const S half = ratio<S>(1, 2);
  switch (kind) {
    case Kind::circles:
      return circleShape<S>(BodyId(), half);
    case Kind::circleOnSegment:
    case Kind::boxOnSegment:
      if (first) return segmentShape<S>(BodyId(), {S(-20), S(0)}, {S(20), S(0)});
      return kind == Kind::boxOnSegment ? boxShape<S>(BodyId(), S(1), S(1)) : circleShape<S>(BodyId(), half);
    case Kind::circleOnBox:
      return first ? boxShape<S>(BodyId(), S(1), S(1)) : circleShape<S>(BodyId(), half);
    case Kind::restingBoxes:
    case Kind::deepBoxes:
      return boxShape<S>(BodyId(), S(1), S(1));
    case Kind::hexagons: {
      std::vector<Vector<S>> points;
      for (const Vector<double>& v : hexagon()) points.push_back({S(v.x), S(v.y)});
      return polyShape<S>(BodyId(), points);
    }
  }
  return {};
}

template <Scalar S>
void collideOurs(benchmark::State& state) {
  const Kind kind = static_cast<Kind>(state.range(0));
  const bool warm = state.range(1) != 0;
  Random random(7);
  std::vector<std::unique_ptr<Placement<S>>> placed;
  std::vector<CollisionId> ids(kPairs, 0);
  for (int i = 0; i < kPairs; ++i) {
    const Stand stand = standOf(kind, random);
    placed.push_back(std::make_unique<Placement<S>>(shapeOf<S>(kind, true), Transform<S>()));
    placed.push_back(std::make_unique<Placement<S>>(
        shapeOf<S>(kind, false), Transform<S>::rigid({S(stand.place.x), S(stand.place.y)}, S(stand.angle))));
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const CollisionInfo<S> info = collide(**placed[2 * i], **placed[2 * i + 1], warm ? ids[i] : 0);
    ids[i] = info.id;
    benchmark::DoNotOptimize(&info);
    i = (i + 1) % kPairs;
  }
}

cpShape* chipmunkShape(Kind kind, bool first, cpBody* body) {
  const Shape<double> shape = shapeOf<double>(kind, first);
  std::vector<cpVect> points;
  for (const Vector<double>& v : shape.vertices()) points.push_back(cpv(v.x, v.y));
  switch (shape.type()) {
    case ShapeType::circle:
      return cpCircleShapeNew(body, shape.radius(), points[0]);
    case ShapeType::segment:
      return cpSegmentShapeNew(body, points[0], points[1], shape.radius());
    case ShapeType::poly:
      return cpPolyShapeNewRaw(body, static_cast<int>(points.size()), points.data(), shape.radius());
  }
  return nullptr;
}

void collideChipmunk(benchmark::State& state) {
  const Kind kind = static_cast<Kind>(state.range(0));
  Random random(7);
  std::vector<cpShape*> shapes;
  for (int i = 0; i < kPairs; ++i) {
    const Stand stand = standOf(kind, random);
    for (const bool first : {true, false}) {
      cpBody* body = cpBodyNew(1, 1);
      if (!first) {
        cpBodySetPosition(body, cpv(stand.place.x, stand.place.y));
        cpBodySetAngle(body, stand.angle);
      }
      shapes.push_back(chipmunkShape(kind, first, body));
      cpShapeCacheBB(shapes.back());
    }
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const cpContactPointSet set = cpShapesCollide(shapes[2 * i], shapes[2 * i + 1]);
    benchmark::DoNotOptimize(&set);
    i = (i + 1) % kPairs;
  }
  for (cpShape* shape : shapes) {
    cpBody* body = cpShapeGetBody(shape);
    cpShapeFree(shape);
    cpBodyFree(body);
  }
}

void allKinds(benchmark::internal::Benchmark* bench, bool warm) {
  for (int kind = 0; kind <= static_cast<int>(Kind::hexagons); ++kind) {
    bench->Args({kind, 0});
    if (warm && kind >= static_cast<int>(Kind::boxOnSegment)) bench->Args({kind, 1});
  }
  bench->ArgNames({"kind", "warm"});
}
void oursKinds(benchmark::internal::Benchmark* bench) { allKinds(bench, true); }
void chipmunkKinds(benchmark::internal::Benchmark* bench) { allKinds(bench, false); }

BENCHMARK(collideChipmunk)->Apply(chipmunkKinds);
BENCHMARK(collideOurs<double>)->Apply(oursKinds);
BENCHMARK(collideOurs<Fixed>)->Apply(oursKinds);

template <Scalar S>
void placeBoxes(benchmark::State& state) {
  Plane<S> planes[4], local[4];
  PlacedShape<S> placed;
  placed.planes = planes;
  prepare(boxShape<S>(BodyId(), S(1), S(1)), local, placed);
  Transform<S> pose = Transform<S>::rigid({S(3), S(4)}, ratio<S>(1, 3));
  for (auto _ : state) {
    benchmark::DoNotOptimize(pose);
    benchmark::DoNotOptimize(place(pose, placed));
  }
}
BENCHMARK(placeBoxes<double>);
BENCHMARK(placeBoxes<Fixed>);

}  // namespace
}  // namespace samestep
