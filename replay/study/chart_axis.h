// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace samestep {

/// The decimal logarithm of x > 0, to 2^-30.
double decimalLog(double x);

/// A logarithmic axis that holds a range of values with a little room on both sides.
class LogAxis {
 public:
  struct Tick {
    double value = 0;
    int factor = 1;     ///< The value is this, 1 to 9, times a power of ten.
    std::string label;  ///< Empty for the lines between.
  };

  /// @param low, high  0 < low <= high
  LogAxis(double low, double high);

  /// Place of a value: 0 at the low end of the axis, 1 at the high end; held within them.
  double place(double value) const;
  /// 1 to 9 times powers of ten, by rising value. Powers of ten have labels; where that makes fewer than
  /// three, also 2 and 5 times them; where that is too few still, 3 and 7 times.
  const std::vector<Tick>& ticks() const { return ticks_; }

 private:
  void writeLabels();

  double low_;  ///< Logarithms of the ends.
  double high_;
  std::vector<Tick> ticks_;
};

}  // namespace samestep
