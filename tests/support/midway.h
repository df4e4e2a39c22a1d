// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/world.h"

namespace samestep {

/// A world that a call left midway says nothing and takes nothing.
template <Scalar S>
void expectUnusable(Space<S>& space) {
  const Space<S>& seen = space;
  std::vector<PointHit<S>> points;
  std::vector<SegmentHit<S>> segments;
  std::vector<ShapeId> boxes;
  SavedSpace<S> saved;
  const ShapeId shape{0, 1};
  const BodyId body = space.staticBody();
  EXPECT_FALSE(space.isUsable());
  EXPECT_FALSE(space.isLocked());
  EXPECT_THROW(space.hash(), LeftMidway);
  EXPECT_THROW(space.hash(body), LeftMidway);
  EXPECT_THROW(space.state(), LeftMidway);
  EXPECT_THROW(space.save(), LeftMidway);
  EXPECT_THROW(space.save(saved), LeftMidway);
  EXPECT_THROW(space.step(kTick<S>), LeftMidway);
  EXPECT_THROW(space.add(Body<S>()), LeftMidway);
  EXPECT_THROW(space.add(circleShape(body, S(1))), LeftMidway);
  EXPECT_THROW(space.remove(shape), LeftMidway);
  EXPECT_THROW(space.removeWithShapes(body), LeftMidway);
  EXPECT_THROW(space.replace(shape, circleShape(body, S(1))), LeftMidway);
  EXPECT_THROW(space.setType(body, BodyType::staticBody), LeftMidway);
  EXPECT_THROW(space.setGravity({}), LeftMidway);
  EXPECT_THROW(space.accumulateMassFromShapes(body), LeftMidway);
  EXPECT_THROW(space.filterArbiters(body), LeftMidway);
  EXPECT_THROW(space.body(body), LeftMidway);
  EXPECT_THROW(seen.body(body), LeftMidway);
  EXPECT_THROW(seen.shape(shape), LeftMidway);
  EXPECT_THROW(space.boundingBox(shape), LeftMidway);
  EXPECT_THROW(space.reindexStatic(), LeftMidway);
  EXPECT_THROW(space.eachBody([](const Body<S>&) {}), LeftMidway);
  EXPECT_THROW(seen.eachBody([](const Body<S>&) {}), LeftMidway);
  EXPECT_THROW(space.eachShape([](const Shape<S>&) {}), LeftMidway);
  EXPECT_THROW(seen.eachShape([](const Shape<S>&) {}), LeftMidway);
  EXPECT_THROW(seen.eachShape(body, [](const Shape<S>&) {}), LeftMidway);
  EXPECT_THROW(space.eachArbiter([](Arbiter<S>&) {}), LeftMidway);
  EXPECT_THROW(space.eachArbiter(body, [](Arbiter<S>&) {}), LeftMidway);
  EXPECT_THROW(space.pointQuery({}, S(1), {}, points), LeftMidway);
  EXPECT_THROW(space.segmentQuery({}, {S(1), S(1)}, S(0), {}, segments), LeftMidway);
  EXPECT_THROW(space.boxQuery({S(0), S(0), S(1), S(1)}, {}, boxes), LeftMidway);
}

/// After a call that threw: the world is as it was or refuses everything, and goes on as it would have
/// from what was saved.
template <Scalar S>
void expectAsItWasOrUnusable(Space<S>& space, const SavedSpace<S>& before, std::uint64_t hashBefore) {
  if (!space.isUsable()) {
    expectUnusable(space);
    space.restore(before);
  }
  EXPECT_TRUE(space.isUsable());
  EXPECT_EQ(space.hash(), hashBefore);
}

}  // namespace samestep
