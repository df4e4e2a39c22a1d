// SPDX-License-Identifier: MIT
// XXH3 itself, in a file that is compiled with its inner loops unrolled.
#include "state_hash.h"

namespace samestep {

namespace {

void update(void* state, const void* bytes, std::size_t size) {
  XXH3_64bits_update(static_cast<XXH3_state_t*>(state), bytes, size);
}

}  // namespace

HashSink::HashSink(KernelTarget target)
    : update_(nextBestKernel(target) == KernelTarget::avx2 && hashUpdateAvx2 != nullptr ? hashUpdateAvx2
                                                                                        : update) {
  XXH3_64bits_reset(&state_);
}

void HashSink::flush() {
  update_(&state_, chunk_, used_);
  used_ = 0;
}

std::uint64_t HashSink::finish() {
  flush();
  return XXH3_64bits_digest(&state_);
}

}  // namespace samestep
