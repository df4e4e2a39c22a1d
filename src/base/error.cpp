// SPDX-License-Identifier: MIT
#include <samestep/error.h>

#include <array>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <samestep/raw_decimal.h>

namespace samestep {

const char* message(Fault fault) {
  switch (fault) {
    case Fault::AttachedBody:
      return "You have already added this body to another space. You cannot add it to a second.";
    case Fault::AttachedShape:
      return "You have already added this shape to another space. You cannot add it to a second.";
    case Fault::AttachedStaticBody:
      return "Internal Error: Changing the designated static body while the old one still had shapes "
             "attached.";
    case Fault::AttachedStaticIndex:
      return "This static index is already associated with a dynamic index.";
    case Fault::BodyNotFound:
      return "Cannot remove a body that was not added to the space. (Removed twice maybe?)";
    case Fault::BufferOverflow:
      return "Internal Error: Contact buffer overflow!";
    case Fault::CollisionContactOverflow:
      return "Internal Error: Tried to push too many contacts.";
    case Fault::CollisionError:
      return "Internal Error: Shape types are not sorted.";
    case Fault::ContactIndexOutOfBounds:
      return "Index error: The specified contact index is invalid for this arbiter.";
    case Fault::DuplicateBody:
      return "You have already added this body to this space. You must not add it a second time.";
    case Fault::DuplicateShape:
      return "You have already added this shape to this space. You must not add it a second time.";
    case Fault::IllegalBody:
      return "Body's state is invalid.";
    case Fault::IllegalSize:
      return "Tried to resize a hash table to a size greater than 1610612741.";
    case Fault::ImmutableNumContacts:
      return "The number of contact points cannot be changed.";
    case Fault::IndexOutOfBounds:
      return "Index out of range.";
    case Fault::InfiniteMass:
      return "Mass must be positive and finite.";
    case Fault::InsufficientBufferSize:
      return "Internal Error: Buffer size too small.";
    case Fault::InvalidChild:
      return "Internal Error: Node is not a child of parent.";
    case Fault::InvalidIter:
      return "Iterations must be positive and non-zero.";
    case Fault::LeafError:
      return "Internal Error: Cannot replace child of a leaf.";
    case Fault::MainStaticBody:
      return "Cannot remove the designated static body for the space.";
    case Fault::NaNMass:
      return "Body's mass is NaN.";
    case Fault::NaNMoment:
      return "Body's moment is NaN.";
    case Fault::NegativeElasticity:
      return "Elasticity must be a positive quantity.";
    case Fault::NegativeFriction:
      return "Friction must be a positive quantity.";
    case Fault::NegativeHalfDimensions:
      return "Half-dimensions should be nonnegative.";
    case Fault::NegativeMass:
      return "Body's mass is negative.";
    case Fault::NegativeMoment:
      return "Body's moment is negative.";
    case Fault::NegativeRadius:
      return "Radius should be nonnegative.";
    case Fault::NotCircleShape:
      return "Shape is not a circle shape.";
    case Fault::NotSegmentShape:
      return "Shape is not a segment shape.";
    case Fault::NotPolyShape:
      return "Shape is not a poly shape.";
    case Fault::SameVertices:
      return "Internal Error: EPA vertices are the same.";
    case Fault::ShapeNotFound:
      return "Cannot remove a shape that was not added to the space. (Removed twice maybe?)";
    case Fault::SpaceLocked:
      return "This operation cannot be done safely during a call to step() or during a query. Put these "
             "calls "
             "into a post-step callback.";
    case Fault::SpaceLockUnderflow:
      return "Internal Error: Space lock underflow.";
    case Fault::StaticBodyMass:
      return "You cannot set the mass of static bodies.";
    case Fault::UnsolvableCollision:
      return "Unsolvable collision or constraint.";
    case Fault::InfiniteMoment:
      return "Body's moment is infinite. Use Body::nonRotating for a body that does not turn.";
    case Fault::MassOutOfRange:
      return "Mass must be 0 or from 1e-3 to 1e6 kg.";
    case Fault::MomentOutOfRange:
      return "Moment must be 0 or from 2^-20 to 2^30 kg m^2.";
    case Fault::SizeOutOfRange:
      return "A length of the shape is outside the supported range.";
    case Fault::ValueOutOfRange:
      return "The value is not a finite number in its documented range.";
    case Fault::DegenerateShape:
      return "The points do not form a convex shape with an area.";
    case Fault::TooManyVertices:
      return "A polygon cannot have that many vertices.";
    case Fault::BodyHasShapes:
      return "Remove the shapes of a body before the body.";
    case Fault::MissingCallback:
      return "No callback is registered under this number.";
    case Fault::ForeignWorld:
      return "The saved state belongs to another kind of world.";
    case Fault::MalformedBytes:
      return "These bytes are not what they should be.";
    case Fault::KernelUnavailable:
      return "This build or this processor does not have that kernel.";
    case Fault::IllegalId:
      return "A given id must have an odd generation, higher than any its slot has had.";
    case Fault::UnsoundArithmetic:
      return "The processor is in a mode in which double gives other results.";
    case Fault::Interrupted:
      return "The call was to end; a world that it was changing must be restored.";
    case Fault::LeftMidway:
      return "A call that failed left this world midway: restore one, or bring one in, before anything else.";
    case Fault::TooManyPairs:
      return "More shapes are near each other than this Space may hold as pairs; see Space::setMaxPairs.";
  }
  return "Unknown fault.";
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
