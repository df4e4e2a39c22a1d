// SPDX-License-Identifier: MIT
// Queries, answered into arrays of the world.
#include <algorithm>
#include <span>
#include <vector>

#include "base/require_ieee.h"
#include "definitions.h"

using namespace samestep::c;
using samestep::NearHit;
using samestep::SegmentHit;

namespace samestep::c {
namespace {

/// The array that a query writes into, as long as that of the caller.
template <class Hit, class CHit>
std::vector<Hit>& roomFor(std::vector<Hit>& found, const CHit* hits, std::size_t capacity,
                          std::size_t* count) {
  at(count);
  if (capacity > 0) at(hits);
  // No world has more shapes.
  found.assign(std::min<std::size_t>(capacity, 1u << 24), Hit());
  return found;
}

template <class S>
void giveHits(const std::vector<SegmentHit<S>>& found, samestep_segment_hit* hits, std::size_t count) {
  for (std::size_t i = 0; i < found.size() && i < count; ++i) {
    hits[i] = {toC(found[i].shape), toVec2(found[i].point), toVec2(found[i].normal),
               toDouble(found[i].alpha)};
  }
}

template <class S>
samestep_near_hit nearOf(const NearHit<S>& hit) {
  return {toC(hit.shape), toDouble(hit.there.distance), toVec2(hit.there.normal), toVec2(hit.there.pointA),
          toVec2(hit.there.pointB)};
}

}  // namespace
}  // namespace samestep::c

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

samestep_status samestep_query_cast_ray(samestep_world* world, double from_x, double from_y, double to_x,
                                        double to_y, double radius, const samestep_filter* filter,
                                        samestep_segment_hit* hits, size_t capacity, size_t* count) {
  return call(world, [&]<class World>(World& of) {
    using S = typename World::Number;
    std::vector<SegmentHit<S>>& found = roomFor(of.segmentsFound, hits, capacity, count);
    *count = of.space.queries().castRay(vector<S>(from_x, from_y), vector<S>(to_x, to_y), {toFilter(filter)},
                                        std::span<SegmentHit<S>>(found), number<S>(radius));
    giveHits(found, hits, *count);
  });
}

samestep_status samestep_query_cast_shape(samestep_world* world, const samestep_shape_def* shape,
                                          const samestep_motion* motion, const samestep_filter* filter,
                                          samestep_segment_hit* hits, size_t capacity, size_t* count) {
  return call(world, [&]<class World>(World& of) {
    using S = typename World::Number;
    at(shape), at(motion);
    std::vector<SegmentHit<S>>& found = roomFor(of.segmentsFound, hits, capacity, count);
    const samestep::RigidMotion<S> way{vector<S>(motion->pivot), vector<S>(motion->start),
                                       number<S>(motion->angle), vector<S>(motion->way),
                                       number<S>(motion->turn)};
    *count = of.space.queries().castShape(toShape<S>({}, *shape), way, {toFilter(filter)},
                                          std::span<SegmentHit<S>>(found));
    giveHits(found, hits, *count);
  });
}

samestep_status samestep_query_near(samestep_world* world, const samestep_shape_def* shape, double x,
                                    double y, double angle, double reach, const samestep_filter* filter,
                                    samestep_near_hit* hits, size_t capacity, size_t* count) {
  return call(world, [&]<class World>(World& of) {
    using S = typename World::Number;
    at(shape);
    std::vector<NearHit<S>>& found = roomFor(of.nearFound, hits, capacity, count);
    const auto pose = samestep::Transform<S>::rigid(vector<S>(x, y), number<S>(angle));
    *count = of.space.queries().nearest(toShape<S>({}, *shape), pose, number<S>(reach), {toFilter(filter)},
                                        std::span<NearHit<S>>(found));
    for (std::size_t i = 0; i < found.size() && i < *count; ++i) hits[i] = nearOf(found[i]);
  });
}

samestep_status samestep_query_distance(samestep_world* world, samestep_shape_id a, samestep_shape_id b,
                                        samestep_near_hit* hit) {
  return call(world, [&]<class World>(World& of) {
    at(hit);
    const samestep::ShapeId other = fromC<samestep::ShapeId>(b);
    *hit = nearOf(NearHit<typename World::Number>{
        other, of.space.queries().distance(fromC<samestep::ShapeId>(a), other)});
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
