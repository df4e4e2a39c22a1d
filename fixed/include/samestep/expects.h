#pragma once

#ifdef SAMESTEP_EXPECTS
#include <cstdio>
#include <cstdlib>
#endif

namespace samestep {

/// True in builds with SAMESTEP_EXPECTS alone: expectations are checked.
#ifdef SAMESTEP_EXPECTS
inline constexpr bool kExpects = true;
#else
inline constexpr bool kExpects = false;
#endif

#ifdef SAMESTEP_EXPECTS
/// Ends the program with the place of an expectation that does not hold.
[[noreturn, gnu::cold, gnu::noinline]] inline void endUnexpected(const char* file, int line) {
  std::fprintf(stderr, "%s:%d: what this function expects of its caller does not hold\n", file, line);
  std::abort();
}
#endif

/// States what a function expects of the code that calls it, where only a mistake in this library can break
/// it: what a user can do wrong throws an Error in every build. Checked in builds with SAMESTEP_EXPECTS; in
/// others nothing is left of it, so the condition has to be one whose evaluation an optimiser drops. What
/// takes more than a few operations stands in `if constexpr (kExpects)`.
[[gnu::always_inline]] inline constexpr void expects([[maybe_unused]] bool holds,
                                                     [[maybe_unused]] const char* file = __builtin_FILE(),
                                                     [[maybe_unused]] int line = __builtin_LINE()) {
#ifdef SAMESTEP_EXPECTS
  if (!holds) [[unlikely]]
    endUnexpected(file, line);
#endif
}

}  // namespace samestep
