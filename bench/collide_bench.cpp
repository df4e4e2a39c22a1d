// SPDX-License-Identifier: MIT
// Time per pair of the narrow phase, beside Chipmunk's on the same pairs. Each run goes through 256 pairs in
// turn, so that branches are guessed as badly as in a scene. The last kind are the pairs of the degenerate
// library: what the worst that is known costs.
#include <benchmark/benchmark.h>
#include <chipmunk/chipmunk.h>
#include <chipmunk/chipmunk_structs.h>

#include <memory>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/collision.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "study/degenerate_shapes.h"
#include "support/random.h"

namespace samestep {
namespace {

constexpr int kPairs = 256;

enum class Kind {
  circles,
  circleOnSegment,
  circleOnBox,
  boxOnSegment,
  restingBoxes,
  deepBoxes,
  hexagons,
  degenerate
};

/// Stand of two shapes: the second at `place`, turned by `angle`, on the first at `firstPlace`.
struct Stand {
  Vector<double> place;
  double angle = 0;
  Vector<double> firstPlace{};
  double firstAngle = 0;
};

const NastyPair& nastyPair(int i) { return nastyPairs()[static_cast<std::size_t>(i) % nastyPairs().size()]; }

Stand standOf(Kind kind, int i, Random& random) {
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
    case Kind::degenerate: {
      const NastyPair& pair = nastyPair(i);
      return {fromUnits<double>(pair.positionB), fromUnits<double>(pair.angleB),
              fromUnits<double>(pair.positionA), fromUnits<double>(pair.angleA)};
    }
  }
  return {};
}

std::vector<Vector<double>> hexagon() {
  return {{0.5, 0}, {0.25, 0.4375}, {-0.25, 0.4375}, {-0.5, 0}, {-0.25, -0.4375}, {0.25, -0.4375}};
}

template <Scalar S>
Shape<S> shapeOf(Kind kind, int i, bool first) {
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
    case Kind::degenerate: {
      const NastyPair& pair = nastyPair(i);
      return makeNasty<S>(nastyShapes()[static_cast<std::size_t>(first ? pair.shapeA : pair.shapeB)]);
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
    const Stand stand = standOf(kind, i, random);
    const auto place = [&](bool first, const Vector<double>& at, double angle) {
      placed.push_back(std::make_unique<Placement<S>>(shapeOf<S>(kind, i, first),
                                                      Transform<S>::rigid({S(at.x), S(at.y)}, S(angle))));
    };
    place(true, stand.firstPlace, stand.firstAngle);
    place(false, stand.place, stand.angle);
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const CollisionInfo<S> info = collide(**placed[2 * i], **placed[2 * i + 1], warm ? ids[i] : 0);
    ids[i] = info.id;
    benchmark::DoNotOptimize(&info);
    i = (i + 1) % kPairs;
  }
}

cpShape* chipmunkShape(Kind kind, int i, bool first, cpBody* body) {
  const Shape<double> shape = shapeOf<double>(kind, i, first);
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
    const Stand stand = standOf(kind, i, random);
    for (const bool first : {true, false}) {
      cpBody* body = cpBodyNew(1, 1);
      const Vector<double>& at = first ? stand.firstPlace : stand.place;
      cpBodySetPosition(body, cpv(at.x, at.y));
      cpBodySetAngle(body, first ? stand.firstAngle : stand.angle);
      shapes.push_back(chipmunkShape(kind, i, first, body));
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
  for (int kind = 0; kind <= static_cast<int>(Kind::degenerate); ++kind) {
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
