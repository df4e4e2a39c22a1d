// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <exception>

namespace samestep {

/// Every way a call can be refused: the exceptions of the MIS first, in its order, then our own.
enum class Fault : std::uint8_t {
  AttachedBody,
  AttachedShape,
  AttachedStaticBody,
  AttachedStaticIndex,
  BodyNotFound,
  BufferOverflow,
  CollisionContactOverflow,
  CollisionError,
  ContactIndexOutOfBounds,
  DuplicateBody,
  DuplicateShape,
  IllegalBody,
  IllegalSize,
  ImmutableNumContacts,
  IndexOutOfBounds,
  InfiniteMass,
  InsufficientBufferSize,
  InvalidChild,
  InvalidIter,
  LeafError,
  MainStaticBody,
  NaNMass,
  NaNMoment,
  NegativeElasticity,
  NegativeFriction,
  NegativeHalfDimensions,
  NegativeMass,
  NegativeMoment,
  NegativeRadius,
  NotCircleShape,
  NotSegmentShape,
  NotPolyShape,
  SameVertices,
  ShapeNotFound,
  SpaceLocked,
  SpaceLockUnderflow,
  StaticBodyMass,
  UnsolvableCollision,
  // Beyond the MIS.
  InfiniteMoment,    ///< A moment of inertia that is infinite; see Body::nonRotating.
  MassOutOfRange,    ///< A mass outside [1e-3, 1e6] kg that is not 0.
  MomentOutOfRange,  ///< A moment of inertia outside the supported range that is not 0.
  SizeOutOfRange,    ///< A length of a shape outside the supported range.
  ValueOutOfRange,   ///< Any other number that is not finite or outside its documented range.
  DegenerateShape,  ///< A polygon without area, with too few points or not convex; a segment that is a point.
  TooManyVertices,  ///< A polygon with more vertices than kMaxPolyVertices.
  BodyHasShapes,    ///< Removing a body that still has shapes.
  MissingCallback,  ///< A callback number without a registered function.
  ForeignWorld,     ///< A saved state of another kind of world.
  MalformedBytes,   ///< Bytes from outside that are not what they should be; see FormatError.
  KernelUnavailable,  ///< A forced kernel that was not built or that this processor cannot run.
  IllegalId,          ///< An id that the caller gives to a new object and that its slot cannot have any more.
  UnsoundArithmetic,  ///< The processor is in a mode in which double gives other results.
  TooManyPairs,       ///< More shapes near each other than a Space may hold as pairs.
  Interrupted,        ///< A call that was to end, see Space::setInterrupt, or may do no more work.
  LeftMidway,  ///< The world of a Space in which an exception ended a change midway; see Space::isUsable.
};

/// The sentence a user reads: the MIS's own where it has one. MIS: message
const char* message(Fault fault);

/// Base of everything the engine throws for a caller's mistake.
class Error : public std::exception {
 public:
  Error(Fault fault, const char* text) : fault_(fault), text_(text) {}
  Fault fault() const { return fault_; }
  const char* what() const noexcept override { return text_; }

