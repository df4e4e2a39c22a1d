#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "samestep/fixed.h"

namespace samestep {

/// The largest magnitude that one named formula has had.
struct HighWaterMark {
  std::string_view name;
  std::uint64_t raw = 0;  ///< in units of 2^-fractionBits
  int fractionBits = 0;
  std::uint64_t count = 0;  ///< how often the formula was evaluated

  double value() const {
    return static_cast<double>(raw) / static_cast<double>(std::uint64_t{1} << fractionBits);
  }
};

/// The marks of the program, in the order of their first use. Not safe for several threads.
class HighWaterTable {
 public:
  static constexpr int kCapacity = 256;

  /// @return false where the table is full and the name is new
  bool record(std::string_view name, std::uint64_t magnitude, int fractionBits) {
    HighWaterMark* const mark = find(name);
    if (mark == nullptr) return false;
    mark->fractionBits = fractionBits;
    if (magnitude > mark->raw) mark->raw = magnitude;
    ++mark->count;
    return true;
  }
  std::span<const HighWaterMark> marks() const { return {marks_.data(), static_cast<std::size_t>(count_)}; }
  void clear() { count_ = 0; }

 private:
  HighWaterMark* find(std::string_view name) {
    for (int i = 0; i < count_; ++i) {
      if (marks_[static_cast<std::size_t>(i)].name == name) return &marks_[static_cast<std::size_t>(i)];
    }
    if (count_ == kCapacity) return nullptr;
    HighWaterMark& added = marks_[static_cast<std::size_t>(count_++)];
    added = {};
    added.name = name;
    return &added;
  }

  std::array<HighWaterMark, kCapacity> marks_{};
  int count_ = 0;
};

inline HighWaterTable& highWaterTable() {
  static HighWaterTable table;
  return table;
}

/// Notes the value of a formula: `highWater<S>("normal mass", mass)`. Only checked numbers are recorded; for
/// every other S the call compiles to nothing.
/// @param name  must outlive the table: a string literal
template <class S>
constexpr void highWater([[maybe_unused]] std::string_view name, [[maybe_unused]] S value) {
  if constexpr (requires { requires S::kChecks; }) {
    if (!std::is_constant_evaluated()) highWaterTable().record(name, raw::magnitude(value.raw()), S::kBits);
  }
}

}  // namespace samestep
