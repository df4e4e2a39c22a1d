// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/error.h>

namespace samestep::lockstep {

/// True if bytes from outside were taken by an action on them. A build without exceptions ends where they are
/// refused.
template <class Action>
bool isTaken(Action&& action) {
#if defined(__cpp_exceptions)
  try {
    const FailuresAreCaught caught;
    action();
  } catch (const Error&) {
    return false;
  }
#else
  action();
#endif
  return true;
}

}  // namespace samestep::lockstep
