// SPDX-License-Identifier: MIT
// A game's own verifier: the whole command line of samestep with the inputs, callbacks and claims of the
// game.
#include <samestep/program.h>

#include "game.h"

int main(int argc, char** argv) { return samestep::runProgram(argc, argv, game::wirings()); }
