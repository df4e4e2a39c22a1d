// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <samestep/error.h>
#include <samestep/events.h>
#include <samestep/kernel.h>
#include <samestep/limits.h>
#include <samestep/make_room.h>
#include <samestep/remark.h>
#include <samestep/state.h>
#include <samestep/workers.h>

#include "base/budget.h"

namespace samestep {

/// The functions behind the bindings of a world, sorted as these are, so that a search meets nothing else: a
/// world from elsewhere may have thousands, and each pair of shapes asks several times.
template <class RegisteredHandler>
class BoundHandlers {
 public:
  /// Takes the bindings of a world anew. Each handler is among those registered, which are sorted.
  void take(const std::vector<HandlerBinding>& bindings, const std::vector<RegisteredHandler>& registered) {
    entries_.resize(bindings.size());
    std::fill(std::begin(ends_), std::end(ends_), std::uint32_t{0});
    for (std::size_t i = 0; i < bindings.size(); ++i) {
      const HandlerBinding& binding = bindings[i];
      const auto place = std::lower_bound(
          registered.begin(), registered.end(), binding.number,
          [](const RegisteredHandler& entry, CallbackNumber number) { return entry.number < number; });
      entries_[i] = {std::uint64_t{binding.typeA} << 32 | binding.typeB,
                     static_cast<std::uint32_t>(place - registered.begin())};
      for (auto kind = static_cast<std::size_t>(binding.kind); kind < kKinds; ++kind) ++ends_[kind];
    }
  }
  /// So that take() takes no memory for as many.
  void reserve(std::size_t bindings) { makeRoom(entries_, bindings); }
  /// The handler bound to these types, or null.
  auto find(const std::vector<RegisteredHandler>& registered, HandlerBinding::Kind kind, CollisionType typeA,
            CollisionType typeB) const -> decltype(&registered[0].handler) {
    const auto which = static_cast<std::size_t>(kind);
    const auto begin = entries_.begin() + (which == 0 ? 0 : ends_[which - 1]);
    const auto end = entries_.begin() + ends_[which];
    const std::uint64_t types = std::uint64_t{typeA} << 32 | typeB;
    const auto place = std::lower_bound(
        begin, end, types, [](const Entry& entry, std::uint64_t wanted) { return entry.types < wanted; });
    if (place == end || place->types != types) return nullptr;
    return &registered[place->handler].handler;
  }

 private:
  static constexpr std::size_t kKinds = 3;
  struct Entry {
    std::uint64_t types;
    std::uint32_t handler;
  };

  std::vector<Entry> entries_;
  /// Number of bindings of this kind or one before.
  std::uint32_t ends_[kKinds] = {};
};

/// Connections of a Space: functions under their numbers, the kernel, workers, the limit of pairs. No saved
/// world carries it, and no result depends on it but what functions do and what is refused.
template <Scalar S>
struct SpaceWiring {
  template <class Function>
  struct Registered {
    CallbackNumber number;
    Function function;
    void* data;
  };
  struct RegisteredHandler {
    CallbackNumber number;
    CollisionHandler<S> handler;
  };

  // Each by rising number.
  std::vector<Registered<BodyPositionFunc<S>>> positionFuncs;
  std::vector<Registered<BodyVelocityFunc<S>>> velocityFuncs;
  std::vector<RegisteredHandler> handlers;
  /// Follows from the handlers and the world's bindings.
  BoundHandlers<RegisteredHandler> bound;
  StageObserverFunc<S> observer = nullptr;
  void* observerData = nullptr;
  EventListing<S> listing{};
  TaskRunner* runner = nullptr;
  KernelTarget kernel = nextBestKernel(KernelTarget::best);
  std::uint32_t maxPairs = kDefaultMaxPairs;
  Budget budget;
  Remarks remarks;
  /// Counts the worlds that came from elsewhere, for who must notice one.
  std::uint64_t worldsBroughtIn = 0;

  /// Place of the entry of a number, or where it would be.
  template <class Entries>
  static auto placeOf(Entries& entries, CallbackNumber number) {
    return std::lower_bound(entries.begin(), entries.end(), number,
                            [](const auto& entry, CallbackNumber wanted) { return entry.number < wanted; });
  }
  /// Functions registered under a number, or nullptr.
  template <class Entry>
  static const Entry* find(const std::vector<Entry>& entries, CallbackNumber number) {
    const auto place = placeOf(entries, number);
    return place == entries.end() || place->number != number ? nullptr : &*place;
  }
  template <class Entry>
  static void set(std::vector<Entry>& entries, const Entry& entry) {
    const auto place = placeOf(entries, entry.number);
    if (place != entries.end() && place->number == entry.number) {
      *place = entry;
    } else {
      entries.insert(place, entry);
    }
  }
  bool has(CallbackNumber handler) const { return find(handlers, handler) != nullptr; }
  /// @throws MissingCallback where a function of the body is not registered
  void requireCallbacks(const Body<S>& body) const {
    require<Fault::MissingCallback>(
        body.positionFunc() == 0 || find(positionFuncs, body.positionFunc()) != nullptr, "body ", body.id(),
        ": no position function is registered under ", body.positionFunc());
    require<Fault::MissingCallback>(
        body.velocityFunc() == 0 || find(velocityFuncs, body.velocityFunc()) != nullptr, "body ", body.id(),
        ": no velocity function is registered under ", body.velocityFunc());
  }
};

}  // namespace samestep
