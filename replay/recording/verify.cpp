// SPDX-License-Identifier: MIT
#include <samestep/verify.h>

#include <samestep/named_handlers.h>

#include "base/require_ieee.h"
#include "recording/recording_format.h"
#include "state/state_hash.h"

namespace samestep {

namespace {

/// Name of what the first bytes and the first world have that was not expected; null for nothing.
template <Scalar S>
const char* unexpectedIn(const Replay<S>& replay, const Expectations& expected) {
  if (expected.scalar && *expected.scalar != ScalarTraits<S>::kKind) return "the scalar";
  if (expected.stepsPerSecond) {
    const std::uint32_t rate = *expected.stepsPerSecond;
    require<Fault::ValueOutOfRange>(rate > 0 && rate <= 1000000, "steps per second are ", rate,
                                    ", allowed are 1 to 1000000");
    if (replay.timeStep() != ratio<S>(1, static_cast<int>(rate))) return "the time step";
  }
  if (expected.ticks && *expected.ticks != replay.ticks()) return "the number of steps";
  if (expected.firstTick && *expected.firstTick != replay.space().stamp()) return "the step it begins after";
  if (expected.firstHash && *expected.firstHash != replay.space().hash()) return "the first world";
  return nullptr;
}

/// Looks out for commands that are not allowed.
template <Scalar S>
struct CommandWatch {
  std::uint32_t allowed;
  VerifyResult& result;

  static const char* sentence(CommandKind kind) {
    constexpr const char* kSentences[kCommandKinds] = {
        "a command: impulse",  "a command: force", "a command: velocity", "a command: angularVelocity",
        "a command: position", "a command: angle", "a command: spawn",    "a command: remove",
        "a command: input",    "a command: join",  "a command: adjust",   "a command: unjoin"};
    return kSentences[static_cast<std::size_t>(kind)];
  }
  static bool filter(const Command<S>& command, std::uint64_t offset, void* data) {
    auto& self = *static_cast<CommandWatch*>(data);
    const CommandKind kind = kindOf(command);
    if ((self.allowed >> static_cast<unsigned>(kind) & 1u) != 0) return true;
    self.result.unexpected = sentence(kind);
    self.result.unexpectedOffset = offset;
    return false;
  }
};

/// Compares each keyframe with the world that it stands for.
template <Scalar S>
class KeyframeWatch {
 public:
  explicit KeyframeWatch(std::size_t next = 0) : next_(next) {}
  /// True if there is none for the world as it is now, or it is that world.
  bool agrees(const Replay<S>& replay) {
    const auto keyframes = replay.reader().keyframes();
    if (next_ == keyframes.size() || keyframes[next_].tick != replay.tick()) return true;
    return replay.reader().isWorld(next_++, replay.space().state());
  }

