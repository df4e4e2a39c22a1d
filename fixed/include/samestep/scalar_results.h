#pragma once

namespace samestep {

/// Sine and cosine of one angle.
template <class S>
struct SinCos {
  S sin, cos;

  friend constexpr bool operator==(const SinCos&, const SinCos&) = default;
};

/// The two components of a plane vector, for functions below the vector type.
template <class S>
struct Components {
  S x, y;

  friend constexpr bool operator==(const Components&, const Components&) = default;
};

/// Names the type that holds sums of two exact products of S; see Wide in wide.h.
template <class S>
struct WideOf;

/// A double stands for its own products.
template <>
struct WideOf<double> {
  using type = double;
};

/// Names the number that places near each other are compared by; see local.h.
template <class S>
struct LocalOf;

/// A double is as good there as anywhere.
template <>
struct LocalOf<double> {
  using type = double;
};

/// Names the number of huge range that goes with S; see Scaled in scaled.h.
template <class S>
struct ScaledOf;

/// A double has range enough.
template <>
struct ScaledOf<double> {
  using type = double;
};

/// Sums of two exact products of S, for decisions that no rounding may sway.
template <class S>
using Wide = typename WideOf<S>::type;

/// Places of a neighbourhood, and sums of two products of them with unit vectors.
template <class S>
using Local = typename LocalOf<S>::type;

/// S with a range that masses, moments and their inverses cannot leave.
template <class S>
using Scaled = typename ScaledOf<S>::type;

}  // namespace samestep
