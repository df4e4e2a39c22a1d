// SPDX-License-Identifier: MIT
#include "study/envelope.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace samestep {
namespace {

constexpr std::string_view kHeader = "ladder,method,count,holds,top";

/// Cuts the text up to a separator off its front.
std::string_view cut(std::string_view& text, char separator) {
  const std::string_view::size_type end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return part;
}

bool readNumber(std::string_view text, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// Null where the ladder has none for the setting.
const Limit* find(std::span<const Limit> limits, std::string_view ladder, const Setting& setting) {
  for (const Limit& limit : limits) {
    if (limit.ladder == ladder && limit.method == setting.method->name && limit.count == setting.count) {
      return &limit;
    }
  }
  return nullptr;
}

std::string cell(const Limit* limit) {
  if (limit == nullptr) return "";
  if (limit->holds == limit->top) return "at least " + std::to_string(limit->top);
  return std::to_string(limit->holds);
}

}  // namespace

std::vector<Setting> limitSettings() {
  std::vector<Setting> all;
  for (const Method& method : methods()) {
    for (const int count : method.limits) all.push_back({&method, count});
  }
  return all;
}

std::string describe(const Ladder& ladder) {
  return std::string("- `") + ladder.name + "` (" + ladder.heading + "; tried up to " +
         std::to_string(ladder.top) + "): " + ladder.trial + ". It fails when " + ladder.failure + ".";
}

int lastThatHolds(int top, const std::function<bool(int)>& holds) {
  int low = 0;
  int high = 1;
  while (holds(high)) {
    low = high;
    if (low == top) return low;
    high = low > top / 2 ? top : 2 * low;
  }
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

Limit limitOf(const Ladder& ladder, const Setting& setting, const std::function<void(int)>& tried) {
  const int holds = lastThatHolds(ladder.top, [&](int rung) {
    if (tried) tried(rung);
    return ladder.holds(setting, rung);
  });
  return {ladder.name, setting.method->name, setting.count, holds, ladder.top};
}

std::string limitsCsv(std::span<const Limit> limits) {
  std::string out = std::string(kHeader) + "\n";
  for (const Limit& limit : limits) {
    out += limit.ladder + "," + limit.method;
    for (const int number : {limit.count, limit.holds, limit.top}) out += "," + std::to_string(number);
    out += "\n";
  }
  return out;
}

std::vector<Limit> readLimits(std::string_view csv) {
  std::vector<Limit> limits;
  for (int line = 1; !csv.empty(); ++line) {
    std::string_view rest = cut(csv, '\n');
    if (line == 1 && rest == kHeader) continue;
    Limit limit;
    limit.ladder = cut(rest, ',');
    limit.method = cut(rest, ',');
    const bool numbers = readNumber(cut(rest, ','), limit.count) && readNumber(cut(rest, ','), limit.holds) &&
                         readNumber(rest, limit.top);
    if (line == 1 || !numbers) {
      throw std::runtime_error("line " + std::to_string(line) + " is not of a table of limits");
    }
    limits.push_back(std::move(limit));
  }
  return limits;
}

std::string limitsTable(std::span<const Limit> limits) {
  std::vector<const Ladder*> columns;
  for (const Ladder& ladder : ladders()) {
    const auto ofLadder = [&](const Limit& limit) { return limit.ladder == ladder.name; };
    if (std::any_of(limits.begin(), limits.end(), ofLadder)) columns.push_back(&ladder);
  }
  std::string out = "| setting |";
  std::string rule = "|---|";
  for (const Ladder* ladder : columns) {
    out += std::string(" ") + ladder->heading + " |";
    rule += "---|";
  }
  out += "\n" + rule + "\n";
  for (const Setting& setting : limitSettings()) {
    out += "| " + setting.name() + " |";
    for (const Ladder* ladder : columns) out += " " + cell(find(limits, ladder->name, setting)) + " |";
    out += "\n";
  }
  return out;
}

}  // namespace samestep
