// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace samestep {

/// Adds bytes to an XXH3 state, an XXH3_state_t. Its own header, since what is built for one processor shares
/// no inline function with other sources.
using HashUpdate = void (*)(void* state, const void* bytes, std::size_t size);

/// Update with AVX2: for a processor that has it. Null where the compiler does not know it.
extern const HashUpdate hashUpdateAvx2;

}  // namespace samestep
