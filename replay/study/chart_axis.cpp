// SPDX-License-Identifier: MIT
#include "study/chart_axis.h"

#include <algorithm>
#include <cstdio>

#include <samestep/scalar.h>

#include "base/require_ieee.h"

namespace samestep {
namespace {

constexpr double kRoom = 0.06;
constexpr double kLeastDecades = 0.5;

/// 0.001, 20, 5e-7.
std::string label(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value < 0.9e-4 || value > 1.1e5 ? "%.0e" : "%g", value);
  std::string written = text;
  // 1e-07: the exponent without its zero.
  const std::string::size_type zero = written.find("e-0");
  if (zero != std::string::npos) written.erase(zero + 2, 1);
  return written;
}

double powerOfTen(int exponent) {
  double power = 1;
  for (; exponent > 0; --exponent) power *= 10;
  for (; exponent < 0; ++exponent) power /= 10;
  return power;
}

}  // namespace

double decimalLog(double x) {
  int exponent = 0;
  for (; x >= 10; x /= 10) ++exponent;
  for (; x < 1; x *= 10) --exponent;
  constexpr double kLogOfTwo = 0.30102999566398119521;
  return exponent + static_cast<double>(log2(Fixed(x))) * kLogOfTwo;
}

LogAxis::LogAxis(double low, double high) : low_(decimalLog(low)), high_(decimalLog(high)) {
  const double middle = (low_ + high_) / 2;
  const double half = std::max(high_ - low_, kLeastDecades) / 2 * (1 + 2 * kRoom);
  low_ = middle - half;
  high_ = middle + half;
  const int first = static_cast<int>(low_) - 1;
  const int last = static_cast<int>(high_) + 1;
  for (int exponent = first; exponent <= last; ++exponent) {
    for (int factor = 1; factor < 10; ++factor) {
      const double value = factor * powerOfTen(exponent);
      const double where = decimalLog(value);
      if (where >= low_ && where <= high_) ticks_.push_back({value, factor, {}});
    }
  }
  writeLabels();
}

void LogAxis::writeLabels() {
  // The multiples of powers of ten that get labels: the first set of which enough are on the axis.
  constexpr int kSets[][5] = {{1}, {1, 2, 5}, {1, 2, 3, 5, 7}};
  constexpr int kEnough = 3;
  int labels = 0;
  for (const auto& set : kSets) {
    if (labels >= kEnough) return;
    labels = 0;
    for (Tick& tick : ticks_) {
      const bool chosen = std::find(std::begin(set), std::end(set), tick.factor) != std::end(set);
      if (chosen) tick.label = label(tick.value);
      labels += chosen ? 1 : 0;
    }
  }
}

double LogAxis::place(double value) const {
  if (!(value > 0)) return 0;
  return std::clamp((decimalLog(value) - low_) / (high_ - low_), 0.0, 1.0);
}

}  // namespace samestep
