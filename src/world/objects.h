// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "context/step_context.h"

namespace samestep {

/// Bodies and shapes as they come, change and go: checks first, then the state, then what is derived from it.
/// The caller has made sure that the Space is not locked where that is asked for.
template <Scalar S>
struct Objects {
  using Context = StepContext<S>;
  static constexpr std::uint32_t kNone = Derived<S>::kNone;

  static void checkNew(const Context& world, const Body<S>& body);
  /// Stores a body.
  /// @pre the id can be given to it
  static void insert(Context& world, const Body<S>& body, BodyId id);
  static void erase(Context& world, BodyId id);
  /// A body with all its shapes, in one go: each pair and shape is looked at once.
  static void eraseWithShapes(Context& world, BodyId id);
  static void setType(Context& world, BodyId id, BodyType type);
  static void accumulateMass(Context& world, BodyId id);

  /// Takes in a shape under an id that can be given to a new one.
  static void insert(Context& world, const Shape<S>& shape, ShapeId id);
  static void erase(Context& world, ShapeId id);
  /// @param locked  whether geometry and mass may not change
  static void replace(Context& world, ShapeId id, const Shape<S>& shape, bool locked);

 private:
  static void checkShape(const Shape<S>& shape, const Body<S>& body);
  static MassProperties<S> massOfShapes(Context& world, BodyId id, std::uint32_t replaced,
                                        const Shape<S>* by);
  static bool anyShapeWeighs(Context& world, BodyId id, std::uint32_t replaced, const Shape<S>* by);
  static void takeMass(Context& world, BodyId id, std::uint32_t replaced, const Shape<S>* by);
  static void rouseNear(Context& world, ShapeId id);
  static bool collidesAlike(const Shape<S>& a, const Shape<S>& b);
  static void forgetManifolds(Context& world, ShapeId id, std::span<const std::uint32_t> touching);
};

#define SAMESTEP_EACH_SCALAR extern template struct Objects<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
