// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace samestep {

/// A field that is an array of which only the first `count` values are in use; the rest are zero. What a
/// fields() list shows its visitor, which sees the count itself as a field of its own before.
template <class T>
struct Counted {
  T* values;
  std::uint32_t count;
  std::uint32_t capacity;
};

}  // namespace samestep
