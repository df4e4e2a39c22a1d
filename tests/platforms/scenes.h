// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/space.h>

namespace samestep {

/// A scene made in code, for platforms to agree on.
template <Scalar S>
struct PlatformScene {
  const char* name;
  void (*build)(Space<S>& space);
  /// Before each step.
  void (*act)(Space<S>& space, std::uint64_t tick);
};

inline constexpr int kPlatformScenes = 3;
template <Scalar S>
PlatformScene<S> platformScene(int index);

}  // namespace samestep
