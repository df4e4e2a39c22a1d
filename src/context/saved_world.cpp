// SPDX-License-Identifier: MIT
#include <samestep/saved_world.h>

#include <utility>

#include "base/require_ieee.h"
#include "context/saved_parts.h"

namespace samestep {

template <Scalar S>
SavedSpace<S>::SavedSpace() : parts_(new SavedParts<S>) {}

template <Scalar S>
SavedSpace<S>::SavedSpace(const SavedSpace& other) : SavedSpace() {
  *this = other;
}

template <Scalar S>
SavedSpace<S>::SavedSpace(SavedSpace&& other) noexcept : parts_(std::exchange(other.parts_, nullptr)) {}

template <Scalar S>
SavedSpace<S>& SavedSpace<S>::operator=(const SavedSpace& other) {
  if (this == &other) return *this;
  if (parts_ == nullptr) parts_ = new SavedParts<S>;
  if (other.parts_ == nullptr) {
    parts_->clear();
  } else {
    parts_->take(*other.parts_);
  }
  return *this;
}

template <Scalar S>
SavedSpace<S>& SavedSpace<S>::operator=(SavedSpace&& other) noexcept {
  std::swap(parts_, other.parts_);
  return *this;
}

template <Scalar S>
SavedSpace<S>::~SavedSpace() {
  delete parts_;
}

template <Scalar S>
std::uint64_t SavedSpace<S>::stamp() const {
  return parts_ == nullptr ? 0 : parts_->records.stamp();
}

template <Scalar S>
WorldState<S> SavedSpace<S>::state() const {
  WorldState<S> state;
  if (parts_ != nullptr && !parts_->records.empty()) parts_->records.giveTo(state);
  return state;
}

template <Scalar S>
QueryView<S> SavedSpace<S>::queries() {
  require<Fault::ForeignWorld>(parts_ != nullptr && !parts_->records.empty());
  Derived<S>& derived = parts_->derived;
  if (!derived.cached || !derived.touched.empty()) {
    const WorldState<S> world = state();
    // The parts computed for the next step are kept as they are; shapes of bodies that were touched then go
    // on being placed anew after a restore.
    const bool computed = derived.cached;
    derived.poses.resize(world.bodies.slots());
    derived.refresh(world);
    if (!computed) derived.stands.assign(world.bodies.slots(), 0);
  }
  return QueryView<S>(parts_->records.shapes(), derived.dynamicTree, derived.staticTree,
                      derived.placed.data());
}

template <Scalar S>
std::uint64_t SavedSpace<S>::bytes() const {
  return parts_ == nullptr ? 0 : parts_->records.bytes() + parts_->derived.bytes();
}

#define SAMESTEP_EACH_SCALAR template class SavedSpace<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
