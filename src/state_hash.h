// SPDX-License-Identifier: MIT
#pragma once

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdint>

#include "canonical.h"

namespace samestep {

/// A sink of CanonicalWriter that hashes: XXH3-64, the same value on every machine.
class HashSink {
 public:
  HashSink() { XXH3_64bits_reset(&state_); }

  std::uint8_t* reserve(unsigned size) {
    if (used_ + size > kChunk) flush();
    std::uint8_t* room = chunk_ + used_;
    used_ += size;
    return room;
  }
  std::uint64_t finish() {
    flush();
    return XXH3_64bits_digest(&state_);
  }

 private:
  static constexpr unsigned kChunk = 8192;

  void flush() {
    XXH3_64bits_update(&state_, chunk_, used_);
    used_ = 0;
  }

  XXH3_state_t state_;
  unsigned used_ = 0;
  alignas(64) std::uint8_t chunk_[kChunk];
};

/// The hash of one record.
template <class T>
std::uint64_t hashOf(const T& record) {
  HashSink sink;
  CanonicalWriter<HashSink> write(sink);
  write.put(record);
  return sink.finish();
}

}  // namespace samestep