 private:
  std::size_t next_;
};

/// Tells whether the world is as recorded; notes the first one that is not, and how it goes on.
template <Scalar S>
bool compare(const Replay<S>& replay, KeyframeWatch<S>& keyframes, VerifyResult& result) {
  const std::uint64_t recorded = replay.recordedHash();
  const std::uint64_t computed = replay.space().hash();
  const bool keyframeAgrees = keyframes.agrees(replay);
  const bool same = recorded == computed && keyframeAgrees;
  if (result.wrongTicks == 0) {
    result.recordedHash = recorded;
    result.computedHash = computed;
  }
  if (same) return true;
  if (result.wrongTicks++ == 0) {
    result.firstWrongTick = replay.tick();
    result.keyframeDiffers = recorded == computed;
  }
  result.lastWrongTick = replay.tick();
  return false;
}

template <Scalar S>
void checkClaims(Replay<S>& replay, const Wiring<S>& wiring, VerifyResult& result) {
  while (const Claim* claim = replay.nextClaim()) {
    const ClaimCheck check = wiring.checkClaim == nullptr
                                 ? ClaimCheck::unknown
                                 : wiring.checkClaim(replay.space(), claim->key, claim->value, wiring.data);
    if (check == ClaimCheck::holds) ++result.claimsThatHold;
    if (check == ClaimCheck::unknown) ++result.claimsUnknown;
    if (check != ClaimCheck::isFalse) continue;
    ++result.claimsThatAreFalse;
    if (result.falseClaim) continue;
    result.falseClaim = ClaimAt{replay.tick(), std::string(claim->key), {}};
    result.falseClaim->value.assign(claim->value.begin(), claim->value.end());
  }
}

/// Replays on to a step, comparing each. False where it ends before: at a mismatch, or as it is told to.
template <Scalar S>
bool verifyUpTo(std::uint64_t tick, Replay<S>& replay, KeyframeWatch<S> keyframes, const Wiring<S>& wiring,
                const VerifyOptions& options, VerifyResult& result) {
  while (true) {
    if (!compare(replay, keyframes, result) && !options.toTheEnd) return false;
    checkClaims(replay, wiring, result);
    if (options.progress != nullptr && !options.progress(replay.tick(), replay.ticks(), options.data)) {
      result.stopped = true;
      return false;
    }
    if (replay.tick() == tick || !replay.step()) return result.unexpected == nullptr;
    ++result.ticksCompared;
  }
}

/// True if a stretch is among those of the sample.
bool isDrawn(const VerifyOptions& options, std::size_t stretch, std::size_t stretches) {
  const auto drawn = [&](std::uint64_t number) {
    std::uint8_t bytes[8];
    for (int i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(number >> (8 * i));
    return XXH3_64bits_withSeed(bytes, sizeof bytes, options.sampleSeed);
  };
  return drawn(stretch) % 100 < options.sample || drawn(~std::uint64_t{0}) % stretches == stretch;
}

/// Replays the stretches of the sample.
template <Scalar S>
void verifySample(Replay<S>& replay, const Wiring<S>& wiring, const VerifyOptions& options,
                  VerifyResult& result) {
  const std::span<const Keyframe> keyframes = replay.reader().keyframes();
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (!isDrawn(options, i, keyframes.size())) {
      result.sampled = true;
      continue;
    }
    if (replay.tick() != keyframes[i].tick) replay.seek(keyframes[i].tick);
    const std::uint64_t end = i + 1 < keyframes.size() ? keyframes[i + 1].tick : replay.ticks();
    if (!verifyUpTo(end, replay, KeyframeWatch<S>(i), wiring, options, result)) return;
  }
}

/// Replays all of it, or a sample.
template <Scalar S>
void verifyInto(VerifyResult& result, std::span<const std::uint8_t> bytes, const Wiring<S>& wiring,
                const VerifyOptions& options) {
  Replay<S> replay(bytes, wiring, options.limits, options.interrupt, options.ending);
  replay.space().forceKernel(options.kernel);
  replay.space().setWorkers(options.workers, Sharing::always);
  result.ticks = replay.ticks();
  result.cut = !replay.reader().isWhole();
  if (replay.space().stamp() > options.mostFirstTick)
    failFormat(kWorldAt, "begins after more steps than allowed");
  require<Fault::ValueOutOfRange>(options.sample >= 1 && options.sample <= 100, "a sample is of ",
                                  options.sample, " in 100, allowed are 1 to 100");
  result.unexpected = unexpectedIn(replay, options.expected);
  if (result.unexpected != nullptr) return;
  CommandWatch<S> watch{options.expected.commands, result};
  replay.setCommandFilter(CommandWatch<S>::filter, &watch);
  if (options.sample < 100) {
    verifySample(replay, wiring, options, result);
  } else {
    verifyUpTo(replay.ticks(), replay, KeyframeWatch<S>(), wiring, options, result);
  }
  result.matches = !result.stopped && result.unexpected == nullptr && result.claimsThatAreFalse == 0 &&
                   result.wrongTicks == 0;
}

}  // namespace

template <Scalar S>
VerifyResult verify(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring,
                    const VerifyOptions& options) {
  VerifyResult result;
#if defined(__cpp_exceptions)
  try {
    verifyInto(result, bytes, wiring, options);
  } catch (const Interrupted&) {
    result.stopped = true;
  }
#else
  verifyInto(result, bytes, wiring, options);
#endif
  return result;
}

VerifyResult verify(std::span<const std::uint8_t> bytes, const VerifyOptions& options) {
  if (recordingInfo(bytes).scalar == ScalarKind::fixed) {
    return verify<Fixed>(bytes, namedHandlerWiring<Fixed>(), options);
  }
#ifdef SAMESTEP_FIXED_ONLY
  failFormat(kScalarAt, "recorded with double, which this build lacks");
#else
  return verify<double>(bytes, namedHandlerWiring<double>(), options);
#endif
}

#define SAMESTEP_EACH_SCALAR \
  template VerifyResult verify<S>(std::span<const std::uint8_t>, const Wiring<S>&, const VerifyOptions&);
#include <samestep/each_scalar.h>

}  // namespace samestep
