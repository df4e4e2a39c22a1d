// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/state.h>

#include "context/wiring.h"

namespace samestep {

/// The state of a world, packed: of each record the fields alone, with the rotation of bodies, which costs a
/// sine and a cosine. Shapes are kept as they are: they differ in length.
template <Scalar S>
class SavedRecords {
 public:
  void take(const WorldState<S>& world);
  /// Writes the state into a world, in place: nothing of what that was is left but room and what follows from
  /// masses that are the same. Not for records that are empty().
  void giveTo(WorldState<S>& world) const;

  /// Holds nothing from here on.
  void clear() { used_ = 0; }
  bool empty() const { return used_ == 0; }
  const SlotMap<Shape<S>, ShapeId>& shapes() const { return shapes_; }
  /// Number of the Space whose ids those of the world are; see Id::space.
  std::uint32_t space() const { return shapes_.space(); }
  std::uint64_t stamp() const { return empty() ? 0 : stamp_; }
  std::uint64_t bytes() const;
  /// @throws MissingCallback where a function that the world needs is not registered
  void requireCallbacks(const SpaceWiring<S>& wiring) const;

 private:
  std::uint64_t stamp_ = 0;
  std::vector<std::uint8_t> packed_;
  SlotMap<Shape<S>, ShapeId> shapes_;
  // The numbers of functions that the world needs.
  std::vector<CallbackNumber> positionFuncs_;
  std::vector<CallbackNumber> velocityFuncs_;
  std::vector<CallbackNumber> handlers_;
  /// Bytes of packed_; 0 where nothing was saved. It is set last: a part of a world is none.
  std::uint64_t used_ = 0;
};

#define SAMESTEP_EACH_SCALAR extern template class SavedRecords<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
