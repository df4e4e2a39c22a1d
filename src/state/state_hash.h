// SPDX-License-Identifier: MIT
#pragma once

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdint>

#include <samestep/kernel.h>

#include "state/canonical.h"
#include "state/hash_update.h"

namespace samestep {

/// Hashes records: XXH3-64 of their canonical bytes, the same value on every machine.
class HashSink {
 public:
  /// @param target  whose instructions are used, if it is available: no hash depends on it
  explicit HashSink(KernelTarget target = KernelTarget::best);

  template <class T>
  [[gnu::flatten]] void put(const T& record) {
    // No field is visited twice, so the canonical bytes are no more than the record's own and what it holds
    // outside. They are written through a pointer that stays in a register.
    constexpr unsigned kMost = mostBytes<T>();
    static_assert(kMost <= kChunk);
    if (kChunk - used_ < kMost) flush();
    Pointer pointer{chunk_ + used_};
    CanonicalWriter<Pointer> write(pointer);
    write.put(record);
    used_ = static_cast<unsigned>(pointer.to - chunk_);
  }
  std::uint64_t finish();

 private:
  struct Pointer {
    std::uint8_t* to;
    std::uint8_t* reserve(unsigned size) {
      std::uint8_t* room = to;
      to += size;
      return room;
    }
  };
  static constexpr unsigned kChunk = 8192;

  template <class T>
  static constexpr unsigned mostBytes() {
    if constexpr (requires { T::kBytesOutside; }) {
      return sizeof(T) + T::kBytesOutside;
    } else {
      return sizeof(T);
    }
  }
  void flush();

  XXH3_state_t state_;
  HashUpdate update_;
  unsigned used_ = 0;
  alignas(64) std::uint8_t chunk_[kChunk];
};

/// The hash of one record.
template <class T>
std::uint64_t hashOf(const T& record) {
  HashSink sink;
  sink.put(record);
  return sink.finish();
}

/// The hash of all shapes, which change seldom: a Space keeps it until they do.
template <class Shapes>
std::uint64_t hashOfShapes(const Shapes& shapes) {
  HashSink sink;
  writeSlots(sink, shapes);
  return sink.finish();
}

/// The hash of a world whose shapes have that hash.
template <class World>
std::uint64_t hashOfWorld(const World& world, std::uint64_t shapesHash) {
  HashSink sink;
  writeFrame(sink, world);
  writeSlots(sink, world.bodies);
  sink.put(shapesHash);
  writeList(sink, world.pairs);
  writeList(sink, world.handlers);
  return sink.finish();
}

}  // namespace samestep
