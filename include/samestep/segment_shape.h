// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/shape.h>

namespace samestep {

/// A straight line from a to b in the body's frame, grown by `radius` on all sides, metres; without mass. Its
/// ends must differ, whatever the radius: a circle is what a segment without length would be.
/// @throws ValueOutOfRange (not finite), NegativeRadius, SizeOutOfRange (extent over kMaxExtent),
///         DegenerateShape (a equals b)
/// MIS: segmentShapeNew, segmentShapeInit
template <Scalar S>
Shape<S> segmentShape(BodyId body, const Vector<S>& a, const Vector<S>& b, S radius = S(0));

/// Reads the geometry of a segment; a reference to a Shape that must outlive it.
template <Scalar S>
class ConstSegmentShape {
 public:
  /// @throws NotSegmentShape
  explicit ConstSegmentShape(const Shape<S>& shape) : shape_(shape) {
    require<Fault::NotSegmentShape>(shape.type() == ShapeType::segment);
  }

  /// MIS: segmentShapeGetA
  Vector<S> a() const { return shape_.vertices()[0]; }
  /// MIS: segmentShapeGetB
  Vector<S> b() const { return shape_.vertices()[1]; }
  /// The unit normal, to the right of the way from a to b. MIS: segmentShapeGetNormal
  Vector<S> normal() const { return rperp(normalize(b() - a())); }
  /// MIS: segmentShapeGetRadius
  S radius() const { return shape_.radius(); }
  /// Ways from a to the neighbour set before it, and from b to the one after; zero without one.
  Vector<S> tangentA() const { return shape_.vertices()[2]; }
  Vector<S> tangentB() const { return shape_.vertices()[3]; }

 private:
  const Shape<S>& shape_;
};

/// Reads and changes the geometry of a segment. The mass stays; moment, area and centroid follow.
template <Scalar S>
class SegmentShape : public ConstSegmentShape<S> {
 public:
  /// @throws NotSegmentShape
  explicit SegmentShape(Shape<S>& shape) : ConstSegmentShape<S>(shape), shape_(shape) {}

  /// Says where the line goes on: from `previous` to a, and from b to `next`, in the body's frame. Nothing
  /// then catches on the joints of a row of segments. A point equal to its end takes that neighbour away.
  /// @throws ValueOutOfRange, SizeOutOfRange (farther than kMaxExtent from the body's origin)
  /// MIS: segmentShapeSetNeighbors
  void setNeighbors(const Vector<S>& previous, const Vector<S>& next);
  /// The tangents towards the neighbours stay as they are.
  /// @throws as segmentShape
  /// MIS: segmentShapeSetEndpoints
  void setEndpoints(const Vector<S>& a, const Vector<S>& b);
  /// @throws as segmentShape
  /// MIS: segmentShapeSetRadius
  void setRadius(S radius);

  /// Makes any shape this segment without neighbours; the surface, filter and ids stay, the mass too.
  static void assign(Shape<S>& shape, const Vector<S>& a, const Vector<S>& b, S radius);

 private:
  static void setGeometry(Shape<S>& shape, const Vector<S>& a, const Vector<S>& b, S radius,
                          const Vector<S>& tangentA, const Vector<S>& tangentB);

  Shape<S>& shape_;
};

/// kg m^2 about the origin of a segment, as a box of the same length and width.
template <Scalar S>
Scaled<S> scaledMomentForSegment(Scaled<S> mass, const Vector<S>& a, const Vector<S>& b, S radius);
/// Moment of a segment, saturating. MIS: momentForSegment
template <Scalar S>
S momentForSegment(S mass, const Vector<S>& a, const Vector<S>& b, S radius);

/// m^2 of a rounded segment.
template <Scalar S>
Scaled<S> scaledAreaForSegment(const Vector<S>& a, const Vector<S>& b, S radius);
/// Area of a segment, saturating. MIS: areaForSegment
template <Scalar S>
S areaForSegment(const Vector<S>& a, const Vector<S>& b, S radius);

#define SAMESTEP_EACH_SCALAR extern template class SegmentShape<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
