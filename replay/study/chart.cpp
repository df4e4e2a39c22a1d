// SPDX-License-Identifier: MIT
#include "study/chart.h"

#include <algorithm>
#include <cstdio>

#include "base/require_ieee.h"

namespace samestep {
namespace {

/// A slower setting has to be so many times as accurate to be worth its time.
constexpr double kNoticeable = 1.01;

/// A field of a CSV file.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + "\"";
}

}  // namespace

void markFront(Chart& chart) {
  std::vector<ChartPoint*> points;
  for (ChartLine& line : chart.lines) {
    for (ChartPoint& point : line.points) {
      point.onFront = false;
      if (point.failure.empty()) points.push_back(&point);
    }
  }
  std::stable_sort(points.begin(), points.end(), [](const ChartPoint* a, const ChartPoint* b) {
    return a->milliseconds != b->milliseconds ? a->milliseconds < b->milliseconds : a->error < b->error;
  });
  const ChartPoint* best = nullptr;
  for (ChartPoint* point : points) {
    point->onFront = best == nullptr || point->error * kNoticeable < best->error;
    if (point->onFront) best = point;
  }
}

std::vector<FrontPoint> frontOf(const Chart& chart) {
  std::vector<FrontPoint> front;
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) {
      if (point.onFront) front.push_back({&line, &point});
    }
  }
  std::stable_sort(front.begin(), front.end(), [](const FrontPoint& a, const FrontPoint& b) {
    return a.point->milliseconds < b.point->milliseconds;
  });
  return front;
}

std::string chartCsv(const Chart& chart) {
  std::string out =
      "scene,method,scalar,steps_per_second,unit,count,ms_per_second,ms_fastest,ms_slowest,error_m,"
      "low_quartile_m,high_quartile_m,overlap_m,drift_m,error_kind,on_front,failure\n";
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) {
      char numbers[240];
      std::snprintf(numbers, sizeof numbers, "%d,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g", point.count,
                    point.milliseconds, point.fastest, point.slowest, point.error, point.lowQuartile,
                    point.highQuartile, point.overlap, point.drift);
      char rate[32];
      std::snprintf(rate, sizeof rate, "%.6g", line.stepsPerSecond);
      out += quoted(chart.scene) + "," + line.method + "," + line.scalar + "," + rate + "," + line.unit +
             "," + numbers + "," + chart.kind + "," + (point.onFront ? "yes" : "no") + "," +
             quoted(point.failure) + "\n";
    }
  }
  return out;
}

}  // namespace samestep
