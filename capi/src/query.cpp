// SPDX-License-Identifier: MIT
// Queries, answered into arrays of the world.
#include "base/require_ieee.h"
#include "definitions.h"

using namespace samestep::c;

extern "C" {

samestep_status samestep_query_point(samestep_world* world, double x, double y, double distance,
                                     const samestep_filter* filter, const samestep_point_hit** hits,
                                     size_t* count) {
  return call(world, [&]<class World>(World& of) {
    using S = typename World::Number;
    at(hits), at(count);
    of.space.pointQuery(vector<S>(x, y), number<S>(distance), toFilter(filter), of.pointsFound);
    of.pointHits.clear();
    for (const auto& hit : of.pointsFound) {
      of.pointHits.push_back(
          {toC(hit.shape), toVec2(hit.point), toDouble(hit.distance), toVec2(hit.gradient)});
    }
    give(of.pointHits, hits, count);
  });
}

samestep_status samestep_query_segment(samestep_world* world, double from_x, double from_y, double to_x,
                                       double to_y, double radius, const samestep_filter* filter,
                                       const samestep_segment_hit** hits, size_t* count) {
  return call(world, [&]<class World>(World& of) {
    using S = typename World::Number;
    at(hits), at(count);
    of.space.segmentQuery(vector<S>(from_x, from_y), vector<S>(to_x, to_y), number<S>(radius),
                          toFilter(filter), of.segmentsFound);
    of.segmentHits.clear();
    for (const auto& hit : of.segmentsFound) {
      of.segmentHits.push_back({toC(hit.shape), toVec2(hit.point), toVec2(hit.normal), toDouble(hit.alpha)});
    }
    give(of.segmentHits, hits, count);
  });
}

samestep_status samestep_query_box(samestep_world* world, double left, double bottom, double right,
                                   double top, const samestep_filter* filter, const samestep_shape_id** hits,
                                   size_t* count) {
  return call(world, [&]<class World>(World& of) {
    using S = typename World::Number;
    at(hits), at(count);
    const samestep::BB<S> box(number<S>(left), number<S>(bottom), number<S>(right), number<S>(top));
    of.space.boxQuery(box, toFilter(filter), of.shapesFound);
    of.boxHits.clear();
    for (const samestep::ShapeId shape : of.shapesFound) of.boxHits.push_back(toC(shape));
    give(of.boxHits, hits, count);
  });
}

samestep_status samestep_query_shapes(const samestep_world* world, samestep_shape_id a, samestep_shape_id b,
                                      samestep_touch* touch) {
  return call(world, [&](auto& of) {
    at(touch);
    const auto& space = std::as_const(of.space);
    const auto& shapeA = space.shape(fromC<samestep::ShapeId>(a));
    const auto& shapeB = space.shape(fromC<samestep::ShapeId>(b));
    *touch = toC(samestep::shapesCollide(shapeA, space.body(shapeA.body()).transform(), shapeB,
                                         space.body(shapeB.body()).transform()));
  });
}

}  // extern "C"
