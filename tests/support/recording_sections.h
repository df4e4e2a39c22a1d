// SPDX-License-Identifier: MIT
#pragma once

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstddef>
#include <cstdint>
#include <vector>

// Recordings taken apart and put together again by hand, by docs/formats.md alone, with all hashes as they
// should be: what a forger does.

namespace samestep {

namespace by_hand {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kHeaderBytes = 28;
constexpr std::uint8_t kKeyframe = 1, kTicks = 2, kNotes = 3, kIndex = 4, kEnd = 5, kPacked = 0x80;

inline std::uint64_t getNumber(const Bytes& bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{bytes[at + i]} << (8 * i);
  return value;
}
inline void setNumber(Bytes& bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}
inline void addNumber(Bytes& bytes, std::uint64_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

struct Section {
  std::uint8_t kind = 0;
  std::uint32_t unpacked = 0;  ///< Size unpacked, where kind has kPacked.
  Bytes payload;
};

struct Recording {
  Bytes header;
  std::vector<Section> sections;
};

/// @pre a whole recording of version 3
inline Recording takeApart(const Bytes& bytes) {
  Recording parts;
  parts.header.assign(bytes.begin(), bytes.begin() + kHeaderBytes);
  for (std::size_t at = kHeaderBytes; at < bytes.size();) {
    Section& section = parts.sections.emplace_back();
    section.kind = bytes[at];
    const auto length = static_cast<std::size_t>(getNumber(bytes, at + 1, 4));
    const bool packed = (section.kind & kPacked) != 0;
    if (packed) section.unpacked = static_cast<std::uint32_t>(getNumber(bytes, at + 5, 4));
    const std::size_t payload = at + (packed ? 9 : 5);
    section.payload.assign(bytes.begin() + static_cast<std::ptrdiff_t>(payload),
                           bytes.begin() + static_cast<std::ptrdiff_t>(payload + length));
    at = payload + length + 8;
  }
  return parts;
}

/// Writes the chain again from front to back, and with `index` what the index and the end say of places.
inline void mendSections(Bytes& bytes, bool index = true) {
  if (bytes.size() < kHeaderBytes) return;
  std::uint64_t chain = XXH3_64bits(bytes.data(), kHeaderBytes);
  std::vector<std::uint64_t> places, chains;
  std::size_t indexAt = 0;
  for (std::size_t at = kHeaderBytes; at + 5 <= bytes.size();) {
    const std::uint8_t kind = bytes[at] & 0x7f;
    const std::size_t payload = at + ((bytes[at] & kPacked) != 0 ? 9 : 5);
    const std::uint64_t length = getNumber(bytes, at + 1, 4);
    if (payload + length + 8 > bytes.size()) return;
    const std::size_t end = payload + static_cast<std::size_t>(length);
    if (kind == kKeyframe) {
      places.push_back(at);
      chains.push_back(chain);
    }
    if (kind == kIndex) indexAt = at;
    for (std::size_t i = 0; index && kind == kIndex && i < places.size() && 24 * (i + 1) <= length; ++i) {
      setNumber(bytes, payload + 24 * i + 8, places[i], 8);
      setNumber(bytes, payload + 24 * i + 16, chains[i], 8);
    }
    if (index && kind == kEnd && length == 16) setNumber(bytes, payload + 8, indexAt, 8);
    chain = XXH3_64bits_withSeed(bytes.data() + at, end - at, chain);
    setNumber(bytes, end, chain, 8);
    at = end + 8;
  }
}

inline Bytes putTogether(const Recording& parts, bool index = true) {
  Bytes bytes = parts.header;
  for (const Section& section : parts.sections) {
    bytes.push_back(section.kind);
    addNumber(bytes, section.payload.size(), 4);
    if ((section.kind & kPacked) != 0) addNumber(bytes, section.unpacked, 4);
    bytes.insert(bytes.end(), section.payload.begin(), section.payload.end());
    addNumber(bytes, 0, 8);
  }
  mendSections(bytes, index);
  return bytes;
}

}  // namespace by_hand

/// Writes the hashes again that a recording of either version carries of its own bytes, after something was
/// changed.
inline void mendRecording(by_hand::Bytes& bytes, bool index = true) {
  if (bytes.size() < 12) return;
  if (bytes[8] != 2) return by_hand::mendSections(bytes, index);
  const std::size_t at = bytes.size() - 8;
  by_hand::setNumber(bytes, at, XXH3_64bits(bytes.data(), at), 8);
}

}  // namespace samestep
