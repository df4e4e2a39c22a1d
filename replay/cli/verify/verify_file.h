// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include <samestep/judge.h>

namespace samestep::program {

/// Plan of `samestep verify` for each file.
struct VerifyPlan {
  VerifyOptions options;
  const Wirings* wirings = nullptr;
  std::int64_t seconds = 0;  ///< At most for a file; 0 for as long as it takes.
  bool json = false;
  bool quiet = false;  ///< No progress on the terminal.
};

/// Answer about a file.
struct Said {
  Verdict verdict = Verdict::unusable;
  std::uint64_t ticks = 0;  ///< Replayed.
  std::string out;
  std::string error;
};

/// Verifies one file. Whatever it is, there is something to be said of it.
Said verifyFile(const std::string& file, const VerifyPlan& plan);
/// Answer about a file that could not be come to an end with.
/// @param settled  whether it is the same on every machine
Said saidUnusable(const std::string& file, const std::string& reason, bool settled, const VerifyPlan& plan);
/// The exit code that a verdict stands for.
int exitCodeOf(Verdict verdict);

}  // namespace samestep::program
