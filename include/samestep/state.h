// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/arbiter.h>
#include <samestep/body.h>
#include <samestep/id.h>
#include <samestep/joint.h>
#include <samestep/limits.h>
#include <samestep/settings.h>
#include <samestep/shape.h>
#include <samestep/slot_map.h>

namespace samestep {

/// Collisions a handler is for, and the number its functions are registered under.
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
  /// The order of a world's list.
  static bool before(const HandlerBinding& a, const HandlerBinding& b) {
    if (a.kind != b.kind) return a.kind < b.kind;
    return a.typeA != b.typeA ? a.typeA < b.typeA : a.typeB < b.typeB;
  }
};

/// Limits of a world from outside: the records of each section, and how much its steps may do.
struct WorldLimits {
  std::uint32_t bodies = 1u << 16;
  std::uint32_t shapes = 1u << 16;
  std::uint32_t pairs = kDefaultMaxPairs;
  std::uint32_t handlers = 1u << 12;
  std::uint32_t joints = 1u << 16;
  /// Passes over all contacts in a step, by either solver: at most those that a Space takes.
  std::uint32_t iterations = 1000;
  std::uint32_t substeps = 100;
  /// Records of the section, again.
  std::uint32_t restingPairs = kDefaultMaxPairs;
};

/// A section of a world: records of one kind, as many as there are.
struct Section {
  const char* object;                 ///< The name of one of its records in messages: "body".
  const char* tooMany;                ///< The reason for refusing a world with more of them than allowed.
  std::uint32_t WorldLimits::*limit;  ///< Member of WorldLimits that limits its records.
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
  /// Sorted by Pair::before.
  std::vector<Pair<S>> pairs;
  /// Those both of whose bodies rest: they sleep or, of a body that is not dynamic, nothing has moved it
  /// since the last step. No step looks at them. Where a body was woken by hand, its pairs are still here
  /// until the next step begins. Sorted by Pair::before.
  std::vector<Pair<S>> restingPairs;
  /// Sorted by HandlerBinding::before.
  std::vector<HandlerBinding> handlers;
  SlotMap<Joint<S>, JointId> joints;

  /// Calls visit(name, field) for each single field and visit(section, records) for each section, in the
  /// order of the canonical encoding; of several worlds with the fields or records of each. Encoding,
  /// decoding, checking, hashing, comparing, limits and byte counts go by this list: docs/architecture.md
  /// says what the record of a new section brings.
  template <class Visitor, class... Worlds>
  static void sections(Visitor&& visit, Worlds&... worlds) {
    visit("settings", worlds.settings...);
    visit("stamp", worlds.stamp...);
    visit("timeStep", worlds.timeStep...);
    visit("staticBody", worlds.staticBody...);
    visit(Section{"body", "more bodies than allowed", &WorldLimits::bodies}, worlds.bodies...);
    visit(Section{"shape", "more shapes than allowed", &WorldLimits::shapes}, worlds.shapes...);
    visit(Section{"pair", "more pairs than allowed", &WorldLimits::pairs}, worlds.pairs...);
    visit(Section{"resting pair", "more resting pairs than allowed", &WorldLimits::restingPairs},
          worlds.restingPairs...);
    visit(Section{"handler", "more handlers than allowed", &WorldLimits::handlers}, worlds.handlers...);
    visit(Section{"joint", "more joints than allowed", &WorldLimits::joints}, worlds.joints...);
  }
};

}  // namespace samestep
