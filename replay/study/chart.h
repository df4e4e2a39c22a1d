// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <samestep/settings.h>

namespace samestep {

/// One setting of a method: how long a step takes and how far its result is off.
struct ChartPoint {
  int count = 0;            ///< Iterations or substeps.
  double milliseconds = 0;  ///< Time per simulated second, the median of the rounds.
  double fastest = 0;       ///< Time of the fastest round, ms per simulated second.
  double slowest = 0;
  double error = 0;    ///< m; what it is of, Chart::measure says; the median where there are several starts.
  double overlap = 0;  ///< Overlap that error is the sum of, in kinds rest and overlap, m.
  double drift = 0;
  double lowQuartile = 0;  ///< Quartile of the errors of several starts, m; error where there is one.
  double highQuartile = 0;
  bool onFront = false;  ///< No faster one is as accurate, to 1 %.
  std::string failure;   ///< Reason why a step could not be made; empty where all were.
};

/// All settings of a method, by rising count.
struct ChartLine {
  std::string method;
  std::string scalar;
  std::string unit;  ///< "iterations" or "substeps".
  std::vector<ChartPoint> points;
  SolverKind solver = SolverKind::softStep;
  ContactPrecision precision = ContactPrecision::accurate;
  double stepsPerSecond = 60;
};

/// Speed against accuracy of one scene.
struct Chart {
  std::string scene;
  std::string kind;                  ///< One word for the CSV: exact, reference, rest or overlap.
  std::vector<std::string> measure;  ///< Meaning of error, in lines of up to 100 characters.
  /// Below it, errors say nothing: how far the reference itself may be off, m; 0 for none.
  double resolution = 0;
  /// Steps per second of the scene itself.
  double stepsPerSecond = 60;
  std::vector<ChartLine> lines;
};

/// Sets onFront of every point; a failed one is never on it.
void markFront(Chart& chart);

/// A point of the front and whose it is.
struct FrontPoint {
  const ChartLine* line;
  const ChartPoint* point;
};
/// The marked points, fastest first.
std::vector<FrontPoint> frontOf(const Chart& chart);

/// A header, then a row for each point.
std::string chartCsv(const Chart& chart);

/// The chart as SVG: time across, error up, both logarithmic, a line per method, the front marked. It brings
/// colours for light and dark pages. Bars are quartiles, crosses at the top edge what failed, a band at the
/// bottom where errors say nothing, an upright line what a step may take that has 16 ms.
std::string drawChart(const Chart& chart);

}  // namespace samestep
