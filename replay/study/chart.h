// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace samestep {

/// One setting of a method: how long a step takes and how far its result is off.
struct ChartPoint {
  int count = 0;            ///< Iterations or substeps.
  double milliseconds = 0;  ///< Per step, the median of the rounds.
  double fastest = 0;       ///< Time of the fastest round, ms per step.
  double slowest = 0;
  double error = 0;    ///< m; what it is of, Chart::measure says.
  double overlap = 0;  ///< Overlap that error is the sum of, in kinds rest and overlap, m.
  double drift = 0;
  bool onFront = false;  ///< No faster one is as accurate, to 1 %.
};

/// All settings of a method, by rising count.
struct ChartLine {
  std::string method;
  std::string scalar;
  std::string unit;  ///< "iterations" or "substeps".
  std::vector<ChartPoint> points;
};

/// Speed against accuracy of one scene.
struct Chart {
  std::string scene;
  std::string kind;                  ///< One word for the CSV: exact, reference, rest or overlap.
  std::vector<std::string> measure;  ///< Meaning of error, in lines of up to 100 characters.
  /// Below it, errors say nothing: how far the reference itself may be off, m; 0 for none.
  double resolution = 0;
  std::vector<ChartLine> lines;
};

/// Sets onFront of every point.
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
/// colours for light and dark pages.
std::string drawChart(const Chart& chart);

}  // namespace samestep
