// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

#include <samestep/bb.h>
#include <samestep/c/samestep.h>
#include <samestep/error.h>
#include <samestep/id.h>
#include <samestep/scalar.h>
#include <samestep/shape.h>
#include <samestep/vector.h>

namespace samestep::c {

constexpr bool isFinite(double x) {
  return x >= -std::numeric_limits<double>::max() && x <= std::numeric_limits<double>::max();
}

/// A number of the caller's. Fixed has no NaN to refuse later, and holds what is too large at its ends,
/// beyond every range of the engine.
/// @throws ValueOutOfRange where it is not finite
template <Scalar S>
S number(double x) {
  require<Fault::ValueOutOfRange>(isFinite(x), "A number is NaN or infinite.");
  return S(x);
}
template <Scalar S>
Vector<S> vector(double x, double y) {
  return {number<S>(x), number<S>(y)};
}
template <Scalar S>
Vector<S> vector(const samestep_vec2& v) {
  return vector<S>(v.x, v.y);
}
/// @throws NaNMass, NegativeMass, InfiniteMass, as a Body of double does
template <Scalar S>
S massNumber(double x) {
  require<Fault::NaNMass>(x == x);
  require<Fault::NegativeMass>(x >= 0);
  require<Fault::InfiniteMass>(isFinite(x));
  return S(x);
}
/// @throws NaNMoment, NegativeMoment, InfiniteMoment
template <Scalar S>
S momentNumber(double x) {
  require<Fault::NaNMoment>(x == x);
  require<Fault::NegativeMoment>(x >= 0);
  require<Fault::InfiniteMoment>(isFinite(x));
  return S(x);
}
/// @throws ValueOutOfRange outside the largest world
template <Scalar S>
Vector<S> place(double x, double y) {
  const Vector<S> v = vector<S>(x, y);
  require<Fault::ValueOutOfRange>(within(v, kMaxWorldExtent<S>));
  return v;
}

/// The seconds of a step.
/// @throws ValueOutOfRange
template <Scalar S>
S timeStepOf(std::uint32_t rate) {
  require<Fault::ValueOutOfRange>(rate >= 1 && rate <= 1000000, "Steps per second are 1 to 1000000.");
  return ratio<S>(1, static_cast<int>(rate));
}

template <Scalar S>
double toDouble(S x) {
  return static_cast<double>(x);
}
template <Scalar S>
samestep_vec2 toVec2(const Vector<S>& v) {
  return {toDouble(v.x), toDouble(v.y)};
}
template <Scalar S>
samestep_box toBox(const BB<S>& box) {
  return {toDouble(box.left), toDouble(box.bottom), toDouble(box.right), toDouble(box.top)};
}

/// The 64 bits of a number.
template <Scalar S>
std::int64_t toRaw(S x) {
  if constexpr (ScalarTraits<S>::kKind == ScalarKind::fixed) {
    return x.raw();
  } else {
    return __builtin_bit_cast(std::int64_t, x);
  }
}
template <Scalar S>
S fromRaw(std::int64_t raw) {
  if constexpr (ScalarTraits<S>::kKind == ScalarKind::fixed) {
    return S::fromRaw(raw);
  } else {
    return __builtin_bit_cast(S, raw);
  }
}

template <class Tag>
std::uint64_t toC(const Id<Tag>& id) {
  return id.valid() ? id.bits() : 0;
}
/// 0 gives the id that names nothing.
template <class AnyId>
AnyId fromC(std::uint64_t id) {
  return id == 0 ? AnyId() : AnyId::fromBits(id);
}

inline ShapeFilter toFilter(const samestep_filter* filter) {
  return filter == nullptr ? ShapeFilter{} : ShapeFilter{filter->group, filter->category, filter->mask};
}

}  // namespace samestep::c
