// SPDX-License-Identifier: MIT
#include <samestep/verify.h>

#include <samestep/named_handlers.h>

#include "base/require_ieee.h"

namespace samestep {

template <Scalar S>
VerifyResult verify(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring,
                    const VerifyOptions& options) {
  Replay<S> replay(bytes, wiring, options.limits);
  replay.space().forceKernel(options.kernel);
  replay.space().setWorkers(options.workers, Sharing::always);
  VerifyResult result;
  result.ticks = replay.ticks();
  do {
    result.recordedHash = replay.recordedHash();
    result.computedHash = replay.space().hash();
    if (result.recordedHash != result.computedHash) {
      result.firstWrongTick = replay.tick();
      return result;
    }
    if (options.progress != nullptr && !options.progress(replay.tick(), replay.ticks(), options.data)) {
      result.stopped = true;
      return result;
    }
  } while (replay.step());
  result.matches = true;
  return result;
}

VerifyResult verify(std::span<const std::uint8_t> bytes, const VerifyOptions& options) {
  if (recordingInfo(bytes).scalar == ScalarKind::fixed) {
    return verify<Fixed>(bytes, namedHandlerWiring<Fixed>(), options);
  }
#ifdef SAMESTEP_FIXED_ONLY
  failFormat(16, "recorded with double, which this build lacks");
#else
  return verify<double>(bytes, namedHandlerWiring<double>(), options);
#endif
}

#define SAMESTEP_EACH_SCALAR \
  template VerifyResult verify<S>(std::span<const std::uint8_t>, const Wiring<S>&, const VerifyOptions&);
#include <samestep/each_scalar.h>

}  // namespace samestep
