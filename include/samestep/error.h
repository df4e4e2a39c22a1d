// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <initializer_list>

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
  // The following go beyond the MIS.
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
  LeftMidway,     ///< The world of a Space in which an exception ended a change midway; see Space::isUsable.
  JointNotFound,  ///< A joint id that names nothing.
  IllegalJoint,   ///< A joint with a number out of range, or of a body with itself.
};

/// Number of faults.
inline constexpr std::size_t kFaults = static_cast<std::size_t>(Fault::IllegalJoint) + 1;

/// The sentence of a fault that is told without values: the MIS's own where it has one. MIS: message
const char* message(Fault fault);

/// Part of the text of an error: a text that lives as long as the expression it stands in, a number, a vector
/// or an id. Numbers are written as formatDecimal does, the same on every machine.
class ErrorPart {
 public:
  ErrorPart(const char* text) noexcept : kind_(Kind::text), text_(text) {}
  template <std::integral T>
  ErrorPart(T number) noexcept
      : kind_(number < T(0) ? Kind::negative : Kind::natural),
        x_(static_cast<std::int64_t>(number < T(0) ? 0 - static_cast<std::uint64_t>(number)
                                                   : static_cast<std::uint64_t>(number))) {}
#ifndef SAMESTEP_FIXED_ONLY
  ErrorPart(double number) noexcept : kind_(Kind::number), x_(bitsOf(number)) {}
#endif
  /// Takes a fixed-point number.
  template <class T>
  requires requires(const T& x) {
    x.raw();
    T::kBits;
  }
  ErrorPart(const T& x) noexcept : kind_(Kind::number), fractionBits_(T::kBits), x_(x.raw()) {}
  /// Takes a vector: "(x, y)".
  template <class T>
  requires requires(const T& v) {
    v.x;
    v.y;
  }
  ErrorPart(const T& v) noexcept : ErrorPart(v.x) {
    kind_ = Kind::vector;
    y_ = ErrorPart(v.y).x_;
  }
  /// Takes an id: "3 (generation 1)", or "none".
  template <class T>
  requires requires(const T& id) {
    id.index;
    id.generation;
  }
  ErrorPart(const T& id) noexcept
      : kind_(id.valid() ? Kind::id : Kind::noId), x_(id.index), y_(id.generation) {}

  /// Writes it, as far as there is room; where it ended.
  char* write(char* to, const char* end) const noexcept;

 private:
  enum class Kind : std::uint8_t { text, negative, natural, number, vector, id, noId };

  static std::int64_t bitsOf(double number) noexcept { return __builtin_bit_cast(std::int64_t, number); }
  char* writeNumber(char* to, const char* end, std::int64_t bits) const noexcept;

  Kind kind_;
  int fractionBits_ = -1;  // Fraction bits of a fixed-point number.
  const char* text_ = nullptr;
  std::int64_t x_ = 0;
  std::int64_t y_ = 0;
};

/// Base of everything the engine throws for a caller's mistake. It has its text in itself, up to 255 bytes:
/// what() holds as long as the error, and making one takes no memory and throws nothing.
class Error : public std::exception {
 public:
  /// Bytes the text of an error has at most, its end included.
  static constexpr std::size_t kTextBytes = 256;

  Error(Fault fault, std::initializer_list<ErrorPart> text) noexcept;
  Fault fault() const { return fault_; }
  /// Text that says what was asked for, with which value, and what is allowed.
  const char* what() const noexcept override { return text_; }

 private:
  Fault fault_;
  char text_[kTextBytes];
};

