// SPDX-License-Identifier: MIT
// The inputs, callbacks and claims of a small game, for the two ways in which it verifies its recordings.
#pragma once

#include <samestep/judge.h>

namespace game {

using samestep::Fixed;
using World = samestep::Space<Fixed>;

/// Number of the game's own collision handler; those below 1000 are the library's.
inline constexpr samestep::CallbackNumber kBounce = 1000;

/// The player's body has the index 1. A stranger's world may have none: the id is then not valid.
inline samestep::BodyId playerOf(const World& space) {
  const auto& bodies = space.state().bodies;
  return bodies.slots() > 1 && bodies.aliveAt(1) ? bodies.idAt(1) : samestep::BodyId{};
}

/// The input is one byte: how hard the player jumps, in m/s.
inline void applyInput(World& space, std::span<const std::uint8_t> input, void*) {
  samestep::Body<Fixed>& player = space.body(playerOf(space));
  player.setVelocity({player.velocity().x, Fixed(static_cast<int>(input.empty() ? 0 : input[0]))});
}

/// Registers what the handlers of the game's worlds are bound to.
inline void connect(World& space, void*) {
  samestep::registerNamedHandlers(space);
  samestep::CollisionHandler<Fixed> bounce;
  bounce.preSolve = [](samestep::Arbiter<Fixed>& contact, World&, void*) {
    contact.setRestitution(Fixed(1));
    return true;
  };
  space.registerHandler(kBounce, bounce);
}

/// "height": the player is so many whole metres up, or more.
inline samestep::ClaimCheck checkClaim(const World& space, std::string_view key,
                                       std::span<const std::uint8_t> value, void*) {
  if (key != "height" || value.size() != 1) return samestep::ClaimCheck::unknown;
  const samestep::BodyId player = playerOf(space);
  if (!player.valid()) return samestep::ClaimCheck::isFalse;
  const bool there = space.body(player).position().y >= Fixed(static_cast<int>(value[0]));
  return there ? samestep::ClaimCheck::holds : samestep::ClaimCheck::isFalse;
}

inline samestep::Wirings wirings() {
  samestep::Wirings all;
  all.fixed = {.connect = connect, .applyInput = applyInput, .data = nullptr, .checkClaim = checkClaim};
  return all;
}

}  // namespace game
