// SPDX-License-Identifier: MIT
#include <samestep/command.h>

#include <algorithm>

#include "base/require_ieee.h"

namespace samestep {
namespace {

template <Scalar S>
void addShapes(Space<S>& space, BodyId body, const std::vector<Shape<S>>& shapes, bool underTheirIds) {
  for (const Shape<S>& shape : shapes) {
    Shape<S> free = shape.detached();
    free.setBody(body);
    if (underTheirIds) {
      space.add(free, shape.id());
    } else {
      space.add(free);
    }
  }
}

/// In the order in which they weigh together.
template <Scalar S>
std::vector<Shape<S>> byId(std::vector<Shape<S>> shapes) {
  std::stable_sort(shapes.begin(), shapes.end(),
                   [](const Shape<S>& a, const Shape<S>& b) { return a.id() < b.id(); });
  return shapes;
}

/// Refuses ids that the world cannot give to what is spawned.
template <Scalar S>
void checkIds(const Space<S>& space, const Spawn<S>& spawn) {
  space.state().bodies.checkGiven(spawn.id);
  for (std::size_t i = 0; i < spawn.shapes.size(); ++i) {
    space.state().shapes.checkGiven(spawn.shapes[i].id());
    for (std::size_t j = 0; j < i; ++j) {
      require<Fault::IllegalId>(spawn.shapes[i].id().index != spawn.shapes[j].id().index,
                                "a spawn: two of its shapes have given ids of slot ",
                                spawn.shapes[i].id().index);
    }
  }
}

/// End of a command's arm, in the world.
/// @throws IllegalBody for one too long to end there
template <Scalar S>
Vector<S> endOfArm(const Body<S>& body, const Vector<S>& arm) {
  require<Fault::IllegalBody>(within(arm, kMaxWorldExtent<S> * S(4)), "a command: its arm is ", arm,
                              " m, which does not end in the world");
  return body.worldCenter() + arm;
}

/// Stands where a command is several changes: memory may run out between them.
template <Scalar S>
struct Whole {
  Space<S>& space;
  bool done = false;
  ~Whole() {
    if (!done) space.leaveMidway();
  }
};

/// Does one kind of command each.
template <Scalar S>
struct Applier {
  Space<S>& space;
  const Wiring<S>& wiring;

  BodyId operator()(const ApplyImpulse<S>& c) const {
    Body<S>& body = space.body(c.body);
    body.applyImpulse(c.impulse, endOfArm(body, c.arm));
    return {};
  }
  BodyId operator()(const ApplyForce<S>& c) const {
    Body<S>& body = space.body(c.body);
    body.applyForce(c.force, endOfArm(body, c.arm));
    return {};
  }
  BodyId operator()(const SetVelocity<S>& c) const {
    space.body(c.body).setVelocity(c.velocity);
    return {};
  }
  BodyId operator()(const SetAngularVelocity<S>& c) const {
    space.body(c.body).setAngularVelocity(c.angularVelocity);
    return {};
  }
  BodyId operator()(const SetPosition<S>& c) const {
    space.body(c.body).setPosition(c.position);
    return {};
  }
  BodyId operator()(const SetAngle<S>& c) const {
    space.body(c.body).setAngle(c.angle);
    return {};
  }
  BodyId operator()(const Spawn<S>& c) const {
    // The command is tried out elsewhere first: once an id is given out here, it cannot be taken back.
    const bool given = c.id.valid();
    Space<S> trial;
    trial.setWorldExtent(space.worldExtent());
    if (given) checkIds(space, c);
    addShapes(trial, trial.add(c.body), given ? byId(c.shapes) : c.shapes, false);

    const BodyId id = given ? space.add(c.body, c.id) : space.add(c.body);
    Whole<S> whole{space};
    addShapes(space, id, c.shapes, given);
    // The velocity is that of the centre of mass, which the shapes have moved.
    if (c.body.type() != BodyType::staticBody) space.body(id).setVelocity(c.body.velocity());
    whole.done = true;
    return id;
  }
  BodyId operator()(const Remove& c) const {
    space.removeWithShapes(c.body);
    return {};
  }
  BodyId operator()(const Join<S>& c) const {
    if (c.id.valid()) {
      space.add(c.joint, c.id);
    } else {
      space.add(c.joint);
    }
    return {};
  }
  BodyId operator()(const Adjust<S>& c) const {
    space.replace(c.id, c.joint);
    return {};
  }
  BodyId operator()(const Unjoin& c) const {
    space.remove(c.joint);
    return {};
  }
  BodyId operator()(const UserInput& c) const {
    require<Fault::MissingCallback>(wiring.applyInput != nullptr, "an input of ", c.bytes.size(),
                                    " bytes: no function of the game's applies inputs");
    wiring.applyInput(space, c.bytes, wiring.data);
    return {};
  }
};

}  // namespace

const char* commandName(CommandKind kind) {
  switch (kind) {
    case CommandKind::applyImpulse:
      return "impulse";
    case CommandKind::applyForce:
      return "force";
    case CommandKind::setVelocity:
      return "velocity";
    case CommandKind::setAngularVelocity:
      return "angularVelocity";
    case CommandKind::setPosition:
      return "position";
    case CommandKind::setAngle:
      return "angle";
    case CommandKind::spawn:
      return "spawn";
    case CommandKind::remove:
      return "remove";
    case CommandKind::userInput:
      return "input";
    case CommandKind::join:
      return "join";
    case CommandKind::adjust:
      return "adjust";
    case CommandKind::unjoin:
      return "unjoin";
  }
  return "unknown";
}

template <Scalar S>
BodyId applyCommand(Space<S>& space, const Command<S>& command, const Wiring<S>& wiring) {
  return std::visit(Applier<S>{space, wiring}, command);
}

#define SAMESTEP_EACH_SCALAR template BodyId applyCommand<S>(Space<S>&, const Command<S>&, const Wiring<S>&);
#include <samestep/each_scalar.h>

}  // namespace samestep
