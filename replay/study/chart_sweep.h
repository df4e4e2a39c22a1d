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
  /// Every method has a line for each: steps of the scene's own length times 2^-h, -1 to 3. One other than 0
  /// needs a scene without events, which come at numbered steps.
  std::vector<int> halvings{0};
  /// From how many starts the error is measured where the scene has no answer to compare with, at least 1:
  /// the scene's own, and ones whose bodies are up to 2^-10 m/s faster or slower.
  int starts = 1;
  /// Is told in words what has been done, and of how much: runs.
  std::function<void(int done, int total, const std::string& what)> progress;
};

/// Runs a scene with every method, step size and count, and measures time and error of each; marks the front.
///
/// The error is the distance from the exact answer where the scene has one (kind `exact`). Else the scene is
/// run with 64 and with 32 substeps of the soft step: if these agree to 1 cm, it is the distance from the
/// first (`reference`). Else, in the second after the last step, the deepest overlap and, if the bodies of
/// that run had come to rest, how far bodies move (`rest`, `overlap`): the median over the starts, with
/// quartiles. A setting whose steps cannot be made has a failure in place of an error.
/// @throws SceneError; std::runtime_error for steps beyond those for which an exact answer holds, and for
/// other
///         step sizes of a scene with events
Chart sweepScene(const SceneSource& source, const SweepOptions& options);

}  // namespace samestep
