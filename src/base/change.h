// SPDX-License-Identifier: MIT
#pragma once

namespace samestep {

/// Stands where a world changes by parts. Where an exception ends that midway, the world is marked: nothing
/// it says would be worth anything.
class Change {
 public:
  /// @param leftMidway  the mark of the world
  explicit Change(bool& leftMidway) : leftMidway_(leftMidway) {}
  ~Change() {
    if (!done_) leftMidway_ = true;
  }
  Change(const Change&) = delete;
  Change& operator=(const Change&) = delete;

  void done() { done_ = true; }

 private:
  bool& leftMidway_;
  bool done_ = false;
};

}  // namespace samestep
