// SPDX-License-Identifier: MIT
#include <samestep/error.h>

#include <cstdlib>

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

namespace {

FailureHandler failureHandler = nullptr;

char* append(char* to, const char* text) {
  while (*text != 0) *to++ = *text++;
  return to;
}
char* append(char* to, std::uint32_t number) {
  if (number >= 10) to = append(to, number / 10);
  *to = static_cast<char>('0' + number % 10);
  return to + 1;
}

}  // namespace

RevisionError::RevisionError(std::uint64_t offset, std::uint32_t found, std::uint32_t own)
    : FormatError(offset, message(Fault::MalformedBytes)), found_(found), own_(own) {
  char* end = append(append(text_, "made by simulation revision "), found);
  end = append(append(append(end, ", whose results differ from those of revision "), own), ", this build's");
  *end = 0;
}

[[noreturn]] void failRevision(std::uint64_t offset, std::uint32_t found, std::uint32_t own) {
#if defined(__cpp_exceptions)
  throw RevisionError(offset, found, own);
#else
  failWithoutExceptions(Fault::MalformedBytes, RevisionError(offset, found, own).what());
#endif
}

void setFailureHandler(FailureHandler handler) { failureHandler = handler; }

[[noreturn]] void failWithoutExceptions(Fault fault, const char* text) {
  if (failureHandler != nullptr) failureHandler(fault, text);
  std::abort();
}

}  // namespace samestep
