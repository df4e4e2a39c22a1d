// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include <samestep/judge.h>

namespace samestep::program {

/// Contents of a line of `samestep verify --json`.
struct VerdictLine {
  std::string file;
  std::string content;  ///< 16 hexadecimal digits.
  std::string asked;    ///< Hash, as many digits, of the options that a verdict goes by.
  std::uint64_t verifier = 0;
  std::string verdict;
  std::string reason;
  bool settled = true;
  std::uint64_t ticks = 0;
  std::uint64_t milliseconds = 0;

  /// Question that one verdict answers, whatever the file is called.
  auto question() const { return std::tie(content, verifier, asked); }
};

/// Writes the line, with its end.
std::string verdictLine(const std::string& file, const Judgement& judgement, std::uint64_t asked,
                        std::int64_t milliseconds);
/// Reads one without its end; nothing for what is none, as a line that was cut.
std::optional<VerdictLine> readVerdictLine(std::string_view line);

inline constexpr std::size_t kVerdicts = 9;
/// That with the name; Verdict::unusable for none.
Verdict verdictNamed(std::string_view name);

/// The number that stands for the options of a verification that its verdict goes by: limits, expectations,
/// sample. Not for those that only a slow or small machine meets.
std::uint64_t askedOf(const VerifyOptions& options);

}  // namespace samestep::program
