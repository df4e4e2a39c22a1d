// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/collision.h>
#include <samestep/events.h>
#include <samestep/state.h>

namespace samestep {

/// The lists of contacts of the last step, and what the one under way needs to make them.
template <Scalar S>
struct ContactLists {
  struct Touching {
    ShapeId a, b;
  };
  struct Speed {
    Vector<S> velocity;
    S angularVelocity;
  };

  std::uint64_t tick = 0;
  std::vector<ContactEvent> begins;
  std::vector<ContactEvent> ends;
  std::vector<ImpactEvent<S>> impacts;
  /// Brought about since the last step, to be listed by the next one.
  std::vector<ContactEvent> endsBetween;
  // These are as the step began: the pairs that touched, by rising ids, and the velocities by body slot.
  std::vector<Touching> touching;
  std::vector<Speed> speeds;

  void clear() {
    tick = 0;
    begins.clear();
    ends.clear();
    impacts.clear();
    endsBetween.clear();
  }
};

/// Bodies of a step that go far in it, and the places where all that move began.
template <Scalar S>
struct FastBodies {
  struct Start {
    Vector<S> center{};
    S angle{};
  };

  /// Starts by body slot, of bodies that a step moves.
  std::vector<Start> starts;
  /// Motions by body slot: kStays, kMoves or kGoesFar.
  std::vector<std::uint8_t> motions;
  static constexpr std::uint8_t kStays = 0, kMoves = 1, kGoesFar = 2;
  /// False where nothing is to be stopped: then nothing is noted.
  bool watched = false;

  void begin(const WorldState<S>& world) {
    watched = world.settings.continuous != 0;
    if (!watched) return;
    starts.resize(world.bodies.slots());
    motions.assign(world.bodies.slots(), kStays);
  }
  bool isFast(std::uint32_t index) const { return motions[index] == kGoesFar; }
  /// Notes where a body is before it is moved.
  void noteStart(std::uint32_t index, const Body<S>& body) {
    starts[index] = {body.worldCenter(), body.angle()};
    motions[index] = kMoves;
  }
};

/// Events of a step: what it tells beside the state, read after it.
template <Scalar S>
struct StepEvents {
  std::vector<RangeEvent> range;
  CollisionStats collisionStats{};
  std::uint64_t accurateInstead = 0;
  ContactLists<S> contacts;
  /// Events of joints by rising id, those of one joint by change.
  std::vector<JointEvent<S>> joints;
  /// Bits of Body::Held that the step under way noted, by body slot.
  std::vector<std::uint8_t> held;
  FastBodies<S> fast;

  void begin(const WorldState<S>& world) {
    held.assign(world.bodies.slots(), 0);
    fast.begin(world);
  }
  /// Lists what was held, by body id.
  /// @param moved  the slots of those that the step moved
  void listRange(const WorldState<S>& world, const std::vector<std::uint32_t>& moved) {
    range.clear();
    for (const std::uint32_t i : moved) {
      if (held[i] != 0) [[unlikely]]
        range.push_back({world.bodies.idAt(i), held[i]});
    }
  }
};

}  // namespace samestep
