// SPDX-License-Identifier: MIT
#include <samestep/kernel.h>

#include <cstring>

#include "solver/kernels/kernels.h"

namespace samestep {
namespace {

/// Kernels that were built and that the processor can run: that of the fast kernels stands for both.
struct Available {
  KernelTarget targets[5] = {KernelTarget::portable};
  std::uint32_t count = 1;

  Available() {
#if defined(__x86_64__) || defined(__i386__)
    if (kernels::fastSse42 != nullptr && __builtin_cpu_supports("sse4.2")) {
      targets[count++] = KernelTarget::sse42;
    }
    if (kernels::fastAvx2 != nullptr && __builtin_cpu_supports("avx2")) {
      targets[count++] = KernelTarget::avx2;
    }
    if (kernels::fastAvx512 != nullptr && __builtin_cpu_supports("avx512f") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl")) {
      targets[count++] = KernelTarget::avx512;
    }
#endif
    if (kernels::fastNeon != nullptr) targets[count++] = KernelTarget::neon;
    if (kernels::fastSimd128 != nullptr) targets[count++] = KernelTarget::simd128;
  }
};

}  // namespace

const char* kernelName(KernelTarget target) {
  switch (target) {
    case KernelTarget::best:
      return "best";
    case KernelTarget::portable:
      return "portable";
    case KernelTarget::sse42:
      return "sse42";
    case KernelTarget::avx2:
      return "avx2";
    case KernelTarget::avx512:
      return "avx512";
    case KernelTarget::neon:
      return "neon";
    case KernelTarget::simd128:
      return "simd128";
  }
  return "?";
}

bool findKernel(const char* name, KernelTarget& target) {
  for (const KernelTarget candidate : kKernelTargets) {
    if (std::strcmp(name, kernelName(candidate)) != 0) continue;
    target = candidate;
    return true;
  }
  return false;
}

std::span<const KernelTarget> availableKernels() {
  static const Available available;
  return {available.targets, available.count};
}

bool isAvailable(KernelTarget target) {
  if (target == KernelTarget::best) return true;
  for (const KernelTarget available : availableKernels()) {
    if (available == target) return true;
  }
  return false;
}

KernelTarget nextBestKernel(KernelTarget target) {
  KernelTarget found = KernelTarget::portable;
  for (const KernelTarget available : availableKernels()) {
    if (target == KernelTarget::best || available <= target) found = available;
  }
  return found;
}

}  // namespace samestep
