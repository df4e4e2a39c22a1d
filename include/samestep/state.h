// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/arbiter.h>
#include <samestep/body.h>
#include <samestep/id.h>
#include <samestep/settings.h>
#include <samestep/shape.h>
#include <samestep/slot_map.h>

namespace samestep {

/// Which collisions a handler is for, and the number its functions are registered under.
struct HandlerBinding {
  enum class Kind : std::uint8_t { pair = 0, wildcard = 1, fallback = 2 };
  CollisionType typeA = 0;
  CollisionType typeB = 0;
  CallbackNumber number = 0;
  Kind kind = Kind::pair;
  std::uint8_t unused[3] = {};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("typeA", self.typeA);
    visit("typeB", self.typeB);
    visit("number", self.number);
    visit("kind", self.kind);
  }
};

/// Everything the future of a world depends on: hashed, saved, portable.
template <Scalar S>
struct WorldState {
  Settings<S> settings{};
  /// Steps made so far.
  std::uint64_t stamp = 0;
  /// Seconds of the last step; 0 before the first.
  S timeStep{};
  BodyId staticBody{};
  /// Bodies of every type. MIS: spaceArrayForBodyType
  SlotMap<Body<S>, BodyId> bodies;
  SlotMap<Shape<S>, ShapeId> shapes;
  /// Sorted by (a, b).
  std::vector<Pair<S>> pairs;
  /// Sorted by (kind, typeA, typeB).
  std::vector<HandlerBinding> handlers;
};

}  // namespace samestep
