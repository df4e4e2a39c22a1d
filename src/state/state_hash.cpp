// SPDX-License-Identifier: MIT
// XXH3 itself, in a file that is compiled with its inner loops unrolled.
#include "state/state_hash.h"

namespace samestep {

namespace {

void update(void* state, const void* bytes, std::size_t size) {
  XXH3_64bits_update(static_cast<XXH3_state_t*>(state), bytes, size);
}

}  // namespace

HashSink::HashSink(KernelTarget target) : update_(update) {
  const KernelTarget next = nextBestKernel(target);
  // A processor that has AVX-512 has AVX2.
  const bool has = next == KernelTarget::avx2 || next == KernelTarget::avx512;
  if (has && hashUpdateAvx2 != nullptr) update_ = hashUpdateAvx2;
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
