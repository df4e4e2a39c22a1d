// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

#include <samestep/error.h>
#include <samestep/id.h>
#include <samestep/vector.h>

#include "state/canonical.h"

namespace samestep {

/// Bytes from outside, taken from the front, never past their end.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes, std::uint64_t offset = 0)
      : bytes_(bytes), offset_(offset) {}

  std::uint64_t offset() const { return offset_; }
  std::uint64_t remaining() const { return bytes_.size() - offset_; }
  [[noreturn]] void fail(const char* reason) const { failFormat(offset_, reason); }
  void require(bool condition, const char* reason) const {
    if (!condition) fail(reason);
  }

  /// Names fields that the bytes, of an earlier format, do not have: FieldReader leaves those as they are.
  void setLacking(std::span<const char* const> names) { lacking_ = names; }
  bool lacks(std::string_view name) const {
    if (lacking_.empty()) [[likely]]
      return false;
    return std::find(lacking_.begin(), lacking_.end(), name) != lacking_.end();
  }

  /// @throws FormatError where fewer are left
  std::span<const std::uint8_t> take(std::uint64_t count) {
    require(count <= remaining(), "cut short");
    const auto taken = bytes_.subspan(static_cast<std::size_t>(offset_), static_cast<std::size_t>(count));
    offset_ += count;
    return taken;
  }
  template <unsigned kSize>
  std::uint64_t load() {
    return loadLittleEndian<kSize>(take(kSize).data());
  }
  /// Bytes that are left.
  std::span<const std::uint8_t> rest() const { return bytes_.subspan(static_cast<std::size_t>(offset_)); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::uint64_t offset_;
  std::span<const char* const> lacking_;
};

/// The inverse of CanonicalWriter, by the same fields() lists. Numbers are taken as they come, but those with
/// mantissa and exponent must be normalised; whether a record makes sense is for its reader to find out.
/// `Source` has `std::uint64_t load<size>()` for the next plain number, and offset().
template <class Source>
class FieldReader {
 public:
  explicit FieldReader(Source& source) : source_(source) {}

  template <class T>
  void operator()(const char* name, T& value) {
    if constexpr (requires { source_.lacks(name); }) {
      if (source_.lacks(name)) [[unlikely]]
        return;
    }
    get(value);
  }

  void get(std::uint8_t& value) { value = static_cast<std::uint8_t>(load<1>()); }
  void get(std::uint16_t& value) { value = static_cast<std::uint16_t>(load<2>()); }
  void get(std::uint32_t& value) { value = static_cast<std::uint32_t>(load<4>()); }
  void get(std::int32_t& value) { value = static_cast<std::int32_t>(load<4>()); }
  void get(std::uint64_t& value) { value = load<8>(); }
  void get(std::int64_t& value) { value = static_cast<std::int64_t>(load<8>()); }
  void get(double& value) {
    const std::uint64_t bits = load<8>();
    std::memcpy(&value, &bits, sizeof value);
  }
  template <class Overflow>
  void get(BasicFixed<std::int64_t, 32, Overflow>& value) {
    value = BasicFixed<std::int64_t, 32, Overflow>::fromRaw(next<std::int64_t>());
  }
  template <Scalar S>
  void get(Vector<S>& value) {
    get(value.x);
    get(value.y);
  }
  template <class Tag>
  void get(Id<Tag>& value) {
    get(value.index);
    get(value.generation);
  }
  template <class T>
  requires std::is_enum_v<T>
  void get(T& value) { value = static_cast<T>(next<std::underlying_type_t<T>>()); }
  template <class T, std::size_t kCount>
  void get(T (&values)[kCount]) {
    for (T& value : values) get(value);
  }
  /// A number with mantissa and exponent.
  template <class T>
  requires requires(const T& t) {
    t.mantissa();
    t.exponent();
  }
  void get(T& value) {
    const std::uint64_t start = source_.offset();
    const auto mantissa = next<std::int64_t>();
    const auto exponent = next<std::int64_t>();
    if (!T::isValid(mantissa, exponent)) failFormat(start, "not a normalised number");
    value = T::fromParts(mantissa, exponent);
  }
  /// A record with fields of its own.
  template <class T>
  requires requires(T& t, FieldReader& r) { T::fields(t, r); }
  void get(T& value) { T::fields(value, *this); }

  template <class T>
  T next() {
    T value{};
    get(value);
    return value;
  }

 private:
  template <unsigned kSize>
  std::uint64_t load() {
    return source_.template load<kSize>();
  }

  Source& source_;
};

/// Reader of canonical bytes.
using CanonicalReader = FieldReader<ByteReader>;

}  // namespace samestep
