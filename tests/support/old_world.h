// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <samestep/state.h>

#include "snapshot/world_formats.h"
#include "state/compact.h"

namespace samestep {

/// Writes worlds as format 1 had them, without what came later, for tests of old recordings.
class OldWorldWriter {
 public:
  explicit OldWorldWriter(std::vector<std::uint8_t>& out) : out_(out) {}

  template <class T>
  void operator()(const char* name, const T& field) {
    if (!lacks(name)) addPlain(numbersOf(field));
  }
  template <class T, class IdType>
  void operator()(const Section& section, const SlotMap<T, IdType>& records) {
    if (lacks(section.object)) return;
    addPlain(numbersOf(records.slots()));
    CompactNumbers before{};
    for (std::uint32_t i = 0; i < records.slots(); ++i) {
      Numbers numbers = numbersOf(records.generationAt(i));
      if (records.aliveAt(i)) addRecord(numbers, records.valueAt(i));
      addCompact(numbers, before);
    }
  }
  template <class T>
  void operator()(const Section& section, const std::vector<T>& records) {
    if (lacks(section.object)) return;
    addPlain(numbersOf(static_cast<std::uint64_t>(records.size())));
    CompactNumbers before{};
    for (const T& record : records) {
      Numbers numbers;
      addRecord(numbers, record);
      addCompact(numbers, before);
    }
  }

 private:
  /// A number and its bytes.
  using Numbers = std::vector<std::pair<std::uint64_t, unsigned>>;
  struct NumberSink {
    Numbers& numbers;
    template <unsigned kSize>
    void store(std::uint64_t value) {
      numbers.push_back({value, kSize});
    }
  };
  struct RecordVisitor {
    Numbers& numbers;
    template <class T>
    void operator()(const char* name, const T& field) {
      if (lacks(name)) return;
      NumberSink sink{numbers};
      CanonicalWriter<NumberSink>(sink).put(field);
    }
  };

  static bool lacks(std::string_view name) {
    return std::find(std::begin(kSince2), std::end(kSince2), name) != std::end(kSince2);
  }
  template <class T>
  static void addRecord(Numbers& numbers, const T& record) {
    RecordVisitor visitor{numbers};
    T::fields(record, visitor);
  }
  template <class T>
  static Numbers numbersOf(const T& field) {
    Numbers numbers;
    if constexpr (requires(RecordVisitor & v) { T::fields(field, v); }) {
      addRecord(numbers, field);
    } else {
      NumberSink sink{numbers};
      CanonicalWriter<NumberSink>(sink).put(field);
    }
    return numbers;
  }
  void addBytes(std::uint64_t value, unsigned size) {
    for (unsigned i = 0; i < size; ++i) out_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  void addPlain(const Numbers& numbers) {
    for (const auto& [value, size] : numbers) addBytes(value, size);
  }
  void addCompact(const Numbers& numbers, CompactNumbers& before) {
    std::uint64_t oneBack = 0, twoBack = 0;
    for (std::size_t begin = 0; begin < numbers.size(); begin += kCompactGroup) {
      const std::size_t end = std::min<std::size_t>(numbers.size(), begin + kCompactGroup);
      const std::size_t codesAt = out_.size();
      addBytes(0, kCompactCodeBytes);
      std::uint32_t codes = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const auto& [value, size] = numbers[i];
        const unsigned code = compactCode(value, before[i], twoBack);
        before[i] = value;
        twoBack = std::exchange(oneBack, value);
        codes |= code << (2 * (i - begin));
        if (code == static_cast<unsigned>(CompactCode::given)) addBytes(value, size);
      }
      out_[codesAt] = static_cast<std::uint8_t>(codes);
      out_[codesAt + 1] = static_cast<std::uint8_t>(codes >> 8);
    }
  }

  std::vector<std::uint8_t>& out_;
};

}  // namespace samestep
