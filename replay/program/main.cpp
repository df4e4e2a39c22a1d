// SPDX-License-Identifier: MIT
// The program: scenes, their hashes, recordings and pictures.
#include <samestep/program.h>

#include "cli/program_wiring.h"

int main(int argc, char** argv) {
  using namespace samestep;
  Wirings wirings;
  wirings.fixed = program::programWiring<Fixed>();
#ifndef SAMESTEP_FIXED_ONLY
  wirings.float64 = program::programWiring<double>();
#endif
  return runProgram(argc, argv, wirings);
}
