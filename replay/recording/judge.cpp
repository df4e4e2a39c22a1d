// SPDX-License-Identifier: MIT
#include <samestep/judge.h>
#include <samestep/version.h>

#include <exception>
#include <new>

#include "base/require_ieee.h"
#include "recording/recording_format.h"
#include "state/state_hash.h"

namespace samestep {

const char* verdictName(Verdict verdict) {
  switch (verdict) {
    case Verdict::verified:
      return "verified";
    case Verdict::mismatch:
      return "mismatch";
    case Verdict::falseClaim:
      return "false claim";
    case Verdict::unexpected:
      return "unexpected";
    case Verdict::incomplete:
      return "incomplete";
    case Verdict::otherRevision:
      return "other revision";
    case Verdict::unusable:
      return "unusable";
    case Verdict::stopped:
      return "stopped";
    case Verdict::sampled:
      return "sampled";
  }
  return "unknown";
}

namespace {

std::string number(std::uint64_t value) { return std::to_string(value); }

void sayMismatch(Judgement& judgement, const VerifyOptions& options) {
  const VerifyResult& result = judgement.result;
  judgement.verdict = Verdict::mismatch;
  judgement.tick = result.firstWrongTick;
  judgement.reason = result.keyframeDiffers ? "the keyframe is another world than the one computed"
                                            : "the world computed has another hash than the one recorded";
  if (!options.toTheEnd) return;
  judgement.reason += result.lastWrongTick < result.ticks
                          ? "; the worlds agree again after tick " + number(result.lastWrongTick)
                          : "; they differ to the end";
}

void sayResult(Judgement& judgement, const VerifyOptions& options) {
  const VerifyResult& result = judgement.result;
  judgement.tick = result.ticks;
  judgement.verdict = Verdict::verified;
  const bool tooShort = result.cut && result.unexpected != nullptr && options.expected.ticks &&
                        result.ticks < *options.expected.ticks;
  if (result.wrongTicks > 0) {
    sayMismatch(judgement, options);
  } else if (result.stopped) {
    judgement.verdict = Verdict::stopped;
    judgement.settled = false;
    judgement.reason = "stopped before its end";
  } else if (result.unexpected != nullptr && !tooShort) {
    judgement.verdict = Verdict::unexpected;
    judgement.reason = std::string(result.unexpected) + " is not as expected";
    judgement.offset = result.unexpectedOffset;
  } else if (result.falseClaim) {
    judgement.verdict = Verdict::falseClaim;
    judgement.tick = result.falseClaim->tick;
    judgement.reason = "what is claimed under a key is not so";
  } else if (result.cut) {
    judgement.verdict = Verdict::incomplete;
    judgement.reason = "ends after tick " + number(result.ticks) + " without an end";
  } else if (result.sampled) {
    judgement.verdict = Verdict::sampled;
    judgement.reason =
        number(result.ticksCompared) + " of " + number(result.ticks) + " ticks are compared, the others not";
  }
}

/// Runs `replay`, which answers what verify does; says why the bytes cannot be used where it throws.
template <class Replayed>
Judgement judged(std::span<const std::uint8_t> bytes, const VerifyOptions& options, Replayed&& replay) {
  Judgement judgement;
  judgement.content = XXH3_64bits(bytes.data(), bytes.size());
#if defined(__cpp_exceptions)
  try {
    const RecordingInfo info = recordingInfo(bytes);
    judgement.revision = info.revision;
    if (info.revision != kSimulationRevision) failRevision(kRevisionAt, info.revision, kSimulationRevision);
    judgement.result = replay(info.scalar);
    sayResult(judgement, options);
  } catch (const KernelUnavailable&) {
    throw;
  } catch (const ValueOutOfRange&) {
    throw;
  } catch (const RevisionError& error) {
    judgement.verdict = Verdict::otherRevision;
    judgement.reason = error.what();
    judgement.offset = error.offset();
  } catch (const FormatError& error) {
    judgement.reason = error.what();
    judgement.offset = error.offset();
  } catch (const std::bad_alloc&) {
    judgement.settled = false;
    judgement.reason = "no memory";
  } catch (const std::exception& error) {
    // A function that is not registered.
    judgement.reason = error.what();
  }
#else
  judgement.revision = recordingInfo(bytes).revision;
  judgement.result = replay(recordingInfo(bytes).scalar);
  sayResult(judgement, options);
#endif
  return judgement;
}

VerifyOptions asFarAsItGoes(VerifyOptions options) {
  options.ending = Ending::mayBeCut;
  return options;
}

}  // namespace

template <Scalar S>
Judgement judge(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring, const VerifyOptions& options) {
  return judged(bytes, options, [&](ScalarKind) { return verify<S>(bytes, wiring, asFarAsItGoes(options)); });
}

Judgement judge(std::span<const std::uint8_t> bytes, const Wirings& wirings, const VerifyOptions& options) {
  const VerifyOptions how = asFarAsItGoes(options);
  return judged(bytes, options, [&](ScalarKind scalar) {
    if (scalar == ScalarKind::fixed) return verify<Fixed>(bytes, wirings.fixed, how);
#ifdef SAMESTEP_FIXED_ONLY
    failFormat(kScalarAt, "recorded with double, which this build lacks");
#else
    return verify<double>(bytes, wirings.float64, how);
#endif
  });
}

#define SAMESTEP_EACH_SCALAR \
  template Judgement judge<S>(std::span<const std::uint8_t>, const Wiring<S>&, const VerifyOptions&);
#include <samestep/each_scalar.h>

}  // namespace samestep
