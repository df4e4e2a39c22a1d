// SPDX-License-Identifier: MIT
#include <samestep/saved_world.h>

#include <utility>

#include "base/require_ieee.h"
#include "context/derived.h"

namespace samestep {

template <Scalar S>
SavedSpace<S>::SavedSpace() : derived_(new Derived<S>) {}

template <Scalar S>
SavedSpace<S>::SavedSpace(const SavedSpace& other) : SavedSpace() {
  *this = other;
}

template <Scalar S>
SavedSpace<S>::SavedSpace(SavedSpace&& other) noexcept
    : state_(std::move(other.state_)), derived_(std::exchange(other.derived_, nullptr)) {}

template <Scalar S>
SavedSpace<S>& SavedSpace<S>::operator=(const SavedSpace& other) {
  if (this != &other) take(other.state_, other.derived_);
  return *this;
}

template <Scalar S>
void SavedSpace<S>::take(const WorldState<S>& state, const Derived<S>* derived) {
  // A part of a world is none.
  struct AllOrNothing {
    WorldState<S>& state;
    bool all = false;
    ~AllOrNothing() {
      if (!all) state = {};
    }
  } guard{state_};
  if (derived_ == nullptr) derived_ = new Derived<S>;
  derived_->cached = false;
  state_ = state;
  if (derived != nullptr) derived_->copyFrom(*derived);
  guard.all = true;
}

template <Scalar S>
SavedSpace<S>& SavedSpace<S>::operator=(SavedSpace&& other) noexcept {
  std::swap(state_, other.state_);
  std::swap(derived_, other.derived_);
  return *this;
}

template <Scalar S>
SavedSpace<S>::~SavedSpace() {
  delete derived_;
}

namespace {

/// Counts the bytes of the records of each section.
struct SectionBytes {
  std::uint64_t total = 0;

  template <class T>
  void operator()(const char*, const T&) {}
  template <class T, class IdType>
  void operator()(const Section&, const SlotMap<T, IdType>& records) {
    total += records.slots() * (sizeof(T) + sizeof(std::uint32_t));
  }
  template <class T>
  void operator()(const Section&, const std::vector<T>& records) {
    total += records.size() * sizeof(T);
  }
};

}  // namespace

template <Scalar S>
std::uint64_t SavedSpace<S>::bytes() const {
  SectionBytes records;
  WorldState<S>::sections(records, state_);
  return sizeof state_ + records.total + (derived_ == nullptr ? 0 : derived_->bytes());
}

#define SAMESTEP_EACH_SCALAR template class SavedSpace<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
