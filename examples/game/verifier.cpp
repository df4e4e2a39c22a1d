// SPDX-License-Identifier: MIT
// A game's own verifier: the whole command line of samestep with the inputs and claims of the game.
#include <samestep/program.h>

using samestep::Fixed;
using World = samestep::Space<Fixed>;

/// The input is one byte: how hard the player jumps, in m/s. His body has the index 1.
void applyInput(World& space, std::span<const std::uint8_t> input, void*) {
  samestep::Body<Fixed>& player = space.body(space.state().bodies.idAt(1));
  player.setVelocity({player.velocity().x, Fixed(static_cast<int>(input.empty() ? 0 : input[0]))});
}

/// "height": the player is so many whole metres up, or more.
samestep::ClaimCheck checkClaim(const World& space, std::string_view key, std::span<const std::uint8_t> value,
                                void*) {
  if (key != "height" || value.size() != 1) return samestep::ClaimCheck::unknown;
  const bool there =
      space.body(space.state().bodies.idAt(1)).position().y >= Fixed(static_cast<int>(value[0]));
  return there ? samestep::ClaimCheck::holds : samestep::ClaimCheck::isFalse;
}

int main(int argc, char** argv) {
  samestep::Wirings game;
  game.fixed.applyInput = applyInput;
  game.fixed.checkClaim = checkClaim;
  return samestep::runProgram(argc, argv, game);
}
