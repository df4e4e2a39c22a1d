// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <samestep/named_handlers.h>
#include <samestep/recorder.h>
#include "support/old_world.h"
#include "support/recording_sections.h"
#include "support/world.h"

namespace samestep {

using Bytes = std::vector<std::uint8_t>;

/// Writes all hashes again, after something before them was changed.
inline void mendChecksum(Bytes& bytes) { mendRecording(bytes); }

/// Bytes of the match as a recording of version 2 told it, without claims, notes and keyframes.
template <Scalar S>
Bytes asVersion2(const Bytes& bytes) {
  Bytes old(bytes.begin(), bytes.begin() + by_hand::kHeaderBytes);
  old[8] = 2;
  RecordingReader<S> reader(bytes);
  OldWorldWriter write(old);
  WorldState<S>::sections(write, reader.initialWorld());
  by_hand::addNumber(old, reader.initialHash(), 8);
  for (RecordingItem item = reader.next(); item != RecordingItem::end; item = reader.next()) {
    const auto from = reader.items().begin();
    if (item == RecordingItem::claim) continue;
    old.insert(old.end(), from + static_cast<std::ptrdiff_t>(reader.itemAt()),
               from + static_cast<std::ptrdiff_t>(reader.nextAt()));
  }
  old.push_back(2);
  by_hand::addNumber(old, reader.ticks(), 8);
  by_hand::addNumber(old, 0, 8);
  mendChecksum(old);
  return old;
}

/// The game's own input of the tests: its first byte is the user data that the static body gets.
template <Scalar S>
Wiring<S> testWiring() {
  Wiring<S> wiring = namedHandlerWiring<S>();
  wiring.applyInput = [](Space<S>& space, std::span<const std::uint8_t> bytes, void*) {
    require<Fault::ValueOutOfRange>(!bytes.empty());
    space.body(space.staticBody()).setUserData(bytes[0]);
  };
  return wiring;
}

/// A disc that falls from (3, 5), as a command.
template <Scalar S>
Spawn<S> discToSpawn() {
  Spawn<S> spawn{Body<S>(), {circleShape<S>({}, S(1))}};
  spawn.body.setPosition({S(3), S(5)});
  spawn.shapes[0].setMass(S(2));
  return spawn;
}

/// Spawn with ids of the caller's choice.
template <Scalar S>
Spawn<S> underGivenIds(Spawn<S> spawn, BodyId body, ShapeId shape) {
  spawn.id = body;
  spawn.body.setPosition({S(-6), S(5)});
  spawn.shapes[0].attach(shape);
  return spawn;
}

/// A floor, two boxes on it and one above.
template <Scalar S>
BodyId fillSmall(Space<S>& space) {
  registerNamedHandlers(space);
  space.setGravity({S(0), S(-10)});
  space.addWildcardHandler(3, handlerNumber("count"));
  addWall(space, {S(-20), S(0)}, {S(20), S(0)}, ratio<S>(1, 2));
  addBox(space, {S(0), S(1)}, S(1), S(1), S(1));
  const ShapeId top = addBox(space, {ratio<S>(1, 4), S(2)}, S(1), S(1), S(3));
  space.change(top, [](Shape<S>& shape) { shape.setCollisionType(3); });
  addBox(space, {S(-2), S(3)}, S(1), S(1), S(1), {S(2), S(0)});
  return space.shape(top).body();
}

/// A body hung on a nail beside it, and turned by a motor.
template <Scalar S>
Joint<S> doorTo(const Space<S>& space, BodyId body, S speed = S(1)) {
  const Vector<S> aside(ratio<S>(1, 2), S(0));
  Joint<S> joint = revoluteJoint<S>(space.staticBody(), body, space.body(body).toWorld(aside), aside);
  joint.motor = 1;
  joint.motorSpeed = speed;
  joint.motorMax = S(20);
  return joint;
}

/// A match of `ticks` steps with each kind of command in it.
template <Scalar S>
Bytes recordSmallMatch(std::uint32_t ticks = 24, const KeyframeBudget& keyframes = {}, bool packing = false) {
  Space<S> space;
  const BodyId player = fillSmall(space);
  Bytes bytes;
  Recorder<S> recorder(space, kTick<S>, bytes, testWiring<S>());
  recorder.setKeyframes(keyframes);
  recorder.setPacking(packing);
  BodyId spawned;
  for (std::uint32_t tick = 1; tick <= ticks; ++tick) {
    if (tick == 2) recorder.apply(ApplyImpulse<S>{player, {S(1), S(3)}, {ratio<S>(1, 4), S(0)}});
    if (tick == 3) recorder.apply(ApplyForce<S>{player, {S(2), S(0)}, {}});
    if (tick == 4) spawned = recorder.apply(discToSpawn<S>());
    if (tick == 5) recorder.apply(SetVelocity<S>{spawned, {S(-1), S(-2)}});
    if (tick == 6) recorder.apply(SetAngularVelocity<S>{player, S(2)});
    if (tick == 7) recorder.apply(UserInput{{7, 8, 9}});
    if (tick == 8) recorder.apply(SetPosition<S>{spawned, {S(4), S(3)}});
    if (tick == 9) recorder.apply(SetAngle<S>{spawned, S(1)});
    if (tick == 10) recorder.apply(underGivenIds(discToSpawn<S>(), {12, 3}, {9, 1}));
    if (tick == 11) recorder.apply(Join<S>{{3, 1}, doorTo(space, player)});
    if (tick == 12) recorder.apply(Adjust<S>{{3, 1}, doorTo(space, player, S(-1))});
    if (tick == 13) recorder.apply(Join<S>{{}, doorTo(space, spawned)});
    if (tick == 18) recorder.apply(Unjoin{{3, 1}});
    if (tick == 20) recorder.apply(Remove{spawned});
    recorder.step();
  }
  recorder.finish();
  return bytes;
}

}  // namespace samestep
