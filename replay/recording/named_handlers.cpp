// SPDX-License-Identifier: MIT
#include <samestep/named_handlers.h>

#include <charconv>

#include "base/require_ieee.h"

namespace samestep {
namespace {

constexpr std::string_view kClaimPrefix = "samestep.";

template <Scalar S>
struct Handlers {
  using A = Arbiter<S>;
  using World = Space<S>;

  static bool refuse(A&, World&, void*) { return false; }

  /// The platform is A: what it would push down has come from below.
  static bool oneWay(A& arbiter, World&, void*) {
    return arbiter.normal().y >= S(0) ? true : arbiter.ignore();
  }

  static bool bounce(A& arbiter, World&, void*) {
    arbiter.setRestitution(S(1));
    return true;
  }

  static bool count(A& arbiter, World& space, void*) {
    for (const BodyId id : {arbiter.bodyA(), arbiter.bodyB()}) {
      Body<S>& body = space.body(id);
      body.setUserData(body.userData() + 1);
    }
    return true;
  }

  static void kick(A& arbiter, World& space, void*) {
    Body<S>& body = space.body(arbiter.bodyB());
    if (!body.isDynamic()) return;
    const Vector<S> kicked(body.velocity().x, min(body.velocity().y + S(1), kMaxSpeed<S>));
    body.setVelocity(kicked);
  }

  static bool carry(A& arbiter, World&, void*) {
    arbiter.setSurfaceVelocity(perp(arbiter.normal()) * S(3));
    return true;
  }

  static void removeLater(World& space, std::uint64_t key, void*) {
    BodyId id;
    id.index = static_cast<std::uint32_t>(key >> 32);
    id.generation = static_cast<std::uint32_t>(key);
    if (space.contains(id)) space.removeWithShapes(id);
  }
  static bool removeB(A& arbiter, World& space, void*) {
    const BodyId id = arbiter.bodyB();
    if (id != space.staticBody()) {
      space.addPostStepCallback(removeLater, std::uint64_t{id.index} << 32 | id.generation);
    }
    return true;
  }

  static bool slip(A& arbiter, World&, void*) {
    arbiter.setFriction(S(0));
    return true;
  }

  static CollisionHandler<S> of(CallbackNumber number) {
    switch (number) {
      case 1:
        return {.begin = refuse};
      case 2:
        return {.preSolve = oneWay};
      case 3:
        return {.preSolve = bounce};
      case 4:
        return {.begin = count};
      case 5:
        return {.separate = kick};
      case 6:
        return {.preSolve = carry};
      case 7:
        return {.begin = removeB};
      case 8:
        return {.preSolve = slip};
      default:
        return {};
    }
  }
};

template <Scalar S>
void connectNamedHandlers(Space<S>& space, void*) {
  registerNamedHandlers(space);
}

template <Scalar S>
ClaimCheck checkNamedClaim(const Space<S>& space, std::string_view key, std::span<const std::uint8_t> value,
                           void*) {
  if (!key.starts_with(kClaimPrefix)) return ClaimCheck::unknown;
  const std::string right = namedClaim(space, key);
  const std::string_view said(reinterpret_cast<const char*>(value.data()), value.size());
  return !right.empty() && said == right ? ClaimCheck::holds : ClaimCheck::isFalse;
}

std::string hexText(std::uint64_t value) {
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[15 - i] = "0123456789abcdef"[value >> (4 * i) & 15];
  return text;
}

}  // namespace

CallbackNumber handlerNumber(std::string_view name) {
  for (const NamedHandler& handler : kNamedHandlers) {
    if (name == handler.name) return handler.number;
  }
  return 0;
}

template <Scalar S>
void registerNamedHandlers(Space<S>& space) {
  for (const NamedHandler& handler : kNamedHandlers) {
    space.registerHandler(handler.number, Handlers<S>::of(handler.number));
  }
}

template <Scalar S>
std::string namedClaim(const Space<S>& space, std::string_view key) {
  constexpr std::string_view kUserData = "samestep.user-data.";
  if (key == "samestep.bodies") return std::to_string(space.bodyCount());
  if (key == "samestep.hash") return hexText(space.hash());
  if (!key.starts_with(kUserData)) return {};
  const std::string_view digits = key.substr(kUserData.size());
  std::uint32_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc() || end != digits.data() + digits.size()) return {};
  const auto& bodies = space.state().bodies;
  if (index >= bodies.slots() || !bodies.aliveAt(index)) return {};
  return std::to_string(bodies.valueAt(index).userData());
}

template <Scalar S>
Wiring<S> namedHandlerWiring() {
  return {.connect = connectNamedHandlers<S>, .checkClaim = checkNamedClaim<S>};
}

#define SAMESTEP_EACH_SCALAR                                             \
  template void registerNamedHandlers<S>(Space<S>&);                     \
  template std::string namedClaim<S>(const Space<S>&, std::string_view); \
  template Wiring<S> namedHandlerWiring<S>();
#include <samestep/each_scalar.h>

}  // namespace samestep
