// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <samestep/kernel.h>
#include <samestep/scene.h>

#include "study/chart.h"

namespace samestep {

/// Options of a sweep.
struct SweepOptions {
  std::uint64_t steps = 0;  ///< 0: as the exact answer says, else 330 or what the scene lasts.
  int rounds = 3;           ///< In which all settings take turns; at least 1.
  /// A run is repeated until the steps timed in it took so long, s.
  double leastSeconds = 0.02;
  /// The soft step has a line for each; all make the same errors.
  std::vector<KernelTarget> kernels{KernelTarget::best};
  /// Is told in words what has been done, and of how much: runs.
  std::function<void(int done, int total, const std::string& what)> progress;
};

/// Runs a scene with every method and count, and measures time and error of each; marks the front.
///
/// The error is the distance from the exact answer where the scene has one (kind `exact`). Else the scene is
/// run with 64 and with 32 substeps of the soft step: if these agree to 1 cm, it is the distance from the
/// first (`reference`). Else, in the second after the last step, the deepest overlap and, if the bodies of
/// that run had come to rest, how far bodies move (`rest`, `overlap`).
/// @throws SceneError; Error for steps beyond those for which an exact answer holds
Chart sweepScene(const SceneSource& source, const SweepOptions& options);

}  // namespace samestep
