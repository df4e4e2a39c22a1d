// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace samestep {

/// Processor instructions with which the soft step solves contacts. All give the same bits.
enum class KernelTarget : std::uint8_t {
  /// The last of availableKernels().
  best = 0,
  /// Uses what every processor of the architecture has.
  portable = 1,
  sse42 = 2,
  avx2 = 3,
  /// Uses the parts F, DQ, BW and VL.
  avx512 = 4,
  /// 64-bit ARM.
  neon = 5,
  /// WebAssembly, built with -msimd128.
  simd128 = 6,
};
inline constexpr KernelTarget kKernelTargets[] = {
    KernelTarget::best,   KernelTarget::portable, KernelTarget::sse42,  KernelTarget::avx2,
    KernelTarget::avx512, KernelTarget::neon,     KernelTarget::simd128};

/// "best", "portable", "sse42", "avx2", "avx512", "neon", "simd128".
const char* kernelName(KernelTarget target);
/// The target of a name; false if there is none, and `target` stays as it is.
bool findKernel(const char* name, KernelTarget& target);

/// Kernels that were built and that this processor can run, the slowest first: always `portable`, never
/// `best`.
std::span<const KernelTarget> availableKernels();
bool isAvailable(KernelTarget target);
/// The target itself if it is available, or else the best of those available that come before it.
KernelTarget nextBestKernel(KernelTarget target);

}  // namespace samestep