 private:
  Fault fault_;
  const char* text_;
};

/// The exception type of one fault: catch (const NegativeMass&).
template <Fault F>
class FaultError : public Error {
 public:
  explicit FaultError(const char* text = message(F)) : Error(F, text) {}
};

using AttachedBody = FaultError<Fault::AttachedBody>;
using AttachedShape = FaultError<Fault::AttachedShape>;
using AttachedStaticBody = FaultError<Fault::AttachedStaticBody>;
using AttachedStaticIndex = FaultError<Fault::AttachedStaticIndex>;
using BodyNotFound = FaultError<Fault::BodyNotFound>;
using BufferOverflow = FaultError<Fault::BufferOverflow>;
using CollisionContactOverflow = FaultError<Fault::CollisionContactOverflow>;
using CollisionError = FaultError<Fault::CollisionError>;
using ContactIndexOutOfBounds = FaultError<Fault::ContactIndexOutOfBounds>;
using DuplicateBody = FaultError<Fault::DuplicateBody>;
using DuplicateShape = FaultError<Fault::DuplicateShape>;
using IllegalBody = FaultError<Fault::IllegalBody>;
using IllegalSize = FaultError<Fault::IllegalSize>;
using ImmutableNumContacts = FaultError<Fault::ImmutableNumContacts>;
using IndexOutOfBounds = FaultError<Fault::IndexOutOfBounds>;
using InfiniteMass = FaultError<Fault::InfiniteMass>;
using InsufficientBufferSize = FaultError<Fault::InsufficientBufferSize>;
using InvalidChild = FaultError<Fault::InvalidChild>;
using InvalidIter = FaultError<Fault::InvalidIter>;
using LeafError = FaultError<Fault::LeafError>;
using MainStaticBody = FaultError<Fault::MainStaticBody>;
using NaNMass = FaultError<Fault::NaNMass>;
using NaNMoment = FaultError<Fault::NaNMoment>;
using NegativeElasticity = FaultError<Fault::NegativeElasticity>;
using NegativeFriction = FaultError<Fault::NegativeFriction>;
using NegativeHalfDimensions = FaultError<Fault::NegativeHalfDimensions>;
using NegativeMass = FaultError<Fault::NegativeMass>;
using NegativeMoment = FaultError<Fault::NegativeMoment>;
using NegativeRadius = FaultError<Fault::NegativeRadius>;
using NotCircleShape = FaultError<Fault::NotCircleShape>;
using NotSegmentShape = FaultError<Fault::NotSegmentShape>;
using NotPolyShape = FaultError<Fault::NotPolyShape>;
using SameVertices = FaultError<Fault::SameVertices>;
using ShapeNotFound = FaultError<Fault::ShapeNotFound>;
using SpaceLocked = FaultError<Fault::SpaceLocked>;
using SpaceLockUnderflow = FaultError<Fault::SpaceLockUnderflow>;
using StaticBodyMass = FaultError<Fault::StaticBodyMass>;
using UnsolvableCollision = FaultError<Fault::UnsolvableCollision>;
using InfiniteMoment = FaultError<Fault::InfiniteMoment>;
using MassOutOfRange = FaultError<Fault::MassOutOfRange>;
using MomentOutOfRange = FaultError<Fault::MomentOutOfRange>;
using SizeOutOfRange = FaultError<Fault::SizeOutOfRange>;
using ValueOutOfRange = FaultError<Fault::ValueOutOfRange>;
using DegenerateShape = FaultError<Fault::DegenerateShape>;
using TooManyVertices = FaultError<Fault::TooManyVertices>;
using BodyHasShapes = FaultError<Fault::BodyHasShapes>;
using MissingCallback = FaultError<Fault::MissingCallback>;
using ForeignWorld = FaultError<Fault::ForeignWorld>;
using MalformedBytes = FaultError<Fault::MalformedBytes>;
using KernelUnavailable = FaultError<Fault::KernelUnavailable>;
using IllegalId = FaultError<Fault::IllegalId>;
using UnsoundArithmetic = FaultError<Fault::UnsoundArithmetic>;
using TooManyPairs = FaultError<Fault::TooManyPairs>;
using Interrupted = FaultError<Fault::Interrupted>;
using LeftMidway = FaultError<Fault::LeftMidway>;

/// Bytes from outside that cannot be used: where and why. Nothing has been changed by then.
class FormatError : public MalformedBytes {
 public:
  FormatError(std::uint64_t offset, const char* reason) : MalformedBytes(reason), offset_(offset) {}
  /// Of the first byte of what is wrong.
  std::uint64_t offset() const { return offset_; }

 private:
  std::uint64_t offset_;
};

/// Bytes of another revision of the simulation, whose results differ. The text names both.
class RevisionError : public FormatError {
 public:
  RevisionError(std::uint64_t offset, std::uint32_t found, std::uint32_t own);
  const char* what() const noexcept override { return text_; }
  /// Of the build that made the bytes.
  std::uint32_t found() const { return found_; }
  /// Of this build.
  std::uint32_t own() const { return own_; }

 private:
  std::uint32_t found_;
  std::uint32_t own_;
  char text_[112];
};

[[noreturn]] void failWithoutExceptions(Fault fault, const char* text);

/// Throws the exception of a fault, with the MIS's sentence or a more specific one that lives for ever. In a
/// build without exceptions calls the failure handler, then aborts.
template <Fault F>
[[noreturn]] void fail(const char* text = message(F)) {
#if defined(__cpp_exceptions)
  throw FaultError<F>(text);
#else
  failWithoutExceptions(F, text);
#endif
}

/// Refuses the call unless the condition holds. Called before anything changes. MIS: assertHard, assertSoft
template <Fault F>
[[gnu::always_inline]] inline constexpr void require(bool condition) {
  if (!condition) [[unlikely]]
    fail<F>();
}
template <Fault F>
[[gnu::always_inline]] inline constexpr void require(bool condition, const char* text) {
  if (!condition) [[unlikely]]
    fail<F>(text);
}

/// Throws a FormatError, as fail does.
/// @param reason  lives for ever
[[noreturn]] inline void failFormat(std::uint64_t offset, const char* reason) {
#if defined(__cpp_exceptions)
  throw FormatError(offset, reason);
#else
  static_cast<void>(offset);
  failWithoutExceptions(Fault::MalformedBytes, reason);
#endif
}

/// Throws a RevisionError, as fail does.
[[noreturn]] void failRevision(std::uint64_t offset, std::uint32_t found, std::uint32_t own);

/// Runs an action on bytes from outside: what the engine refuses is the fault of those at `offset`, but not a
/// missing callback, nor that the caller wants it to end.
template <class Action>
void orFailFormat(std::uint64_t offset, Action&& action) {
#if defined(__cpp_exceptions)
  try {
    action();
  } catch (const MissingCallback&) {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    failFormat(offset, error.what());
  }
#else
  static_cast<void>(offset);
  action();
#endif
}

/// Called with the fault before a build without exceptions aborts. Default: none.
using FailureHandler = void (*)(Fault, const char* text);
void setFailureHandler(FailureHandler handler);

}  // namespace samestep
