// SPDX-License-Identifier: MIT
// XXH3 itself, in a file that is compiled with its inner loops unrolled.
#include "state_hash.h"

namespace samestep {

HashSink::HashSink() { XXH3_64bits_reset(&state_); }

void HashSink::flush() {
  XXH3_64bits_update(&state_, chunk_, used_);
  used_ = 0;
}

std::uint64_t HashSink::finish() {
  flush();
  return XXH3_64bits_digest(&state_);
}

}  // namespace samestep
