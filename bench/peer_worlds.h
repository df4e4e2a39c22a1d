// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "peer_scene.h"

namespace samestep::bench {

/// A scene running in one engine.
class World {
 public:
  virtual ~World() = default;
  virtual void step() = 0;
};

std::unique_ptr<World> makeDouble(const PeerScene& scene);
std::unique_ptr<World> makeFixed(const PeerScene& scene);
std::unique_ptr<World> makeChipmunk(const PeerScene& scene);

}  // namespace samestep::bench
