// SPDX-License-Identifier: MIT
#include "study/tune.h"

#include <cstdio>
#include <stdexcept>
#include <tuple>

#include <nlohmann/json.hpp>

#include "base/require_ieee.h"

namespace samestep {
namespace {

void requireBound(const char* what, double bound) {
  if (bound >= 0 && bound < 1e300) return;
  throw std::invalid_argument(std::string(what) + " is no positive number");
}

template <class Visit>
void eachPoint(const Chart& chart, Visit&& visit) {
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) {
      if (point.failure.empty()) visit(FrontPoint{&line, &point});
    }
  }
}

/// Smaller is better: what is beyond the goal, then what is asked for, then the rest.
std::tuple<double, double, double> rankOf(const Chart& chart, const TuneGoal& goal, const FrontPoint& at) {
  const double error = at.point->error;
  const double time = millisecondsPerStep(chart, *at.point);
  double beyond = 0;
  if (goal.error > 0 && error > goal.error) beyond += error / goal.error;
  if (goal.budget > 0 && time > goal.budget) beyond += time / goal.budget;
  if (goal.error > 0) return {beyond, time, error};
  return {beyond, error, time};
}

FrontPoint usualOf(const Chart& chart, const FrontPoint& beside) {
  const Settings<double> usual;
  FrontPoint found{};
  eachPoint(chart, [&](const FrontPoint& at) {
    const ChartLine& line = *at.line;
    const int count = usual.solver == SolverKind::softStep ? usual.substeps : usual.iterations;
    if (found.point == nullptr && line.scalar == beside.line->scalar && line.solver == usual.solver &&
        line.precision == usual.precision && line.stepsPerSecond == chart.stepsPerSecond &&
        at.point->count == count) {
      found = at;
    }
  });
  return found;
}

}  // namespace

double millisecondsPerStep(const Chart& chart, const ChartPoint& point) {
  return point.milliseconds / chart.stepsPerSecond;
}

Tuned tune(const Chart& chart, const TuneGoal& goal) {
  requireBound("the greatest error", goal.error);
  requireBound("the budget", goal.budget);
  if (goal.error == 0 && goal.budget == 0) throw std::invalid_argument("a goal needs an error or a budget");
  FrontPoint best{};
  eachPoint(chart, [&](const FrontPoint& at) {
    if (best.point == nullptr || rankOf(chart, goal, at) < rankOf(chart, goal, best)) best = at;
  });
  Tuned tuned;
  if (best.point == nullptr) return tuned;
  (std::get<0>(rankOf(chart, goal, best)) == 0 ? tuned.found : tuned.nearest) = best;
  tuned.usual = usualOf(chart, best);
  return tuned;
}

std::string settingsJson(const Chart& chart, const FrontPoint& at) {
  const ChartLine& line = *at.line;
  const bool soft = line.solver == SolverKind::softStep;
  nlohmann::ordered_json settings{{"solver", soft ? "soft step" : "sequential impulses"}};
  if (soft) settings["precision"] = line.precision == ContactPrecision::fast ? "fast" : "accurate";
  settings[soft ? "substeps" : "iterations"] = at.point->count;
  const nlohmann::ordered_json document{{"scalar", line.scalar},
                                        {"stepsPerSecond", static_cast<int>(line.stepsPerSecond + 0.5)},
                                        {"settings", settings},
                                        {"evidence",
                                         {{"scene", chart.scene},
                                          {"kind", chart.kind},
                                          {"error_m", at.point->error},
                                          {"resolution_m", chart.resolution},
                                          {"ms_per_step", millisecondsPerStep(chart, *at.point)},
                                          {"ms_per_second", at.point->milliseconds}}}};
  return document.dump(2) + "\n";
}

}  // namespace samestep
