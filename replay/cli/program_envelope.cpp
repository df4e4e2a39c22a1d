// SPDX-License-Identifier: MIT
#include <cstdio>

#include "cli/program.h"
#include "study/envelope.h"

namespace samestep::program {
namespace {

struct Options {
  std::string ladder;
  std::string csv;
};

int run(const Options& options) {
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

void addEnvelope(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand("envelope",
                                      "Find how high a stack, how unequal masses, how fast a bullet, which "
                                      "degenerate shapes each solver bears");
  auto options = std::make_shared<Options>();
  std::vector<std::string> names;
  for (const Ladder& ladder : ladders()) names.emplace_back(ladder.name);
  word->add_option("LADDER", options->ladder, "Climb only this one")->check(CLI::IsMember(names));
  word->add_option("--csv", options->csv, "Also write the limits to this file");
  word->callback([options, &result] { result = run(*options); });
}

}  // namespace samestep::program
