// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

// A build without threads has nobody to wait for.
#if !defined(__wasm__) || defined(__EMSCRIPTEN_PTHREADS__)
#define SAMESTEP_THREADS 1
#include <thread>
#endif

namespace samestep {

/// Wait of a thread for another: at first it does hardly anything, then it lets others run, which may be whom
/// it waits for.
class Idle {
 public:
  void wait() {
    if (++rounds_ < kBusyRounds) {
#if defined(__x86_64__) || defined(__i386__)
      __builtin_ia32_pause();
#elif defined(__aarch64__)
      asm volatile("yield");
#endif
    } else {
#ifdef SAMESTEP_THREADS
      std::this_thread::yield();
#endif
    }
  }
  /// Number of times it has waited.
  std::uint32_t rounds() const { return rounds_; }

 private:
  static constexpr std::uint32_t kBusyRounds = 200;
  std::uint32_t rounds_ = 0;
};

}  // namespace samestep
