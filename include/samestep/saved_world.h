// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/state.h>

namespace samestep {

/// What a Space computes from its state and can compute again.
template <Scalar S>
struct Derived;

/// A world kept in memory, by Space::save, with what its Space had computed from it. Reusing one makes saving
/// free of allocation. One into which a save failed holds nothing.
template <Scalar S>
class SavedSpace {
 public:
  SavedSpace();
  SavedSpace(const SavedSpace& other);
  SavedSpace(SavedSpace&& other) noexcept;
  SavedSpace& operator=(const SavedSpace& other);
  SavedSpace& operator=(SavedSpace&& other) noexcept;
  ~SavedSpace();

  /// The step it was saved after.
  std::uint64_t stamp() const { return state_.stamp; }
  const WorldState<S>& state() const { return state_; }
  /// How much memory it copies, bytes.
  std::uint64_t bytes() const;

 private:
  friend class Space<S>;
  /// @param derived  null for none
  void take(const WorldState<S>& state, const Derived<S>* derived);

  WorldState<S> state_;
  Derived<S>* derived_;  ///< Null only after a move.
};

#define SAMESTEP_EACH_SCALAR extern template class SavedSpace<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
