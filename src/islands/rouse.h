// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/state.h>

#include "context/derived.h"
#include "dynamics/body_access.h"

namespace samestep {

/// Notes, between steps or within one, that sleepers have to wake: the next step wakes them with their
/// islands.
template <Scalar S>
struct Rouse {
  using World = WorldState<S>;

  static void body(World& world, Derived<S>& derived, std::uint32_t slot) {
    BodyAccess<S>::rouse(world.bodies.valueAt(slot));
    derived.touch(slot);
  }
  /// A body that sleeps; nothing that is not dynamic.
  static void sleeper(World& world, Derived<S>& derived, std::uint32_t slot) {
    if (world.bodies.valueAt(slot).isSleeping()) body(world, derived, slot);
  }
  /// The sleepers among the bodies of a pair.
  static void ends(World& world, Derived<S>& derived, const Pair<S>& pair) {
    for (const ShapeId shape : {ShapeId(pair.a), ShapeId(pair.b)}) {
      sleeper(world, derived, world.shapes.valueAt(shape.index).body().index);
    }
  }
  /// All that rest: whatever held them may do so no longer.
  static void all(World& world, Derived<S>& derived) {
    world.bodies.each([&](BodyId id, const Body<S>&) { body(world, derived, id.index); });
  }
  /// Rouses those that lie on a shape of a body that does not move itself.
  static void pairsOf(World& world, Derived<S>& derived, ShapeId shape) {
    for (const Pair<S>& pair : world.restingPairs) {
      if (pair.a.index == shape.index || pair.b.index == shape.index) ends(world, derived, pair);
    }
  }
  /// Those near a shape that came to be where it is.
  static void near(World& world, Derived<S>& derived, std::uint32_t shape) {
    if (!derived.anySleeps(world)) return;
    derived.placeForSleepers(world, shape);
    derived.eachSleeperNear(world, shape, [&](std::uint32_t slot) { sleeper(world, derived, slot); });
  }
};

}  // namespace samestep
