// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <samestep/counted.h>
#include <samestep/id.h>
#include <samestep/vector.h>

namespace samestep {

template <unsigned kSize>
[[gnu::always_inline]] inline void storeLittleEndian(std::uint8_t* to, std::uint64_t value) {
  if constexpr (std::endian::native == std::endian::little) {
    // This stores the same bytes; compilers do not always see that the loop is one store.
    std::memcpy(to, &value, kSize);
  } else {
    for (unsigned i = 0; i < kSize; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
}

template <unsigned kSize>
[[gnu::always_inline]] inline std::uint64_t loadLittleEndian(const std::uint8_t* from) {
  std::uint64_t value = 0;
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(&value, from, kSize);
  } else {
    for (unsigned i = 0; i < kSize; ++i) value |= std::uint64_t{from[i]} << (8 * i);
  }
  return value;
}

/// Turns fields into their canonical little-endian bytes. `Sink` has `std::uint8_t* reserve(unsigned size)`,
/// which answers room for that many bytes, at most 16; or `store<size>(std::uint64_t value)`, which takes
/// each plain number, as unsigned, with its size in bytes.
template <class Sink>
class CanonicalWriter {
 public:
  explicit CanonicalWriter(Sink& sink) : sink_(sink) {}

  template <class T>
  void operator()(const char*, const T& value) {
    put(value);
  }

  void put(std::uint8_t value) { store<1>(value); }
  void put(std::uint16_t value) { store<2>(value); }
  void put(std::uint32_t value) { store<4>(value); }
  void put(std::int32_t value) { store<4>(static_cast<std::uint32_t>(value)); }
  void put(std::uint64_t value) { store<8>(value); }
  void put(std::int64_t value) { store<8>(static_cast<std::uint64_t>(value)); }
  void put(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    store<8>(bits);
  }
  template <class Overflow>
  void put(const BasicFixed<std::int64_t, 32, Overflow>& value) {
    put(value.raw());
  }
  template <Scalar S>
  void put(const Vector<S>& value) {
    if constexpr (std::endian::native == std::endian::little && requires { sink_.reserve(16u); }) {
      // This stores the same bytes in one go.
      static_assert(sizeof value == 16);
      std::memcpy(sink_.reserve(sizeof value), &value, sizeof value);
    } else {
      put(value.x);
      put(value.y);
    }
  }
  template <class Tag>
  void put(const Id<Tag>& value) {
    put(value.index);
    put(value.generation);
  }
  template <class T>
  requires std::is_enum_v<T>
  void put(T value) { put(static_cast<std::underlying_type_t<T>>(value)); }
  template <class T>
  void put(const Counted<T>& field) {
    for (std::uint32_t i = 0; i < field.count; ++i) put(field.values[i]);
  }
  /// A number with mantissa and exponent.
  template <class T>
  requires requires(const T& t) {
    t.mantissa();
    t.exponent();
  }
  void put(const T& value) {
    put(value.mantissa());
    put(value.exponent());
  }
  /// A record with fields of its own.
  template <class T>
  requires requires(const T& t, CanonicalWriter& w) { T::fields(t, w); }
  void put(const T& value) { T::fields(value, *this); }

 private:
  template <unsigned kSize>
  void store(std::uint64_t value) {
    if constexpr (requires { sink_.template store<kSize>(value); }) {
      sink_.template store<kSize>(value);
    } else {
      storeLittleEndian<kSize>(sink_.reserve(kSize), value);
    }
  }

  Sink& sink_;
};

}  // namespace samestep
