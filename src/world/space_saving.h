// SPDX-License-Identifier: MIT
// Saved worlds, states brought in, hashes. Included by space.cpp alone, which instantiates Space.
#pragma once

#include <samestep/space.h>

#include "base/change.h"
#include "context/saved_parts.h"
#include "dynamics/body_access.h"
#include "state/state_hash.h"
#include "world/space_parts.h"

namespace samestep {

// Saving.

template <Scalar S>
void Space<S>::save(SavedSpace<S>& into) const {
  requireUnlocked();
  if (into.parts_ == nullptr) into.parts_ = new SavedParts<S>;
  into.parts_->take(state_, parts_->derived);
}

template <Scalar S>
SavedSpace<S> Space<S>::save() const {
  SavedSpace<S> saved;
  save(saved);
  return saved;
}

namespace {

/// @throws ForeignWorld, MissingCallback
template <Scalar S>
void checkAdoptable(const SpaceWiring<S>& wiring, const WorldState<S>& state) {
  require<Fault::ForeignWorld>(state.bodies.contains(state.staticBody), "Nothing was saved there.");
  for (const HandlerBinding& binding : state.handlers) {
    require<Fault::MissingCallback>(wiring.has(binding.number),
                                    "a world: its handlers need one registered under ", binding.number,
                                    "; see Space::registerHandler");
  }
  state.bodies.each([&](BodyId, const Body<S>& body) { wiring.requireCallbacks(body); });
}

/// Gives the objects of a world, whose records have an id, to its Space, together with how far it reaches.
template <Scalar S>
struct GiveObjects {
  S worldExtent;
  std::uint32_t space;

  template <class T>
  void operator()(const char*, T&) {}
  template <class T>
  void operator()(const Section&, std::vector<T>&) {}
  template <class T, class IdType>
  void operator()(const Section&, SlotMap<T, IdType>& objects) {
    objects.each([&](IdType id, T& object) { give(object, id); });
  }
  void give(Body<S>& body, BodyId id) { BodyAccess<S>::attach(body, id, worldExtent); }
  void give(Shape<S>& shape, ShapeId id) { shape.attach(id); }
  void give(Joint<S>& joint, JointId) { joint.bodyA.space = joint.bodyB.space = space; }
};

/// Makes a state that came from elsewhere the Space's own.
template <Scalar S>
void takeOver(StepContext<S> world) {
  ++world.wiring.worldsBroughtIn;
  WorldState<S>::sections(GiveObjects<S>{world.state.settings.worldExtent, world.state.bodies.space()},
                          world.state);
  world.wiring.bound.take(world.state.handlers, world.wiring.handlers);
  world.derived.shapesHashKnown = false;
  world.derived.forget();
  world.derived.surfacesLacking = true;
  world.events.range.clear();
  world.events.contacts.clear();
  world.events.joints.clear();
}

}  // namespace

template <Scalar S>
std::uint64_t Space<S>::worldsBroughtIn() const {
  return parts_->wiring.worldsBroughtIn;
}

template <Scalar S>
template <class Bring>
void Space<S>::bringIn(std::uint32_t theirs, Bring&& bring) {
  const std::uint32_t space = theirs != 0 ? theirs : state_.bodies.space();
  Change change(leftMidway_);
  parts_->postStep.drop();
  bring();
  giveIds(space);
  takeOver(contextOf());
  change.done();
  leftMidway_ = false;
}

template <Scalar S>
void Space<S>::restore(const SavedSpace<S>& saved) {
  require<Fault::SpaceLocked>(locked_ == 0);
  require<Fault::ForeignWorld>(saved.parts_ != nullptr && !saved.parts_->records.empty(),
                               "Nothing was saved there.");
  saved.parts_->records.requireCallbacks(parts_->wiring);
  bringIn(saved.parts_->records.space(), [&] { saved.parts_->records.giveTo(state_); });
  Change change(leftMidway_);
  parts_->derived.restoreFrom(saved.parts_->derived, state_);
  change.done();
}

template <Scalar S>
void Space<S>::adopt(const WorldState<S>& state) {
  require<Fault::SpaceLocked>(locked_ == 0);
  checkAdoptable(parts_->wiring, state);
  bringIn(state.bodies.space(), [&] { state_ = state; });
}

template <Scalar S>
void Space<S>::adopt(WorldState<S>&& state) {
  require<Fault::SpaceLocked>(locked_ == 0);
  checkAdoptable(parts_->wiring, state);
  bringIn(state.bodies.space(), [&] { state_ = std::move(state); });
}

template <Scalar S>
void Space<S>::dropCache() {
  require<Fault::SpaceLocked>(locked_ == 0);
  parts_->derived.forget();
}

// Hashes.

template <Scalar S>
std::uint64_t Space<S>::hash() const {
  requireUsable();
  Derived<S>& derived = parts_->derived;
  if (!derived.shapesHashKnown) {
    derived.shapesHash = hashOfShapes(state_.shapes);
    derived.shapesHashKnown = true;
  }
  return hashOfWorld(state_, derived.shapesHash);
}

template <Scalar S>
std::uint64_t Space<S>::hash(BodyId id) const {
  return hashOf(body(id));
}

template <Scalar S>
std::uint64_t Space<S>::hash(ShapeId id) const {
  return hashOf(shape(id));
}

template <Scalar S>
std::uint64_t Space<S>::hash(JointId id) const {
  return hashOf(joint(id));
}

}  // namespace samestep
