// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <samestep/replay.h>

namespace samestep {

/// What replaying a recording showed.
struct VerifyResult {
  bool matches = false;
  /// Whether options.progress put an end to it; firstWrongTick then means nothing.
  bool stopped = false;
  /// Steps in the recording.
  std::uint64_t ticks = 0;
  /// The first step after which the world's hash is not the recorded one; 0 for the world before the first.
  std::uint64_t firstWrongTick = 0;
  std::uint64_t recordedHash = 0;  ///< For that step, or the last one.
  std::uint64_t computedHash = 0;
};

/// How verify goes about it.
struct VerifyOptions {
  /// For recordings from strangers, what the game's own matches need: the pairs bound the memory and the time
  /// of a step.
  WorldLimits limits{};
  /// Called after every step; false stops, as for a recording that takes too long. Null for none.
  bool (*progress)(std::uint64_t done, std::uint64_t total, void* data) = nullptr;
  void* data = nullptr;
  /// Who helps, with all that can be shared out, and the kernel, which is forced: no result depends on
  /// either.
  TaskRunner* workers = nullptr;
  KernelTarget kernel = KernelTarget::best;
};

/// Replays a recording and compares the hash of every step. A mismatch is a result, not an error.
/// @throws FormatError, MissingCallback, KernelUnavailable
template <Scalar S>
VerifyResult verify(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring,
                    const VerifyOptions& options = {});
/// The same for a recording of either scalar whose handlers are the named ones.
/// @throws FormatError also for a scalar that this build lacks
VerifyResult verify(std::span<const std::uint8_t> bytes, const VerifyOptions& options = {});

}  // namespace samestep
