// SPDX-License-Identifier: MIT
#include "narrow_phase/sweep.h"

#include "narrow_phase/nearest.h"

namespace samestep {
namespace {

/// Shapes this close have met, m.
template <Scalar S>
inline constexpr S kMet = S(0x1p-15);
/// Steps towards each other after which shapes that have not met pass each other.
constexpr int kMaxAdvances = 16;

/// A shape that is taken along a way.
template <Scalar S>
class MovedShape {
 public:
  MovedShape(const PlacedShape<S>& shape) : from_(shape), placed_(shape) {
    placed_.planes = planes_;
    // The tangents of a segment stay.
    if (shape.type == ShapeType::segment) planes_[2] = shape.planes[2];
  }
  MovedShape(const MovedShape&) = delete;
  MovedShape& operator=(const MovedShape&) = delete;

  const PlacedShape<S>& by(const Vector<S>& way) {
    for (int i = 0; i < placed_.count; ++i) planes_[i] = {from_.planes[i].v0 + way, from_.planes[i].n};
    placed_.box = {from_.box.left + way.x, from_.box.bottom + way.y, from_.box.right + way.x,
                   from_.box.top + way.y};
    return placed_;
  }

 private:
  const PlacedShape<S>& from_;
  PlacedShape<S> placed_;
  Plane<S> planes_[kMaxPolyVertices];
};

}  // namespace

// Conservative advancement: along the normal between the nearest points convex shapes come no nearer than
// their motion says, so that going on by what is left along it passes no touch.
template <Scalar S>
bool sweep(const PlacedShape<S>& a, const PlacedShape<S>& b, const Vector<S>& way, CollisionInfo<S>& info) {
  MovedShape<S> moved(a);
  S part(0);
  for (int i = 0; i < kMaxAdvances; ++i) {
    const PlacedShape<S>& now = moved.by(way * part);
    const Gap<S> gap = gapBetween(now, b);
    if (gap.distance <= kMet<S>) {
      const CollisionId id = info.id;
      info = collide(now, b, CollisionId{0}, nullptr, S(2) * kMet<S>);
      info.id = id;
      for (int k = 0; k < info.count; ++k) info.points[k].pointA -= way * part;
      return info.count > 0;
    }
    const S closing = dot(way, gap.normal);
    if (closing <= S(0) || gap.distance > closing * (S(1) - part)) return false;
    part += gap.distance / closing;
  }
  return false;
}

#define SAMESTEP_EACH_SCALAR \
  template bool sweep<S>(const PlacedShape<S>&, const PlacedShape<S>&, const Vector<S>&, CollisionInfo<S>&);
#include <samestep/each_scalar.h>

}  // namespace samestep
