// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "peer_worlds.h"

namespace samestep::bench {

/// Quality of a result, computed in double from the bodies' motions alone, the same way for every engine.
struct Quality {
  double apexDrop = 0;        ///< Distance of the last body below where it began, m.
  double maxPenetration = 0;  ///< Deepest overlap of two shapes of which one is on a dynamic body, m.
  double kineticEnergy = 0;   ///< Energy of the dynamic bodies, J.
  double pileY = 0;           ///< Height of the dynamic bodies' common centre of mass, m.
  int throughWalls = 0;       ///< Dynamic bodies with their centre in or beyond a wall or floor.
  int turned = 0;             ///< Dynamic bodies turned by more than 0.2 rad since the beginning.
};

Quality qualityOf(const PeerScene& scene, const std::vector<Motion>& motions);

}  // namespace samestep::bench
