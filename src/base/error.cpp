// SPDX-License-Identifier: MIT
#include <samestep/error.h>

#include <array>
#include <cstdlib>
#include <iterator>
#include <string_view>
#include <utility>

#include <samestep/raw_decimal.h>

namespace samestep {

namespace {

struct FaultMessage {
  Fault fault;
  const char* text;
};

/// Messages of the faults, in their order.
constexpr FaultMessage kMessages[] = {
    {Fault::AttachedBody,
     "You have already added this body to another space. You cannot add it to a second."},
    {Fault::AttachedShape,
     "You have already added this shape to another space. You cannot add it to a second."},
    {Fault::AttachedStaticBody,
     "Internal Error: Changing the designated static body while the old one still had shapes "
     "attached."},
    {Fault::AttachedStaticIndex, "This static index is already associated with a dynamic index."},
    {Fault::BodyNotFound, "Cannot remove a body that was not added to the space. (Removed twice maybe?)"},
    {Fault::BufferOverflow, "Internal Error: Contact buffer overflow!"},
    {Fault::CollisionContactOverflow, "Internal Error: Tried to push too many contacts."},
    {Fault::CollisionError, "Internal Error: Shape types are not sorted."},
    {Fault::ContactIndexOutOfBounds, "Index error: The specified contact index is invalid for this arbiter."},
    {Fault::DuplicateBody,
     "You have already added this body to this space. You must not add it a second time."},
    {Fault::DuplicateShape,
     "You have already added this shape to this space. You must not add it a second time."},
    {Fault::IllegalBody, "Body's state is invalid."},
    {Fault::IllegalSize, "Tried to resize a hash table to a size greater than 1610612741."},
    {Fault::ImmutableNumContacts, "The number of contact points cannot be changed."},
    {Fault::IndexOutOfBounds, "Index out of range."},
    {Fault::InfiniteMass, "Mass must be positive and finite."},
    {Fault::InsufficientBufferSize, "Internal Error: Buffer size too small."},
    {Fault::InvalidChild, "Internal Error: Node is not a child of parent."},
    {Fault::InvalidIter, "Iterations must be positive and non-zero."},
    {Fault::LeafError, "Internal Error: Cannot replace child of a leaf."},
    {Fault::MainStaticBody, "Cannot remove the designated static body for the space."},
    {Fault::NaNMass, "Body's mass is NaN."},
    {Fault::NaNMoment, "Body's moment is NaN."},
    {Fault::NegativeElasticity, "Elasticity must be a positive quantity."},
    {Fault::NegativeFriction, "Friction must be a positive quantity."},
    {Fault::NegativeHalfDimensions, "Half-dimensions should be nonnegative."},
    {Fault::NegativeMass, "Body's mass is negative."},
    {Fault::NegativeMoment, "Body's moment is negative."},
    {Fault::NegativeRadius, "Radius should be nonnegative."},
    {Fault::NotCircleShape, "Shape is not a circle shape."},
    {Fault::NotSegmentShape, "Shape is not a segment shape."},
    {Fault::NotPolyShape, "Shape is not a poly shape."},
    {Fault::SameVertices, "Internal Error: EPA vertices are the same."},
    {Fault::ShapeNotFound, "Cannot remove a shape that was not added to the space. (Removed twice maybe?)"},
    {Fault::SpaceLocked,
     "This operation cannot be done safely during a call to step() or during a query. Put these calls"
     " into a post-step callback."},
    {Fault::SpaceLockUnderflow, "Internal Error: Space lock underflow."},
    {Fault::StaticBodyMass, "You cannot set the mass of static bodies."},
    {Fault::UnsolvableCollision, "Unsolvable collision or constraint."},
    {Fault::InfiniteMoment,
     "Body's moment is infinite. Use Body::nonRotating for a body that does not turn."},
    {Fault::MassOutOfRange, "Mass must be 0 or from 1e-3 to 1e6 kg."},
    {Fault::MomentOutOfRange, "Moment must be 0 or from 2^-20 to 2^30 kg m^2."},
    {Fault::SizeOutOfRange, "A length of the shape is outside the supported range."},
    {Fault::ValueOutOfRange, "The value is not a finite number in its documented range."},
    {Fault::DegenerateShape, "The points do not form a convex shape with an area."},
    {Fault::TooManyVertices, "A polygon cannot have that many vertices."},
    {Fault::BodyHasShapes, "Remove the shapes of a body before the body."},
    {Fault::MissingCallback, "No callback is registered under this number."},
    {Fault::ForeignWorld, "The saved state belongs to another kind of world."},
    {Fault::MalformedBytes, "These bytes are not what they should be."},
    {Fault::KernelUnavailable, "This build or this processor does not have that kernel."},
    {Fault::IllegalId, "A given id must have an odd generation, higher than any its slot has had."},
    {Fault::UnsoundArithmetic, "The processor is in a mode in which double gives other results."},
    {Fault::TooManyPairs,
     "More shapes are near each other than this Space may hold as pairs; see Space::setMaxPairs."},
    {Fault::Interrupted, "The call was to end; a world that it was changing must be restored."},
    {Fault::LeftMidway,
     "A call that failed left this world midway: restore one, or bring one in, before anything else."},
    {Fault::JointNotFound, "This id names no joint of this Space."},
    {Fault::IllegalJoint, "A joint has a number out of its range, or two ends on one body."},
};

constexpr bool eachFaultHasItsMessage() {
  for (std::size_t i = 0; i < std::size(kMessages); ++i) {
    if (kMessages[i].fault != static_cast<Fault>(i)) return false;
  }
  return std::size(kMessages) == kFaults;
}
static_assert(eachFaultHasItsMessage());

}  // namespace

const char* message(Fault fault) {
  const auto index = static_cast<std::size_t>(fault);
  return index < kFaults ? kMessages[index].text : "Unknown fault.";
}

#ifndef SAMESTEP_FIXED_ONLY
// This is where decimals of double are made.
char* writeDecimal(char* to, const char* end, double number) noexcept;
#endif

namespace {

FailureHandler failureHandler = nullptr;
thread_local int catchers = 0;

char* write(char* to, const char* end, std::string_view text) noexcept {
  for (const char c : text) {
    if (to == end) break;
    *to++ = c;
  }
  return to;
}

char* write(char* to, const char* end, const raw::DecimalText& text) noexcept {
  return write(to, end, std::string_view(text.characters.data(), static_cast<std::size_t>(text.length)));
}

char* writeWhole(char* to, const char* end, std::int64_t number) noexcept {
  raw::DecimalText digits;
  raw::appendInteger(digits, static_cast<std::uint64_t>(number), 1);
  return write(to, end, digits);
}

/// The text of an error, which the failure handler is asked about.
struct ToldText {
  char bytes[Error::kTextBytes];

