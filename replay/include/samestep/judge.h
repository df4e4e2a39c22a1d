// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include <samestep/named_handlers.h>
#include <samestep/verify.h>

namespace samestep {

/// Verdict on a recording.
enum class Verdict : std::uint8_t {
  verified,       ///< All of it came out as recorded, and no claim was found false.
  mismatch,       ///< Another world came out after a step.
  falseClaim,     ///< The worlds are as recorded, and do not have what is claimed of them.
  unexpected,     ///< It is another match than it was to be; see Expectations.
  incomplete,     ///< The steps that are there came out as recorded, but it ends too early.
  otherRevision,  ///< It was made by another simulation revision, whose build can judge it.
  unusable,       ///< It cannot be read, or the world refuses what is done in it, or it outgrows the limits.
  stopped,        ///< VerifyOptions::progress said so.
  sampled,  ///< Stretches looked at came out as recorded; the rest was left out, see VerifyOptions::sample.
};
/// "verified", "mismatch", "false claim", "unexpected", "incomplete", "other revision", "unusable",
/// "stopped", "sampled".
const char* verdictName(Verdict verdict);

/// A verdict with its grounds.
struct Judgement {
  Verdict verdict = Verdict::unusable;
  /// In words, with what was found and what was wanted; empty for what is verified.
  std::string reason;
  /// The step that the verdict is about: of a mismatch or a false claim, or the last one replayed.
  std::uint64_t tick = 0;
  /// Offset of what cannot be used in the bytes, or of a command that is not allowed.
  std::uint64_t offset = 0;
  /// The build that recorded it; 0 where even that cannot be read.
  std::uint32_t revision = 0;
  /// XXH3-64 of all bytes: with kSimulationRevision, what the verdict is about.
  std::uint64_t content = 0;
  /// True if every machine comes to this verdict, with the same options. Where time or memory was short,
  /// another one may come to another.
  bool settled = true;
  /// Result of replaying, as far as it came.
  VerifyResult result;
};

/// A wiring for each scalar; at first those of the named handlers.
struct Wirings {
  Wiring<Fixed> fixed = namedHandlerWiring<Fixed>();
#ifndef SAMESTEP_FIXED_ONLY
  Wiring<double> float64 = namedHandlerWiring<double>();
#endif
};

template <Scalar S>
const Wiring<S>& wiringOf(const Wirings& wirings) {
#ifndef SAMESTEP_FIXED_ONLY
  if constexpr (std::is_same_v<S, double>) return wirings.float64;
#endif
  if constexpr (std::is_same_v<S, Fixed>) return wirings.fixed;
}

/// Replays a recording that may be anything and says what is to be said of it. Bytes are never an error.
/// options.ending is passed over: a recording that was cut is replayed as far as it goes.
/// @throws KernelUnavailable; ValueOutOfRange for options that are none
template <Scalar S>
Judgement judge(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring,
                const VerifyOptions& options = {});
/// Judges a recording of either scalar, with a wiring for each.
Judgement judge(std::span<const std::uint8_t> bytes, const Wirings& wirings = {},
                const VerifyOptions& options = {});

}  // namespace samestep
