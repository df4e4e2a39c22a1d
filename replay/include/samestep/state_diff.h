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

/// A command in words: "impulse: body 5, impulse (3, 0), arm (0, 0)".
template <Scalar S>
std::string describe(const Command<S>& command);

}  // namespace samestep
