// SPDX-License-Identifier: MIT
#pragma once

#include <list>

#include <samestep/command.h>

#include "call.h"

namespace samestep::c {

/// Has the caller's function apply an input.
/// @throws InputRefused with what it answers
inline void applyInput(samestep_world& world, samestep_input_function function,
                       std::span<const std::uint8_t> bytes, void* data) {
  require<Fault::MissingCallback>(function != nullptr);
  const InCallback inCallback(world);
  const samestep_status status = function(&world, bytes.data(), bytes.size(), data);
  if (status != SAMESTEP_OK) throw InputRefused(status);
}

/// The caller's wiring for the Spaces of a replay, each with a world over it.
template <Scalar S>
class ReplayWiring {
 public:
  explicit ReplayWiring(const samestep_wiring& of) : of_(of) {}

  /// As the engine takes it; this must outlive it, in its place.
  Wiring<S> engine() {
    Wiring<S> made;
    made.connect = connect;
    made.data = this;
    if (of_.apply_input != nullptr) made.applyInput = apply;
    return made;
  }

 private:
  static void connect(Space<S>& space, void* data) {
    auto& self = *static_cast<ReplayWiring*>(data);
    WorldOf<S>& world = self.worlds_.emplace_back(space);
    if (self.of_.connect != nullptr) self.of_.connect(&world, self.of_.data);
  }
  static void apply(Space<S>& space, std::span<const std::uint8_t> bytes, void* data) {
    auto& self = *static_cast<ReplayWiring*>(data);
    for (WorldOf<S>& world : self.worlds_) {
      if (&world.space == &space) return applyInput(world, self.of_.apply_input, bytes, self.of_.data);
    }
  }

  const samestep_wiring of_;
  std::list<WorldOf<S>> worlds_;
};

}  // namespace samestep::c
