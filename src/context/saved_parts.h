// SPDX-License-Identifier: MIT
#pragma once

#include "context/derived.h"
#include "context/saved_records.h"

namespace samestep {

/// Parts of a saved world.
template <Scalar S>
struct SavedParts {
  SavedRecords<S> records;
  Derived<S> derived;

  /// Holds nothing from here on.
  void clear() {
    records.clear();
    derived.forget();
  }
  // A list whose memory ends midway holds nothing.

  void take(const WorldState<S>& world, const Derived<S>& computed) {
    clear();
    computed.saveTo(derived);
    records.take(world);
  }
  void take(const SavedParts& other) {
    clear();
    derived.copyFrom(other.derived);
    records = other.records;
  }
};

}  // namespace samestep
