// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <samestep/player.h>
#include <samestep/replay.h>

namespace samestep {

/// Result of replaying a recording.
struct VerifyResult {
  bool matches = false;
  /// True if options.progress or options.interrupt put an end to it; firstWrongTick then means nothing.
  bool stopped = false;
  /// Steps in the recording.
  std::uint64_t ticks = 0;
  /// The first step after which the world's hash is not the recorded one; 0 for the world before the first.
  std::uint64_t firstWrongTick = 0;
  std::uint64_t recordedHash = 0;  ///< Hash recorded for that step, or the last one.
  std::uint64_t computedHash = 0;
  /// Name of the expectation that is not met, where matches is false for that: "the time step", "the scalar",
  /// "the number of steps", "the step it begins after", "the first world", "a command: position"; else null.
  const char* unexpected = nullptr;
  /// Offset of the command that is not allowed.
  std::uint64_t unexpectedOffset = 0;
  /// True if it is a keyframe that is not the world after firstWrongTick, though its hash is that.
  bool keyframeDiffers = false;
  /// Claims that the game found to hold, found false, and does not know. With a false one, matches is false.
  std::uint64_t claimsThatHold = 0;
  std::uint64_t claimsThatAreFalse = 0;
  std::uint64_t claimsUnknown = 0;
  /// The first one of those.
  std::optional<ClaimAt> falseClaim;
  /// Number of steps, with VerifyOptions::toTheEnd, whose hash is not the recorded one, and the last of them:
  /// where it is not the last of all, the worlds agreed again.
  std::uint64_t wrongTicks = 0;
  std::uint64_t lastWrongTick = 0;
  /// True if the recording was cut, and only as many steps as `ticks` were there; see VerifyOptions::ending.
  bool cut = false;
  /// Number of steps whose hash was compared; fewer than `ticks` where only a sample was.
  std::uint64_t ticksCompared = 0;
  /// True if stretches were left out, so that matches says nothing of them; see VerifyOptions::sample.
  bool sampled = false;
};

/// Expectations of a match, told by whoever gave it out, not by the recording: by itself a recording shows
/// only that its own hashes follow from its own world and commands. See docs/replays.md.
struct Expectations {
  /// Hash of the world before the first step: its bodies, settings, handlers, all of it.
  std::optional<std::uint64_t> firstHash;
  /// The time step is 1 s over it, rounded once.
  std::optional<std::uint32_t> stepsPerSecond;
  std::optional<ScalarKind> scalar;
  std::optional<std::uint64_t> ticks;
  /// Steps that the first world had made; in a match recorded from its start, 0.
  std::optional<std::uint64_t> firstTick;
  /// A bit (1 << kind) for each CommandKind that a player may give.
  std::uint32_t commands = (1u << kCommandKinds) - 1;
};

/// A day at 60 Hz.
inline constexpr std::uint64_t kMostFirstTick = 24 * 60 * 60 * 60;

/// Options of verify.
struct VerifyOptions {
  /// Limits for recordings from strangers, what the game's own matches need: the pairs bound the memory and
  /// the time of a step.
  RecordingLimits limits{};
  Expectations expected{};
  /// Goes on after a mismatch, to see whether it heals.
  bool toTheEnd = false;
  /// Tells whether a recording that ends too early is refused, or replayed as far as it goes.
  Ending ending = Ending::whole;
  /// A recording whose world had made more steps before is refused.
  std::uint64_t mostFirstTick = kMostFirstTick;
  /// Number of stretches from keyframe to keyframe, of 100, that are replayed, each from its keyframe, which
  /// must have the hash recorded for its step; one at least is. Such a stretch proves the keyframe at its end
  /// if the one at its start is true: a recording made up by joining two is found where they are joined, and
  /// nowhere else.
  std::uint32_t sample = 100;
  /// Number that they are drawn by: whoever knows it when he makes a recording knows where nobody will look.
  std::uint64_t sampleSeed = 0;
  /// Function that is called after every step; false stops, as for a recording that takes too long. Null for
  /// none.
  bool (*progress)(std::uint64_t done, std::uint64_t total, void* data) = nullptr;
  void* data = nullptr;
  /// Function that is asked far more often, so that a recording that takes too long ends within a tenth of a
  /// second: see Replay.
  Interrupt interrupt{};
  /// Workers that help with all that can be shared out, and the kernel, which is forced: no result depends on
  /// either.
  TaskRunner* workers = nullptr;
  KernelTarget kernel = KernelTarget::best;
};

/// Replays a recording, compares the hash of every step and each keyframe, and asks the wiring about claims.
/// Keyframes are never taken for what they say. A mismatch is a result, not an error.
/// @throws FormatError, MissingCallback, KernelUnavailable
template <Scalar S>
VerifyResult verify(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring,
                    const VerifyOptions& options = {});
/// Verifies a recording of either scalar whose handlers are the named ones.
/// @throws FormatError also for a scalar that this build lacks
VerifyResult verify(std::span<const std::uint8_t> bytes, const VerifyOptions& options = {});

}  // namespace samestep
