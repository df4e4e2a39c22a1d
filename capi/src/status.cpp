// SPDX-License-Identifier: MIT
// What a call is refused with, in numbers, names and sentences.
#include <cstring>
#include <exception>
#include <new>

#include "base/require_ieee.h"
#include "call.h"

namespace samestep::c {
namespace {

struct Named {
  samestep_status status;
  const char* name;
  /// Null: the engine's own sentence.
  const char* sentence;
};

constexpr Named kOwn[] = {
    {SAMESTEP_OK, "OK", ""},
    {SAMESTEP_NULL_ARGUMENT, "NULL_ARGUMENT", "A pointer that must point at something is null."},
    {SAMESTEP_WRONG_VERSION, "WRONG_VERSION",
     "The version of a structure is not that of this library; its init function sets it."},
    {SAMESTEP_BUFFER_TOO_SMALL, "BUFFER_TOO_SMALL", "There is less room than what is to be written takes."},
    {SAMESTEP_OUT_OF_MEMORY, "OUT_OF_MEMORY", "There is no memory left."},
    {SAMESTEP_WRONG_SCALAR, "WRONG_SCALAR", "The two do not compute with the same scalar."},
    {SAMESTEP_SCALAR_NOT_BUILT, "SCALAR_NOT_BUILT", "This build lacks the scalar."},
    {SAMESTEP_OTHER_REVISION, "OTHER_REVISION", "The bytes are of another revision of the simulation."},
    {SAMESTEP_IN_USE, "IN_USE", "The world is in use: by a recorder, a session or the library."},
    {SAMESTEP_UNKNOWN_VALUE, "UNKNOWN_VALUE", "A number names nothing of what it is to name."},
    {SAMESTEP_INTERNAL, "INTERNAL", "Something went wrong within the library."},
};

/// The statuses of faults are these plus the fault.
constexpr samestep_status kFirstFault = SAMESTEP_ATTACHED_BODY;
constexpr const char* kFaultNames[] = {
    "ATTACHED_BODY",
    "ATTACHED_SHAPE",
    "ATTACHED_STATIC_BODY",
    "ATTACHED_STATIC_INDEX",
    "BODY_NOT_FOUND",
    "BUFFER_OVERFLOW",
    "COLLISION_CONTACT_OVERFLOW",
    "COLLISION_ERROR",
    "CONTACT_INDEX_OUT_OF_BOUNDS",
    "DUPLICATE_BODY",
    "DUPLICATE_SHAPE",
    "ILLEGAL_BODY",
    "ILLEGAL_SIZE",
    "IMMUTABLE_NUM_CONTACTS",
    "INDEX_OUT_OF_BOUNDS",
    "INFINITE_MASS",
    "INSUFFICIENT_BUFFER_SIZE",
    "INVALID_CHILD",
    "INVALID_ITER",
    "LEAF_ERROR",
    "MAIN_STATIC_BODY",
    "NAN_MASS",
    "NAN_MOMENT",
    "NEGATIVE_ELASTICITY",
    "NEGATIVE_FRICTION",
    "NEGATIVE_HALF_DIMENSIONS",
    "NEGATIVE_MASS",
    "NEGATIVE_MOMENT",
    "NEGATIVE_RADIUS",
    "NOT_CIRCLE_SHAPE",
    "NOT_SEGMENT_SHAPE",
    "NOT_POLY_SHAPE",
    "SAME_VERTICES",
    "SHAPE_NOT_FOUND",
    "SPACE_LOCKED",
    "SPACE_LOCK_UNDERFLOW",
    "STATIC_BODY_MASS",
    "UNSOLVABLE_COLLISION",
    "INFINITE_MOMENT",
    "MASS_OUT_OF_RANGE",
    "MOMENT_OUT_OF_RANGE",
    "SIZE_OUT_OF_RANGE",
    "VALUE_OUT_OF_RANGE",
    "DEGENERATE_SHAPE",
    "TOO_MANY_VERTICES",
    "BODY_HAS_SHAPES",
    "MISSING_CALLBACK",
    "FOREIGN_WORLD",
    "MALFORMED_BYTES",
    "KERNEL_UNAVAILABLE",
    "ILLEGAL_ID",
    "UNSOUND_ARITHMETIC",
    "TOO_MANY_PAIRS",
    "INTERRUPTED",
    "LEFT_MIDWAY",
    "JOINT_NOT_FOUND",
    "ILLEGAL_JOINT",
};
constexpr samestep_status kFaultCount = std::size(kFaultNames);

constexpr bool isStatus(Fault fault, samestep_status status) {
  return kFirstFault + static_cast<samestep_status>(fault) == status;
}
static_assert(isStatus(Fault::BodyNotFound, SAMESTEP_BODY_NOT_FOUND));
static_assert(isStatus(Fault::IllegalBody, SAMESTEP_ILLEGAL_BODY));
static_assert(isStatus(Fault::MainStaticBody, SAMESTEP_MAIN_STATIC_BODY));
static_assert(isStatus(Fault::ShapeNotFound, SAMESTEP_SHAPE_NOT_FOUND));
static_assert(isStatus(Fault::UnsolvableCollision, SAMESTEP_UNSOLVABLE_COLLISION));
static_assert(isStatus(Fault::ValueOutOfRange, SAMESTEP_VALUE_OUT_OF_RANGE));
static_assert(isStatus(Fault::BodyHasShapes, SAMESTEP_BODY_HAS_SHAPES));
static_assert(isStatus(Fault::MalformedBytes, SAMESTEP_MALFORMED_BYTES));
static_assert(isStatus(Fault::TooManyPairs, SAMESTEP_TOO_MANY_PAIRS));
static_assert(isStatus(Fault::LeftMidway, SAMESTEP_LEFT_MIDWAY));
static_assert(isStatus(Fault::IllegalJoint, SAMESTEP_ILLEGAL_JOINT));
// Each fault has its name here and its number in the header.
static_assert(std::size(kFaultNames) == kFaults);

bool isFault(samestep_status status) { return status >= kFirstFault && status - kFirstFault < kFaultCount; }

/// The last sentence of calls for no world.
thread_local char threadMessage[sizeof samestep_world::message] = "";

/// A message as it fits, cut off at its end.
template <std::size_t kRoom>
void copyMessage(const char* message, char (&to)[kRoom]) {
  const std::size_t length = min<std::size_t>(std::strlen(message), kRoom - 1);
  std::memmove(to, message, length);
  to[length] = '\0';
}

}  // namespace

const char* lastMessageOfThread() noexcept { return threadMessage; }

samestep_status refused(const samestep_world* world, samestep_status status, const char* message) noexcept {
  if (world == nullptr) {
    copyMessage(message, threadMessage);
    return status;
  }
  copyMessage(message, world->message);
  if (world->failure != nullptr) world->failure(status, world->message, world->failureData);
  return status;
}

samestep_status caught(const samestep_world* world) noexcept {
  try {
    throw;
  } catch (const Refusal& refusal) {
    return refused(world, refusal.status, samestep_status_message(refusal.status));
  } catch (const InputRefused& error) {
    return refused(world, error.status(), error.what());
  } catch (const RevisionError& error) {
    return refused(world, SAMESTEP_OTHER_REVISION, error.what());
  } catch (const Error& error) {
    return refused(world, kFirstFault + static_cast<samestep_status>(error.fault()), error.what());
  } catch (const std::bad_alloc&) {
    return refused(world, SAMESTEP_OUT_OF_MEMORY, samestep_status_message(SAMESTEP_OUT_OF_MEMORY));
  } catch (const std::exception& error) {
    return refused(world, SAMESTEP_INTERNAL, error.what());
  } catch (...) {
    return refused(world, SAMESTEP_INTERNAL, samestep_status_message(SAMESTEP_INTERNAL));
  }
}

}  // namespace samestep::c

extern "C" {

const char* samestep_status_name(samestep_status status) {
  using namespace samestep::c;
  if (isFault(status)) return kFaultNames[status - kFirstFault];
  for (const Named& own : kOwn) {
    if (own.status == status) return own.name;
  }
  return "UNKNOWN";
}

const char* samestep_status_message(samestep_status status) {
  using namespace samestep::c;
  if (isFault(status)) return samestep::message(static_cast<samestep::Fault>(status - kFirstFault));
  for (const Named& own : kOwn) {
    if (own.status == status) return own.sentence;
  }
  return "This number is no status.";
}

const char* samestep_last_message(const samestep_world* world) {
  return world == nullptr ? samestep::c::lastMessageOfThread() : world->message;
}

}  // extern "C"
