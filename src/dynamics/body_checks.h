// SPDX-License-Identifier: MIT
// The refusals of a Body. Included by body.cpp and body_motion.h alone.
#pragma once

#include <samestep/body.h>
#include <samestep/error.h>

namespace samestep {
namespace {

template <Scalar S>
void requireMoment(S moment, const char* asked) {
  constexpr const char* is = ": moment is ";
  require<Fault::NaNMoment>(moment == moment, asked, is, moment);
  require<Fault::NegativeMoment>(moment >= S(0), asked, is, moment, " kg m^2, allowed are 0 and ",
                                 kMinMoment<S>, " to ", kMaxMoment<S>, " kg m^2");
  require<Fault::InfiniteMoment>(isFinite(moment), asked, is, moment,
                                 "; see Body::nonRotating for a body that does not turn");
  require<Fault::MomentOutOfRange>(moment == S(0) || (moment >= kMinMoment<S> && moment <= kMaxMoment<S>),
                                   asked, is, moment, " kg m^2, allowed are 0 and ", kMinMoment<S>, " to ",
                                   kMaxMoment<S>, " kg m^2");
}

/// Refuses a number, or a vector by its components.
/// @param is  "Body::setForce: force is "
template <class T, Scalar S>
void requireWithin(const T& value, S limit, const char* is, const char* unit) {
  require<Fault::IllegalBody>(within(value, limit), is, value, unit, ", allowed are -", limit, " to ", limit,
                              unit);
}

/// Largest factor of gravity, and largest damping, 1/s.
template <Scalar S>
inline constexpr S kMostScale = S(1 << 10);

/// Refuses what is not between 0 and a limit.
template <Scalar S>
void requireUpTo(S value, S limit, const char* is, const char* unit) {
  require<Fault::IllegalBody>(value >= S(0) && value <= limit, is, value, unit, ", allowed are 0 to ", limit,
                              unit);
}

/// Says of which kind a body is that is not dynamic.
const char* kindOf(BodyType type) {
  return type == BodyType::staticBody ? ": the body is static" : ": the body is kinematic";
}

}  // namespace
}  // namespace samestep
