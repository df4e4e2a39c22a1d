// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/named_handlers.h>

#include "arena/arena.h"

namespace samestep::program {

/// Wiring that recordings need and this program knows of: the handlers of scenes, and the inputs of the
/// arena.
template <Scalar S>
Wiring<S> programWiring() {
  Wiring<S> wiring = namedHandlerWiring<S>();
  wiring.applyInput = arena::applyRecorded<S>;
  return wiring;
}

}  // namespace samestep::program
