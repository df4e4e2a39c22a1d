// SPDX-License-Identifier: MIT
#include <cstdio>

#include <samestep/scene.h>

#include "cli/program.h"

namespace samestep::program {

void addScenes(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand("scenes", "List the scenes that can be run by name");
  word->callback([&result] {
    for (const SceneSummary& scene : listScenes())
      std::printf("%-16s %s\n", scene.name.c_str(), scene.about.c_str());
    result = kGood;
  });
}

}  // namespace samestep::program
