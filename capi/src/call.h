// SPDX-License-Identifier: MIT
#pragma once

#include "world_of.h"

namespace samestep::c {

/// Refusal of this interface by itself.
struct Refusal {
  samestep_status status;
};

/// Refusal of the caller's input function: to a replay a fault of the bytes, as any other of the engine.
class InputRefused : public Error {
 public:
  explicit InputRefused(samestep_status status)
      : Error(Fault::ValueOutOfRange, {samestep_status_message(status)}), status_(status) {}
  samestep_status status() const { return status_; }

 private:
  samestep_status status_;
};

[[noreturn]] inline void refuse(samestep_status status) { throw Refusal{status}; }
inline void requireOr(bool condition, samestep_status status) {
  if (!condition) refuse(status);
}
/// Returns the thing a pointer points at.
template <class T>
T& at(T* pointer) {
  requireOr(pointer != nullptr, SAMESTEP_NULL_ARGUMENT);
  return *pointer;
}
/// A definition of this version.
template <class Definition>
const Definition& current(const Definition* definition) {
  requireOr(at(definition).version == SAMESTEP_C_VERSION, SAMESTEP_WRONG_VERSION);
  return *definition;
}

/// Notes why a call was refused, for a world or, where that is null, for this thread, and tells the hook.
samestep_status refused(const samestep_world* world, samestep_status status, const char* message) noexcept;
/// Handles the exception under way.
samestep_status caught(const samestep_world* world) noexcept;
const char* lastMessageOfThread() noexcept;

/// Runs an action that is for no world. Nothing leaves it.
template <class Action>
samestep_status callFree(Action&& action) noexcept {
  try {
    const FailuresAreCaught failuresAreCaught;
    action();
    return SAMESTEP_OK;
  } catch (...) {
    return caught(nullptr);
  }
}

/// A world as that of its scalar; const stays const.
template <Scalar S, class World>
auto& as(World& world) {
  if constexpr (std::is_const_v<World>) {
    return static_cast<const WorldOf<S>&>(world);
  } else {
    return static_cast<WorldOf<S>&>(world);
  }
}

/// Runs an action on a world as that of its scalar. Nothing leaves it.
template <class World, class Action>
samestep_status call(World* world, Action&& action) noexcept {
  try {
    const FailuresAreCaught failuresAreCaught;
    at(world);
#ifndef SAMESTEP_FIXED_ONLY
    if (world->scalar == ScalarKind::float64) {
      action(as<double>(*world));
      return SAMESTEP_OK;
    }
#endif
#ifndef SAMESTEP_C_DOUBLE_ONLY
    action(as<Fixed>(*world));
#endif
    return SAMESTEP_OK;
  } catch (...) {
    return caught(world);
  }
}

/// Calls of a recorder or session that are under way: functions of the caller's may run in them, and may ask
/// for its end.
struct Calls {
  std::int32_t underWay = 0;
  bool ending = false;
};

/// Ends what is used at once or, from within a call of it, when that returns.
template <class Used>
void endAfterCalls(Used* used) {
  if (used != nullptr && used->calls.underWay > 0) {
    used->calls.ending = true;
  } else {
    delete used;
  }
}

/// Notes that a call of a recorder or session is under way.
template <class Used>
class InCall {
 public:
  explicit InCall(Used& used) : used_(used) { ++used_.calls.underWay; }
  ~InCall() {
    if (--used_.calls.underWay == 0 && used_.calls.ending) delete &used_;
  }
  InCall(const InCall&) = delete;
  InCall& operator=(const InCall&) = delete;

 private:
  Used& used_;
};

/// Runs action(a number of the scalar's type). SAMESTEP_FIXED_ONLY leaves double out, SAMESTEP_C_DOUBLE_ONLY
/// Fixed.
/// @throws Refusal
template <class Action>
void forScalar(std::int32_t scalar, Action&& action) {
#ifdef SAMESTEP_C_DOUBLE_ONLY
  requireOr(scalar != SAMESTEP_FIXED, SAMESTEP_SCALAR_NOT_BUILT);
#else
  if (scalar == SAMESTEP_FIXED) return action(Fixed());
#endif
  requireOr(scalar == SAMESTEP_DOUBLE, SAMESTEP_UNKNOWN_VALUE);
#ifdef SAMESTEP_FIXED_ONLY
  refuse(SAMESTEP_SCALAR_NOT_BUILT);
#else
  action(double());
#endif
}

/// Gives out an array.
template <class T>
void give(const std::vector<T>& array, const T** items, std::size_t* count) {
  *items = array.data();
  *count = array.size();
}

/// The size of what is to be written, or the refusal where it has no room.
inline void giveSize(std::uint64_t needed, const void* into, std::size_t capacity, std::size_t* size) {
  *size = static_cast<std::size_t>(needed);
  requireOr(into != nullptr || capacity == 0, SAMESTEP_NULL_ARGUMENT);
  if (into != nullptr || capacity != 0) requireOr(capacity >= needed, SAMESTEP_BUFFER_TOO_SMALL);
}

}  // namespace samestep::c
