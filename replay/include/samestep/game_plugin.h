// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/judge.h>
#include <samestep/version.h>

namespace samestep {

// A game's callbacks, inputs and claims for the program samestep as it is installed: a library that the
// program loads when it is told to by --game, and never otherwise.
//
//     extern "C" int samestep_game(samestep::GamePlugin* program) {
//       samestep::Wirings game;
//       game.fixed.applyInput = applyInput;
//       return samestep::offerGame(program, game);
//     }

/// Number of what a plug-in and a program say to each other; another one is refused.
inline constexpr std::uint32_t kGamePluginInterface = 1;

/// A program's question to a plug-in.
struct GamePlugin {
  std::uint32_t interface = 0;
  /// kSimulationRevision of the program.
  std::uint32_t revision = 0;
  /// Number of how the program was compiled; see gamePluginBuild.
  std::uint64_t build = 0;
  /// Place of the answer.
  Wirings* wirings = nullptr;
};

/// Answers of a plug-in.
enum class GameAnswer : std::uint8_t {
  ready = 0,
  otherInterface = 1,
  otherRevision = 2,
  otherBuild = 3,
};

/// Number that differs where a plug-in and a program would not understand each other's types: they were
/// compiled from other versions of the headers, with another compiler's layout, or with other scalars.
constexpr std::uint64_t gamePluginBuild() {
  std::uint64_t mixed = 14695981039346656037u;
  const auto mix = [&](std::uint64_t value) { mixed = (mixed ^ value) * 1099511628211u; };
  mix(sizeof(void*));
  mix(sizeof(Wirings));
  mix(sizeof(Space<Fixed>));
  mix(sizeof(WorldState<Fixed>));
  mix(sizeof(Body<Fixed>));
  mix(sizeof(Shape<Fixed>));
#ifdef SAMESTEP_FIXED_ONLY
  mix(1);
#else
  mix(sizeof(Space<double>));
  mix(sizeof(WorldState<double>));
#endif
#ifdef __GXX_ABI_VERSION
  mix(__GXX_ABI_VERSION);
#endif
#ifdef _GLIBCXX_USE_CXX11_ABI
  mix(_GLIBCXX_USE_CXX11_ABI);
#endif
  return mixed;
}

/// Gives a program the game's wirings, if it is of the same revision and build.
/// @return what the plug-in's samestep_game returns
inline int offerGame(GamePlugin* program, const Wirings& game) {
  const auto answer = [](GameAnswer said) { return static_cast<int>(said); };
  if (program->interface != kGamePluginInterface) return answer(GameAnswer::otherInterface);
  if (program->revision != kSimulationRevision) return answer(GameAnswer::otherRevision);
  if (program->build != gamePluginBuild()) return answer(GameAnswer::otherBuild);
  *program->wirings = game;
  return answer(GameAnswer::ready);
}

}  // namespace samestep

/// Entry point that a plug-in has.
extern "C" int samestep_game(samestep::GamePlugin* program);
