// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include <samestep/query.h>
#include <samestep/shape.h>
#include <samestep/slot_map.h>
#include <samestep/time_of_impact.h>

namespace samestep {

template <Scalar S>
class BBTree;
template <Scalar S>
class SavedSpace;
template <Scalar S>
class Space;

/// Shapes that a query considers: those whose filter and this one accept each other, and of which the
/// function says yes.
struct QueryFilter {
  ShapeFilter filter{};
  bool sensors = true;
  /// A function that is asked last, about shapes that are hit; null: all are wanted. It must change nothing
  /// in the world.
  bool (*accepts)(ShapeId shape, void* data) = nullptr;
  void* data = nullptr;
};

/// A shape near another one.
template <Scalar S>
struct NearHit {
  ShapeId shape{};
  ShapeDistance<S> there{};  ///< Distance from the shape asked about to this one.
};

/// Questions about a world as it stands, from Space::queries or SavedSpace::queries. A view takes no memory
/// and changes nothing, so that any number of threads may ask at the same time; it lives until the world, or
/// the saved one, is changed. Answers do not depend on anything but the world: hits come by rising distance,
/// of equals by rising id, however many fit into the room that the caller gives; of more the first ones are
/// written, and all are counted.
///
/// Places are within kMaxWorldExtent along each axis: ValueOutOfRange.
template <Scalar S>
class QueryView {
 public:
  /// The first shape that a segment meets, thickened by a radius: see segmentQuery in samestep/shape.h.
  /// @return whether there is one
  /// @throws ValueOutOfRange, NegativeRadius
  bool castRay(const Vector<S>& start, const Vector<S>& end, const QueryFilter& filter, SegmentHit<S>& hit,
               S radius = S(0)) const;
  /// True if it meets any.
  bool meetsAny(const Vector<S>& start, const Vector<S>& end, const QueryFilter& filter,
                S radius = S(0)) const;
  /// All that it meets.
  /// @return how many there are
  std::size_t castRay(const Vector<S>& start, const Vector<S>& end, const QueryFilter& filter,
                      std::span<SegmentHit<S>> hits, S radius = S(0)) const;

  /// The shapes that a shape meets on its way, see timeOfImpact: `alpha` is the part of the motion. Shapes
  /// that it touches as it begins are hit at 0.
  /// @throws ValueOutOfRange, as timeOfImpact
  bool castShape(const Shape<S>& shape, const RigidMotion<S>& motion, const QueryFilter& filter,
                 SegmentHit<S>& hit) const;
  std::size_t castShape(const Shape<S>& shape, const RigidMotion<S>& motion, const QueryFilter& filter,
                        std::span<SegmentHit<S>> hits) const;

  /// The shapes that a shape under a pose touches or overlaps, by rising id.
  std::size_t overlapping(const Shape<S>& shape, const Transform<S>& pose, const QueryFilter& filter,
                          std::span<ShapeId> hits) const;
  /// The shapes within a distance of a shape under a pose; those that overlap it first.
  /// @param reach  m, in [0, 2^20]
  std::size_t nearest(const Shape<S>& shape, const Transform<S>& pose, S reach, const QueryFilter& filter,
                      std::span<NearHit<S>> hits) const;
  bool nearest(const Shape<S>& shape, const Transform<S>& pose, S reach, const QueryFilter& filter,
               NearHit<S>& hit) const;
  /// The distance of two shapes of the world.
  /// @throws ShapeNotFound
  ShapeDistance<S> distance(ShapeId a, ShapeId b) const;

 private:
  friend class Space<S>;
  friend class SavedSpace<S>;
  QueryView(const SlotMap<Shape<S>, ShapeId>& shapes, const BBTree<S>& moving, const BBTree<S>& resting,
            const PlacedShape<S>* placed)
      : shapes_(&shapes), trees_{&moving, &resting}, placed_(placed) {}

  bool considers(std::uint32_t index, const QueryFilter& filter) const;
  bool accepts(std::uint32_t index, const QueryFilter& filter) const {
    return filter.accepts == nullptr || filter.accepts(shapes_->idAt(index), filter.data);
  }
  /// Calls visit(index, hit) for what a ray meets, in any order.
  template <class Visit>
  void eachOnRay(const Vector<S>& start, const Vector<S>& end, S radius, const QueryFilter& filter,
                 Visit&& visit) const;
  template <class Visit>
  void eachOnWay(const Shape<S>& shape, const RigidMotion<S>& motion, const QueryFilter& filter,
                 Visit&& visit) const;
  template <class Visit>
  void eachNear(const Shape<S>& shape, const Transform<S>& pose, S reach, const QueryFilter& filter,
                Visit&& visit) const;

  const SlotMap<Shape<S>, ShapeId>* shapes_;
  const BBTree<S>* trees_[2];
  const PlacedShape<S>* placed_;
};

#define SAMESTEP_EACH_SCALAR extern template class QueryView<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
