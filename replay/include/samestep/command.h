// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include <samestep/space.h>

namespace samestep {

// Commands say what a player or the game does to a world between two steps. A command is applied as a whole
// or, where the Space refuses it, not at all: it then throws what the Space throws and the world is as it
// was. Numbers have the units and ranges of the Body function they are named after.

/// An impulse in N s; see Body::applyImpulse.
template <Scalar S>
struct ApplyImpulse {
  BodyId body{};
  Vector<S> impulse{};
  /// Lever arm from the centre of mass to where it acts, in world axes, m.
  Vector<S> arm{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("body", self.body);
    visit("impulse", self.impulse);
    visit("arm", self.arm);
  }
};

/// A force in N during the next step; see Body::applyForce.
template <Scalar S>
struct ApplyForce {
  BodyId body{};
  Vector<S> force{};
  /// Lever arm from the centre of mass to where it acts, in world axes, m.
  Vector<S> arm{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("body", self.body);
    visit("force", self.force);
    visit("arm", self.arm);
  }
};

/// See Body::setVelocity.
template <Scalar S>
struct SetVelocity {
  BodyId body{};
  Vector<S> velocity{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("body", self.body);
    visit("velocity", self.velocity);
  }
};

/// See Body::setAngularVelocity.
template <Scalar S>
struct SetAngularVelocity {
  BodyId body{};
  S angularVelocity{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("body", self.body);
    visit("angularVelocity", self.angularVelocity);
  }
};

/// See Body::setPosition.
template <Scalar S>
struct SetPosition {
  BodyId body{};
  Vector<S> position{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("body", self.body);
    visit("position", self.position);
  }
};

/// See Body::setAngle.
template <Scalar S>
struct SetAngle {
  BodyId body{};
  S angle{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("body", self.body);
    visit("angle", self.angle);
  }
};

/// A new body with its shapes, which need not name it.
template <Scalar S>
struct Spawn {
  Body<S> body{};
  std::vector<Shape<S>> shapes;
  /// The id it shall have; each shape then carries its own. Not valid(): the world gives all of them.
  BodyId id{};
};

/// Takes a body and its shapes away.
struct Remove {
  BodyId body{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("body", self.body);
  }
};

/// Bytes that only the game understands: its own input, applied by its own function.
struct UserInput {
  std::vector<std::uint8_t> bytes;
};

/// A new joint; see Space::add.
template <Scalar S>
struct Join {
  /// The id it shall have. Not valid(): the world gives it.
  JointId id{};
  Joint<S> joint{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("id", self.id);
    visit("joint", self.joint);
  }
};

/// Another joint in place of one: other limits, another motor; see Space::replace.
template <Scalar S>
struct Adjust {
  JointId id{};
  Joint<S> joint{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("id", self.id);
    visit("joint", self.joint);
  }
};

/// Takes a joint away.
struct Unjoin {
  JointId joint{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("joint", self.joint);
  }
};

/// Anything that happens to a world from outside. The order of the alternatives is that of CommandKind.
template <Scalar S>
using Command =
    std::variant<ApplyImpulse<S>, ApplyForce<S>, SetVelocity<S>, SetAngularVelocity<S>, SetPosition<S>,
                 SetAngle<S>, Spawn<S>, Remove, UserInput, Join<S>, Adjust<S>, Unjoin>;

/// Kind of a command in a recording.
enum class CommandKind : std::uint8_t {
  applyImpulse = 0,
  applyForce = 1,
  setVelocity = 2,
  setAngularVelocity = 3,
  setPosition = 4,
  setAngle = 5,
  spawn = 6,
  remove = 7,
  userInput = 8,
  join = 9,
  adjust = 10,
  unjoin = 11,
};
inline constexpr std::uint8_t kCommandKinds = 12;

template <Scalar S>
CommandKind kindOf(const Command<S>& command) {
  return static_cast<CommandKind>(command.index());
}
/// "impulse", "spawn", ...: also the word that scenes use.
const char* commandName(CommandKind kind);

/// Answer of a game to a claim of a recording.
enum class ClaimCheck : std::uint8_t {
  holds,
  isFalse,
  unknown,  ///< It knows no such key.
};

/// Wiring that a Space needs beside its state, before a recorded world is put in: the functions behind the
/// numbers its handlers and bodies name, and the function that understands the game's own input.
template <Scalar S>
struct Wiring {
  /// Registers functions with a new Space; null for none.
  void (*connect)(Space<S>& space, void* data) = nullptr;
  /// Applies a UserInput; null where no recording of the game has any. It must go by the bytes and the Space
  /// alone, and either apply all or throw an Error and change nothing. Each replay has a Space of its own:
  /// ids that a game keeps beside its Space for this are Id::anywhere.
  void (*applyInput)(Space<S>& space, std::span<const std::uint8_t> bytes, void* data) = nullptr;
  void* data = nullptr;
  /// Tells whether what a recording claims is true of the world as it is now; null where the game knows no
  /// claims. The value is what Recorder::claim was given, or what a stranger put there.
  ClaimCheck (*checkClaim)(const Space<S>& space, std::string_view key, std::span<const std::uint8_t> value,
                           void* data) = nullptr;
};

/// Does what the command says. Not called apply: a command is a variant, and std::apply would be found for
/// it.
/// @return the id of a spawned body, else an id that is not valid()
/// @throws what the Space throws; MissingCallback for a UserInput without a function
template <Scalar S>
BodyId applyCommand(Space<S>& space, const Command<S>& command, const Wiring<S>& wiring = {});

}  // namespace samestep
