// SPDX-License-Identifier: MIT
// Built with -mavx2 where the compiler knows it: nothing here may be called before the processor was asked,
// and nothing may be shared with other sources.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "state/hash_update.h"

namespace samestep {

#ifdef __AVX2__
namespace {

void update(void* state, const void* bytes, std::size_t size) {
  XXH3_64bits_update(static_cast<XXH3_state_t*>(state), bytes, size);
}

}  // namespace

const HashUpdate hashUpdateAvx2 = update;
#else
const HashUpdate hashUpdateAvx2 = nullptr;
#endif

}  // namespace samestep
