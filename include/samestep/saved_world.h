// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/query_view.h>
#include <samestep/state.h>

namespace samestep {

template <Scalar S>
struct SavedParts;

/// A world kept in memory, by Space::save: its state, packed, and what its Space had computed from it that
/// the next step would have to compute again. What a step leaves for callbacks and visits alone (impulses,
/// and the materials that callbacks set for a step) is not kept. Reusing one makes saving free of allocation.
/// One into which a save failed holds nothing.
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
  std::uint64_t stamp() const;
  /// The state, unpacked; an empty one if nothing was saved.
  WorldState<S> state() const;
  /// Questions about it, without restoring it: what was where at that time. What was moved by hand after the
  /// last step before the world was saved is placed anew by each call of this; the view itself changes
  /// nothing.
  /// @throws ForeignWorld where nothing was saved
  QueryView<S> queries();
  /// The bytes that it keeps.
  std::uint64_t bytes() const;

 private:
  friend class Space<S>;
  SavedParts<S>* parts_;  ///< Null only after a move.
};

#define SAMESTEP_EACH_SCALAR extern template class SavedSpace<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
