#pragma once

#include <cstdint>

namespace samestep::way {

/// x to the nearest double, or near it.
inline double nearDouble(std::int64_t x) {
#if defined(__SSE2__) && defined(__x86_64__)
  // The plain conversion keeps the upper half of its register, and so waits for whatever was there before.
  // The intrinsic function is not used: its header costs a client a tenth of what all of Samestep's do.
  using Halves [[gnu::vector_size(16)]] = double;
  Halves result{};
#if defined(__clang__)
  result[0] = static_cast<double>(x);
#else
  result = __builtin_ia32_cvtsi642sd(result, x);
#endif
#if defined(__GNUC__)
  asm("" : "+x"(result));  // clang would make it the plain conversion again
#endif
  return result[0];
#else
  return static_cast<double>(x);
#endif
}

}  // namespace samestep::way
