// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/method.h"

namespace samestep {

/// A method with its count.
struct Setting {
  const Method* method;
  int count;

  /// "double soft step, 4 substeps"
  std::string name() const {
    return std::string(method->name) + ", " + std::to_string(count) + " " + method->unit;
  }
};

/// All settings whose limits are looked for.
std::vector<Setting> limitSettings();

/// Something that is made harder rung by rung until it fails.
struct Ladder {
  const char* name;     ///< Name on the command line and in the CSV.
  const char* heading;  ///< Heading of its column: what a rung that holds means.
  const char* trial;    ///< Text that says what is done at a rung.
  const char* failure;  ///< Text that says when that has failed.
  int top;              ///< The last rung.
  bool (*holds)(const Setting& setting, int rung);
};

std::span<const Ladder> ladders();

/// Name, what the rungs are, and what failing means: a line of Markdown.
std::string describe(const Ladder& ladder);

/// The end of a climb.
struct Limit {
  std::string ladder;
  std::string method;
  int count = 0;
  int holds = 0;  ///< The last rung that held; 0 where none did.
  int top = 0;    ///< Top of the ladder: whoever holds there has shown no limit.

  friend bool operator==(const Limit&, const Limit&) = default;
};

/// Climbs by doubling until a rung fails, then halves the rungs between: a rung that holds and whose next one
/// fails, or the top. Where rungs hold and fail in turn it is one such place, not the only one.
/// @param top  at least 1
int lastThatHolds(int top, const std::function<bool(int rung)>& holds);

/// The limit of a setting on a ladder.
/// @param tried  is told each rung before it is tried; may be empty
Limit limitOf(const Ladder& ladder, const Setting& setting, const std::function<void(int rung)>& tried = {});

/// A header and a row for each limit. readLimits reads it back.
std::string limitsCsv(std::span<const Limit> limits);
/// @throws std::runtime_error, with the line, for what limitsCsv does not write
std::vector<Limit> readLimits(std::string_view csv);

/// A table in Markdown: a row for each setting, a column for each ladder that has limits.
std::string limitsTable(std::span<const Limit> limits);

}  // namespace samestep