  ToldText(Fault fault, std::initializer_list<ErrorPart> parts) noexcept {
    char* to = bytes;
    const char* const end = bytes + Error::kTextBytes - 1;
    for (const ErrorPart& part : parts) to = part.write(to, end);
    *to = 0;
    if (failureHandler != nullptr && catchers == 0) failureHandler(fault, bytes);
  }
};

#if defined(__cpp_exceptions)

template <std::size_t I>
[[noreturn]] void throwFault(const char* text) {
  throw FaultError<static_cast<Fault>(I)>(text);
}

using Thrower = void (*)(const char* text);
template <std::size_t... I>
constexpr std::array<Thrower, kFaults> throwers(std::index_sequence<I...>) {
  return {&throwFault<I>...};
}
constexpr std::array<Thrower, kFaults> kThrowers = throwers(std::make_index_sequence<kFaults>());

#endif

}  // namespace

char* ErrorPart::writeNumber(char* to, const char* end, std::int64_t bits) const noexcept {
  if (fractionBits_ >= 0) return samestep::write(to, end, raw::formatDecimal(bits, fractionBits_));
#ifndef SAMESTEP_FIXED_ONLY
  return writeDecimal(to, end, __builtin_bit_cast(double, bits));
#else
  return to;
#endif
}

char* ErrorPart::write(char* to, const char* end) const noexcept {
  const auto text = [&](std::string_view part) { to = samestep::write(to, end, part); };
  switch (kind_) {
    case Kind::text:
      text(text_);
      return to;
    case Kind::negative:
      text("-");
      return writeWhole(to, end, x_);
    case Kind::natural:
      return writeWhole(to, end, x_);
    case Kind::number:
      return writeNumber(to, end, x_);
    case Kind::vector:
      text("(");
      to = writeNumber(to, end, x_);
      text(", ");
      to = writeNumber(to, end, y_);
      text(")");
      return to;
    case Kind::id:
      to = writeWhole(to, end, x_);
      text(" (generation ");
      to = writeWhole(to, end, y_);
      text(")");
      return to;
    case Kind::noId:
      text("none");
      return to;
  }
  return to;
}

Error::Error(Fault fault, std::initializer_list<ErrorPart> text) noexcept : fault_(fault) {
  char* to = text_;
  for (const ErrorPart& part : text) to = part.write(to, text_ + kTextBytes - 1);
  *to = 0;
}

RevisionError::RevisionError(std::uint64_t offset, std::uint32_t found, std::uint32_t own) noexcept
    : FormatError(offset, {"made by simulation revision ", found,
                           ", whose results differ from those of revision ", own, ", this build's"}),
      found_(found),
      own_(own) {}

void failAs(Fault fault, std::initializer_list<ErrorPart> parts) {
  const ToldText text(fault, parts);
#if defined(__cpp_exceptions)
  if (static_cast<std::size_t>(fault) < kFaults) kThrowers[static_cast<std::size_t>(fault)](text.bytes);
#endif
  std::abort();
}

void failAs(Fault fault) { failAs(fault, {message(fault)}); }

void failFormat(std::uint64_t offset, const char* reason) {
  const ToldText text(Fault::MalformedBytes, {reason});
#if defined(__cpp_exceptions)
  throw FormatError(offset, text.bytes);
#else
  static_cast<void>(offset);
  std::abort();
#endif
}

void failRevision(std::uint64_t offset, std::uint32_t found, std::uint32_t own) {
  const RevisionError error(offset, found, own);
  const ToldText text(Fault::MalformedBytes, {error.what()});
#if defined(__cpp_exceptions)
  throw error;
#else
  std::abort();
#endif
}

void failWithoutExceptions(Fault fault, const char* text) {
  const ToldText told(fault, {text});
  std::abort();
}

void setFailureHandler(FailureHandler handler) { failureHandler = handler; }

FailuresAreCaught::FailuresAreCaught() noexcept { ++catchers; }
FailuresAreCaught::~FailuresAreCaught() { --catchers; }

}  // namespace samestep
