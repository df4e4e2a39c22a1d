// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <samestep/fixed_checked.h>

namespace samestep::fuzz {

/// Describes the input under test on stderr, for the report of a finding; null for none.
using Describe = void (*)();
inline Describe& describer() {
  static Describe describe = nullptr;
  return describe;
}

/// Ends the process with the claim that does not hold.
[[noreturn, gnu::noinline, gnu::cold]] inline void fail(const char* claim) {
  std::fprintf(stderr, "fuzz: does not hold: %s\n", claim);
  if (describer() != nullptr) describer()();
  std::abort();
}
[[noreturn, gnu::noinline, gnu::cold]] inline void fail(const char* claim, double value, double limit) {
  std::fprintf(stderr, "fuzz: %.17g against %.17g\n", value, limit);
  fail(claim);
}

inline void expect(bool holds, const char* claim) {
  if (!holds) [[unlikely]] {
    fail(claim);
  }
}
inline void expectAtMost(double value, double limit, const char* claim) {
  if (!(value <= limit)) [[unlikely]] {
    fail(claim, value, limit);
  }
}
inline void expectNear(double a, double b, double tolerance, const char* claim) {
  expectAtMost(std::fabs(a - b), tolerance, claim);
}

/// Runs a target. Whatever it lets out is a finding: an internal error, or the overflow of a checked number.
template <class Run>
void guarded(Run&& run) {
  try {
    run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz: thrown: %s\n", error.what());
    fail("nothing is thrown here");
  }
}

}  // namespace samestep::fuzz
