// SPDX-License-Identifier: MIT
// The same as a library for the program as it is installed: samestep verify --game libgame.so match.rec
#include <samestep/game_plugin.h>

#include "game.h"

extern "C" int samestep_game(samestep::GamePlugin* program) {
  return samestep::offerGame(program, game::wirings());
}
