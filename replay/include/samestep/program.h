// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/judge.h>

namespace samestep {

/// The whole command line of the program `samestep`, for a game that verifies, compares, draws and films its
/// recordings with its own callbacks and inputs. It writes to standard output and standard error.
///
///     int main(int argc, char** argv) {
///       samestep::Wirings game;
///       game.fixed = {.connect = connect, .applyInput = applyInput, .checkClaim = checkClaim};
///       return samestep::runProgram(argc, argv, game);
///     }
///
/// @param wirings  for recordings of each scalar; scenes have the named handlers
/// @return 0 all good, 1 something differs, 2 unusable arguments or files
int runProgram(int argc, char** argv, const Wirings& wirings = {});

}  // namespace samestep
