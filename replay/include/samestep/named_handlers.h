// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <samestep/command.h>

namespace samestep {

/// A collision handler that scenes ask for by name. Its number never changes, as recordings carry it.
struct NamedHandler {
  CallbackNumber number;
  const char* name;
  const char* about;
};

inline constexpr NamedHandler kNamedHandlers[] = {
    {1, "ignore", "the shapes pass through each other"},
    {2, "one-way", "A lets through what comes from below"},
    {3, "bounce-pad", "what touches A bounces off without losing speed"},
    {4, "count", "begin adds 1 to the user data of both bodies"},
    {5, "separate-kick", "when the shapes part, B gets 1 m/s upwards"},
    {6, "conveyor", "the surface of A carries B along at 3 m/s"},
    {7, "remove-b", "B is removed after the step in which it touches A"},
    {8, "slippery", "no friction"},
};

/// The number of a handler; 0 where there is none of that name.
CallbackNumber handlerNumber(std::string_view name);

/// Registers all named handlers. Numbers from 1 to 999 are theirs; a game's own begin at 1000.
template <Scalar S>
void registerNamedHandlers(Space<S>& space);

/// Text that a claim with one of these keys must have to be true of a world: "samestep.bodies", how many
/// there are; "samestep.user-data.N", the user data of the body with index N, such as the handler "count"
/// keeps a score in; "samestep.hash", 16 hexadecimal digits. Empty for any other key, and for a body that is
/// not there.
template <Scalar S>
std::string namedClaim(const Space<S>& space, std::string_view key);

/// The wiring of scenes: the named handlers, and the named claims.
template <Scalar S>
Wiring<S> namedHandlerWiring();

}  // namespace samestep
