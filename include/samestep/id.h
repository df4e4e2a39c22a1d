// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>

namespace samestep {

/// Names one object of one Space: a slot and how often the slot has been used. A removed object's id never
/// names a later one. Ordered by slot. The default id names nothing.
template <class Tag>
struct Id {
  static constexpr std::uint32_t kNoIndex = 0xffffffffu;

  std::uint32_t index = kNoIndex;
  std::uint32_t generation = 0;

  /// Whether this is some object's id; whether the object still exists only its Space knows.
  constexpr bool valid() const { return index != kNoIndex; }

  friend constexpr bool operator==(const Id&, const Id&) = default;
  friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

using BodyId = Id<struct BodyTag>;
using ShapeId = Id<struct ShapeTag>;

}  // namespace samestep
