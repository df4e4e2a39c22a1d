// SPDX-License-Identifier: MIT
// Bytes of packets, written and read within bounds.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

namespace samestep::lockstep {

/// Writes into a buffer and remembers whether all of it fitted.
class PacketWriter {
 public:
  explicit PacketWriter(std::span<std::uint8_t> into) : into_(into) {}

  void u8(std::uint8_t value) {
    if (std::uint8_t* to = room(1)) *to = value;
  }
  void u16(std::uint16_t value) { number<2>(value); }
  void u32(std::uint32_t value) { number<4>(value); }
  void u64(std::uint64_t value) { number<8>(value); }
  /// 7 bits a byte, the lowest first.
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) u8(static_cast<std::uint8_t>(value | 0x80));
    u8(static_cast<std::uint8_t>(value));
  }
  void bytes(std::span<const std::uint8_t> source) {
    std::uint8_t* to = room(static_cast<std::uint32_t>(source.size()));
    if (to != nullptr && !source.empty()) std::memcpy(to, source.data(), source.size());
  }

  /// True if everything fitted.
  bool good() const { return good_; }
  std::uint32_t size() const { return size_; }
  std::uint32_t left() const { return static_cast<std::uint32_t>(into_.size()) - size_; }
  std::span<const std::uint8_t> written() const { return into_.first(size_); }

 private:
  template <unsigned kSize>
  void number(std::uint64_t value) {
    std::uint8_t* to = room(kSize);
    for (unsigned i = 0; to != nullptr && i < kSize; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
  std::uint8_t* room(std::uint32_t bytes) {
    if (!good_ || bytes > left()) {
      good_ = false;
      return nullptr;
    }
    std::uint8_t* to = into_.data() + size_;
    size_ += bytes;
    return to;
  }

  std::span<std::uint8_t> into_;
  std::uint32_t size_ = 0;
  bool good_ = true;
};

/// Reads bytes from outside. What is not there reads as 0 and makes the reader bad for good, so that a
/// decoder asks once, at its end.
class PacketReader {
 public:
  explicit PacketReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint8_t u8() { return static_cast<std::uint8_t>(number<1>()); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(number<2>()); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number<4>()); }
  std::uint64_t u64() { return number<8>(); }
  /// At most `most`; a larger one is bad.
  std::uint64_t varint(std::uint64_t most) {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 63; shift += 7) {
      const std::uint8_t byte = u8();
      value |= std::uint64_t{byte & 0x7fu} << shift;
      if (byte < 0x80) {
        if (value > most) good_ = false;
        return good_ ? value : 0;
      }
    }
    good_ = false;
    return 0;
  }
  std::span<const std::uint8_t> bytes(std::uint64_t count) {
    if (!good_ || count > left()) {
      good_ = false;
      return {};
    }
    const auto found = bytes_.subspan(offset_, static_cast<std::uint32_t>(count));
    offset_ += static_cast<std::uint32_t>(count);
    return found;
  }

  bool good() const { return good_; }
  /// True if nothing was missing and nothing is left over.
  bool done() const { return good_ && left() == 0; }
  std::uint32_t left() const { return static_cast<std::uint32_t>(bytes_.size()) - offset_; }
  std::uint32_t offset() const { return offset_; }
  void fail() { good_ = false; }

 private:
  template <unsigned kSize>
  std::uint64_t number() {
    if (!good_ || left() < kSize) {
      good_ = false;
      return 0;
    }
    std::uint64_t value = 0;
    for (unsigned i = 0; i < kSize; ++i) value |= std::uint64_t{bytes_[offset_ + i]} << (8 * i);
    offset_ += kSize;
    return value;
  }

  std::span<const std::uint8_t> bytes_;
  std::uint32_t offset_ = 0;
  bool good_ = true;
};

}  // namespace samestep::lockstep
