// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <samestep/query.h>

#include "world/space_parts.h"

namespace samestep {

/// Questions about the world as it stands, answered by rising shape id.
template <Scalar S>
struct Queries {
  const WorldState<S>& state;
  SpaceParts<S>& parts;

  void point(const Vector<S>& point, S distance, const ShapeFilter& filter, std::vector<PointHit<S>>& hits);
  void segment(const Vector<S>& start, const Vector<S>& end, S radius, const ShapeFilter& filter,
               std::vector<SegmentHit<S>>& hits);
  void box(const BB<S>& box, const ShapeFilter& filter, std::vector<ShapeId>& hits);

 private:
  /// Puts the keys of both trees into `parts.found`, sorted.
  template <class Collect>
  void collectFound(Collect&& collect);
};

#define SAMESTEP_EACH_SCALAR extern template struct Queries<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