/// The exception type of one fault: catch (const NegativeMass&).
template <Fault F>
class FaultError : public Error {
 public:
  explicit FaultError(const char* text = message(F)) noexcept : Error(F, {text}) {}
  explicit FaultError(std::initializer_list<ErrorPart> text) noexcept : Error(F, text) {}
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
using JointNotFound = FaultError<Fault::JointNotFound>;
using IllegalJoint = FaultError<Fault::IllegalJoint>;

/// Bytes from outside that cannot be used: where and why. Nothing has been changed by then.
class FormatError : public MalformedBytes {
 public:
  FormatError(std::uint64_t offset, const char* reason) noexcept : MalformedBytes(reason), offset_(offset) {}
  FormatError(std::uint64_t offset, std::initializer_list<ErrorPart> reason) noexcept
      : MalformedBytes(reason), offset_(offset) {}
  /// Offset of the first byte of what is wrong.
  std::uint64_t offset() const { return offset_; }

 private:
  std::uint64_t offset_;
};

/// Bytes of another revision of the simulation, whose results differ. The text names both.
class RevisionError : public FormatError {
 public:
  RevisionError(std::uint64_t offset, std::uint32_t found, std::uint32_t own) noexcept;
  /// Revision of the build that made the bytes.
  std::uint32_t found() const { return found_; }
  /// Revision of this build.
  std::uint32_t own() const { return own_; }

 private:
  std::uint32_t found_;
  std::uint32_t own_;
};

/// Asks the failure handler, then throws the exception of a fault; in a library built without exceptions it
/// aborts. How the caller is built makes no difference.
[[noreturn]] void failAs(Fault fault, std::initializer_list<ErrorPart> text);
[[noreturn]] void failAs(Fault fault);
/// Asks the failure handler, then aborts.
[[noreturn]] void failWithoutExceptions(Fault fault, const char* text);

/// Refuses a call, with the sentence of the fault or a text of parts: see failAs.
template <Fault F>
[[noreturn]] void fail() {
  failAs(F);
}
template <Fault F, class... Parts>
[[noreturn, gnu::noinline, gnu::cold]] void fail(const Parts&... parts) {
  failAs(F, {ErrorPart(parts)...});
}

/// Refuses the call unless the condition holds. Called before anything changes. MIS: assertHard, assertSoft
template <Fault F>
[[gnu::always_inline]] inline constexpr void require(bool condition) {
  if (!condition) [[unlikely]]
    fail<F>();
}
/// @param parts  of what the error says
template <Fault F, class... Parts>
[[gnu::always_inline]] inline constexpr void require(bool condition, const Parts&... parts) {
  if (!condition) [[unlikely]]
    fail<F>(parts...);
}

/// Throws a FormatError, as failAs does.
[[noreturn]] void failFormat(std::uint64_t offset, const char* reason);

/// Throws a RevisionError, as failAs does.
[[noreturn]] void failRevision(std::uint64_t offset, std::uint32_t found, std::uint32_t own);

/// Failure handler: it is called with the fault before anything is thrown, or before a library without
/// exceptions aborts; its text lasts as long as the call. A game built without exceptions gets no other
/// chance: what is thrown ends it. What the library catches itself, as while it reads bytes, is told once, as
/// what it becomes. Default: none.
using FailureHandler = void (*)(Fault, const char* text);
void setFailureHandler(FailureHandler handler);

/// Tells, while it lives, that somebody catches this thread's failures: the failure handler is not asked.
class FailuresAreCaught {
 public:
  FailuresAreCaught() noexcept;
  ~FailuresAreCaught();
  FailuresAreCaught(const FailuresAreCaught&) = delete;
  FailuresAreCaught& operator=(const FailuresAreCaught&) = delete;
};

/// Runs an action on bytes from outside: what the engine refuses is the fault of those at `offset`, but not a
/// missing callback, nor that the caller wants it to end.
template <class Action>
void orFailFormat(std::uint64_t offset, Action&& action) {
#if defined(__cpp_exceptions)
  try {
    const FailuresAreCaught caught;
    action();
  } catch (const MissingCallback& error) {
    fail<Fault::MissingCallback>(error.what());
  } catch (const Interrupted& error) {
    fail<Fault::Interrupted>(error.what());
  } catch (const Error& error) {
    failFormat(offset, error.what());
  }
#else
  static_cast<void>(offset);
  action();
#endif
}

}  // namespace samestep
