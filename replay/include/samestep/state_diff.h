// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <samestep/command.h>

namespace samestep {

/// One field in which two worlds differ.
struct FieldDifference {
  std::string object;  ///< "settings", "body 7", "shape 9 of body 7", "pair of shapes 3 and 9", ...
  std::string field;   ///< "velocity.x"; "exists" where only one world has the object.
  std::string a;       ///< The values: a number as decimal and as its 64 bits.
  std::string b;
};

/// The fields in which two worlds differ, at most `most`, in canonical order: settings and
/// clock, bodies, shapes, pairs, handlers, each by rising id.
template <Scalar S>
std::vector<FieldDifference> differences(const WorldState<S>& a, const WorldState<S>& b,
                                         std::uint32_t most = 0xffffffffu);

/// One value of a world.
struct WorldValue {
  std::string object;
  std::string field;
  std::string value;
};

/// All values of a world, in the order of differences().
template <Scalar S>
std::vector<WorldValue> valuesOf(const WorldState<S>& world);
/// A hash of each value of a world with its name, in the order of differences(), so that two machines find
/// the first in which their worlds differ without sending them.
template <Scalar S>
std::vector<std::uint64_t> valueHashes(const WorldState<S>& world);
/// The value with a number below how many there are; beyond, all is empty.
template <Scalar S>
WorldValue valueAt(const WorldState<S>& world, std::uint32_t index);

/// A command in words: "impulse: body 5, impulse (3, 0), arm (0, 0)".
template <Scalar S>
std::string describe(const Command<S>& command);

}  // namespace samestep
