#pragma once

namespace samestep {

/// The two coordinates that a function of layer 0 returns, where no Vector exists yet.
template <class S>
struct Components {
  S x, y;
  friend constexpr bool operator==(const Components&, const Components&) = default;
};

/// Sine and cosine of one angle.
template <class S>
struct SinCos {
  S sin, cos;
  friend constexpr bool operator==(const SinCos&, const SinCos&) = default;
};

}  // namespace samestep
