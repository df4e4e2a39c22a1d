// SPDX-License-Identifier: MIT
#include <cstdio>

#include <samestep/scene.h>

#include "cli/commands.h"

namespace samestep::program {

int listScenesByName() {
  for (const SceneSummary& scene : listScenes())
    std::printf("%-16s %s\n", scene.name.c_str(), scene.about.c_str());
  return kGood;
}

}  // namespace samestep::program
