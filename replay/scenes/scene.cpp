// SPDX-License-Identifier: MIT
#include <samestep/scene.h>

#include "base/require_ieee.h"
#include "scenes/scene_builder.h"

namespace samestep {
namespace {

/// The joint that a command is for, or one that is not valid().
template <Scalar S>
JointId jointOf(const Command<S>& command) {
  if (const auto* adjust = std::get_if<Adjust<S>>(&command)) return adjust->id;
  if (const auto* unjoin = std::get_if<Unjoin>(&command)) return unjoin->joint;
  return {};
}

/// The body that a command is for; null for a spawn or a user's input.
template <Scalar S>
BodyId* targetOf(Command<S>& command) {
  return std::visit(
      [](auto& c) -> BodyId* {
        if constexpr (requires {
                        { c.body } -> std::same_as<BodyId&>;
                      })
          return &c.body;
        return nullptr;
      },
      command);
}

}  // namespace

template <Scalar S>
Scene<S>::Scene(const SceneSource& source) {
  SceneBuilder<S>(*this, source.document()).build();
}

template <Scalar S>
const Command<S>* Scene<S>::nextCommand() {
  commandsDone_ = false;
  while (next_ < events_.size() && events_[next_].tick <= tick() + 1) {
    Event& event = events_[next_++];
    if (BodyId* target = targetOf(event.command)) {
      *target = names_[event.name];
      if (!space_.contains(*target)) continue;
    } else if (const JointId joint = jointOf(event.command); joint.valid()) {
      if (!space_.contains(joint)) continue;
    } else if (kindOf(event.command) == CommandKind::spawn) {
      names_[event.name] = space_.state().bodies.nextId();
    }
    return &event.command;
  }
  commandsDone_ = true;
  return nullptr;
}

template <Scalar S>
SceneError Scene<S>::refused(const Error& error) const {
  if (commandsDone_ && error.fault() == Fault::IllegalBody && unsteppable_) return *unsteppable_;
  if (commandsDone_) return {file_, 0, "", "step " + std::to_string(tick() + 1) + ": " + error.what()};
  const Event& event = events_[next_ - 1];
  return {event.isInput ? inputsFile_ : file_, event.line, "",
          "\"" + std::string(commandName(kindOf(event.command))) + "\" at tick " +
              std::to_string(event.tick) + ": " + error.what()};
}

template <Scalar S>
void Scene<S>::step() {
  try {
    const FailuresAreCaught caught;
    while (const Command<S>* command = nextCommand()) applyCommand(space_, *command);
    space_.step(timeStep_);
  } catch (const Error& error) {
    throw refused(error);
  }
}

#define SAMESTEP_EACH_SCALAR template class Scene<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
