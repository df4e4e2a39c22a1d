// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <samestep/space.h>

namespace samestep {

/// Place of the centre of mass of a body, m.
struct Spot {
  BodyId body{};
  double x = 0;
  double y = 0;
};

/// Places of bodies at one time, by rising index of their ids.
using Spots = std::vector<Spot>;

/// Places of bodies after the first step, the second, and so on.
using Track = std::vector<Spots>;

/// Places of all dynamic bodies.
template <Scalar S>
Spots spotsOf(const Space<S>& space);

/// The root mean square distance, m, of the bodies that both have; 0 if there are none.
double distanceBetween(const Spots& a, const Spots& b);
/// Distance over all steps that both have.
double distanceBetween(const Track& a, const Track& b);

/// World from which an exact answer starts: before its first step, in double.
struct StartWorld {
  struct Moving {
    Spot spot;
    double cosine, sine;  ///< Cosine and sine of its angle.
    double turning;       ///< rad/s
    double radius;        ///< Radius of its first shape if that is a circle, else 0; m.
    double friction, elasticity;
    double velocityX = 0, velocityY = 0;  ///< m/s
  };
  std::vector<Moving> bodies;  ///< The dynamic ones that have shapes, by rising index.
  double gravityX = 0;
  double gravityY = 0;
  double belt = 0;   ///< Speed of the surface of what is static, the last with one, m/s along x.
  double floor = 0;  ///< The greatest height of anything static, m.
};

template <Scalar S>
StartWorld startOf(const Space<S>& space);

/// A scene whose exact answer is known.
struct ExactAnswer {
  const char* scenes;   ///< Scenes are those whose names begin so.
  std::uint64_t steps;  ///< Over which it is compared unless asked otherwise.
  std::uint64_t most;   ///< Over how many it holds at the most.
  const char* measure;  ///< Says what is compared with what.
  /// Places of the bodies whose answer is known, after `time` seconds.
  Spots (*after)(const StartWorld& start, double time);
};

/// Null where none is known.
const ExactAnswer* exactAnswerOf(std::string_view scene);

#ifndef SAMESTEP_FIXED_ONLY
extern template Spots spotsOf<double>(const Space<double>&);
extern template StartWorld startOf<double>(const Space<double>&);
#endif
extern template Spots spotsOf<Fixed>(const Space<Fixed>&);
extern template StartWorld startOf<Fixed>(const Space<Fixed>&);

}  // namespace samestep
