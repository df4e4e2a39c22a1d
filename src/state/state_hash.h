// SPDX-License-Identifier: MIT
#pragma once

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdint>
#include <vector>

#include <samestep/kernel.h>
#include <samestep/state.h>

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

/// Hashes the sections of a world. The shapes stand in it as a hash of their own: they change seldom, and a
/// Space keeps theirs until they do.
class SectionHash {
 public:
  explicit SectionHash(std::uint64_t shapesHash = 0) : shapesHash_(shapesHash) {}

  template <class T>
  void operator()(const char*, const T& field) {
    sink_.put(field);
  }
  template <class T, class IdType>
  void operator()(const Section&, const SlotMap<T, IdType>& records) {
    slots(records);
  }
  template <Scalar S>
  void operator()(const Section&, const SlotMap<Shape<S>, ShapeId>&) {
    sink_.put(shapesHash_);
  }
  template <class T>
  void operator()(const Section&, const std::vector<T>& records) {
    sink_.put(static_cast<std::uint64_t>(records.size()));
    for (const T& record : records) sink_.put(record);
  }
  template <class T, class IdType>
  void slots(const SlotMap<T, IdType>& records) {
    sink_.put(records.slots());
    for (std::uint32_t i = 0; i < records.slots(); ++i) {
      sink_.put(records.generationAt(i));
      if (records.aliveAt(i)) sink_.put(records.valueAt(i));
    }
  }
  std::uint64_t finish() { return sink_.finish(); }

 private:
  HashSink sink_;
  std::uint64_t shapesHash_;
};

/// The hash of all shapes.
template <Scalar S>
std::uint64_t hashOfShapes(const SlotMap<Shape<S>, ShapeId>& shapes) {
  SectionHash hash;
  hash.slots(shapes);
  return hash.finish();
}

/// The hash of a world whose shapes have that hash.
template <Scalar S>
std::uint64_t hashOfWorld(const WorldState<S>& world, std::uint64_t shapesHash) {
  SectionHash hash(shapesHash);
  WorldState<S>::sections(hash, world);
  return hash.finish();
}

}  // namespace samestep
