// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "study/chart.h"

namespace samestep {

/// Goal of a search for settings; 0 for no bound.
struct TuneGoal {
  double error = 0;   ///< Greatest error, m.
  double budget = 0;  ///< Greatest time of a step of the scene's own length, ms.
};

/// Answer of a search: pointers into the chart.
struct Tuned {
  FrontPoint found{};  ///< Null where no setting meets the goal.
  FrontPoint
      nearest{};  ///< Where none does, the one that comes nearest to it; null where all settings failed.
  /// The settings of a Space that nobody changed, in the scalar of `found` or `nearest`; null where the chart
  /// lacks them.
  FrontPoint usual{};
};

/// Looks in a chart for the cheapest setting whose error is at most the goal's, or without a greatest error
/// for the most accurate within the budget. Of settings that are equal in what is asked for, the more
/// accurate or cheaper one, then the one that stands first: the answer follows from the figures alone.
/// @throws std::invalid_argument for a goal without a bound, or with one that is no positive number
Tuned tune(const Chart& chart, const TuneGoal& goal);

/// Time of a step of the scene's own length, ms.
double millisecondsPerStep(const Chart& chart, const ChartPoint& point);

/// A setting as JSON: "scalar", "stepsPerSecond" and "settings" as in a scene, and "evidence" with its
/// figures.
std::string settingsJson(const Chart& chart, const FrontPoint& point);

}  // namespace samestep
