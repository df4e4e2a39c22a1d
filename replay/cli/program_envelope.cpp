// SPDX-License-Identifier: MIT
#include <cstdio>

#include "cli/commands.h"
#include "study/envelope.h"

namespace samestep::program {
namespace {

int run(const EnvelopeOptions& options) {
  if (!options.csv.empty()) checkWritable(options.csv);
  std::vector<const Ladder*> chosen;
  for (const Ladder& ladder : ladders()) {
    if (options.ladder.empty() || options.ladder == ladder.name) chosen.push_back(&ladder);
  }
  const std::vector<Setting> settings = limitSettings();
  const std::size_t total = chosen.size() * settings.size();
  std::vector<Limit> limits;
  StatusLine status;
  for (const Ladder* ladder : chosen) {
    for (const Setting& setting : settings) {
      const std::string what = "envelope: " + std::to_string(limits.size()) + " of " + std::to_string(total) +
                               " limits; " + ladder->name + ", " + setting.name();
      status.show(what);
      limits.push_back(limitOf(*ladder, setting));
    }
  }
  status.clear();
  if (!options.csv.empty()) writeFile(options.csv, limitsCsv(limits));
  std::printf("%s\n", limitsTable(limits).c_str());
  for (const Ladder* ladder : chosen) std::printf("%s\n", describe(*ladder).c_str());
  return kGood;
}

}  // namespace

int climbLadders(const EnvelopeOptions& options) { return run(options); }

std::vector<std::string> ladderNames() {
  std::vector<std::string> names;
  for (const Ladder& ladder : ladders()) names.emplace_back(ladder.name);
  return names;
}

}  // namespace samestep::program
