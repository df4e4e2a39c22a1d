// SPDX-License-Identifier: MIT
#pragma once

namespace samestep {

/// Function that is asked, now and then, whether a long call shall end: by default none.
struct Interrupt {
  /// True ends it. It must not call anything of what it is asked about, and not throw.
  bool (*wanted)(void* data) = nullptr;
  void* data = nullptr;

  bool isWanted() const { return wanted != nullptr && wanted(data); }
};

}  // namespace samestep
