// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/error.h>
#include <samestep/events.h>
#include <samestep/kernel.h>
#include <samestep/limits.h>
#include <samestep/remark.h>
#include <samestep/workers.h>

namespace samestep {

/// What a Space is connected to: functions under their numbers, the kernel, workers, the limit of pairs. No
/// saved world carries it, and no result depends on it but what functions do and what is refused.
template <Scalar S>
struct Wiring {
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

  std::vector<Registered<BodyPositionFunc<S>>> positionFuncs;
  std::vector<Registered<BodyVelocityFunc<S>>> velocityFuncs;
  std::vector<RegisteredHandler> handlers;
  StageObserverFunc<S> observer = nullptr;
  void* observerData = nullptr;
  /// Tells the objects of this Space from those of another; 0 is nobody's.
  std::uint32_t serial = 0;
  TaskRunner* runner = nullptr;
  KernelTarget kernel = nextBestKernel(KernelTarget::best);
  std::uint32_t maxPairs = kDefaultMaxPairs;
  Remarks remarks;
  /// Counts the worlds that came from elsewhere, for who must notice one.
  std::uint64_t worldsBroughtIn = 0;

  /// What is registered under a number, or nullptr.
  template <class Entry>
  static const Entry* find(const std::vector<Entry>& entries, CallbackNumber number) {
    for (const Entry& entry : entries) {
      if (entry.number == number) return &entry;
    }
    return nullptr;
  }
  template <class Entry>
  static void set(std::vector<Entry>& entries, const Entry& entry) {
    for (Entry& present : entries) {
      if (present.number == entry.number) {
        present = entry;
        return;
      }
    }
    entries.push_back(entry);
  }
  bool has(CallbackNumber handler) const { return find(handlers, handler) != nullptr; }
  /// @throws MissingCallback where a function of the body is not registered
  void requireCallbacks(const Body<S>& body) const {
    require<Fault::MissingCallback>(body.positionFunc() == 0 ||
                                    find(positionFuncs, body.positionFunc()) != nullptr);
    require<Fault::MissingCallback>(body.velocityFunc() == 0 ||
                                    find(velocityFuncs, body.velocityFunc()) != nullptr);
  }
};

}  // namespace samestep
