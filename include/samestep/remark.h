// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace samestep {

/// Warnings that the engine gives without refusing the call: those of the MIS first, then our own.
enum class Remark : std::uint8_t {
  HighIterWarning,
  NotBBTreeWarn,
  OtherKernel,                ///< See Space::setKernel.
  FewerWorkers,               ///< A WorkerPool got fewer threads than it was to have.
  MoreWorkersThanProcessors,  ///< A WorkerPool has more threads than the machine runs at once.
};
inline constexpr std::size_t kRemarkKinds = 5;

/// Counts remarks and passes each on to a log hook, if there is one. The library itself never prints.
/// Not part of the simulated state.
struct Remarks {
  /// Function that is called on the stepping thread. The text lives for the call only.
  using Hook = void (*)(Remark remark, const char* text, void* context);

  std::array<std::uint64_t, kRemarkKinds> counts{};
  Hook hook = nullptr;
  void* context = nullptr;

  std::uint64_t count(Remark remark) const { return counts[static_cast<std::size_t>(remark)]; }

  /// MIS: assertWarn
  void raise(Remark remark, const char* text) {
    ++counts[static_cast<std::size_t>(remark)];
    if (hook != nullptr) hook(remark, text, context);
  }
};

}  // namespace samestep
